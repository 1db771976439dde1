#include "scenes/own_file.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace lanewise {
namespace {

namespace fs = std::filesystem;

// "" where there is no such file.
fs::path real_path(const fs::path& path) {
  std::error_code error;
  const fs::path real = fs::canonical(path, error);
  return error ? fs::path() : real;
}

std::string without_escapes(const std::string& name) {
  std::string plain;
  for (size_t i = 0; i < name.size(); ++i) {
    unsigned char value = 0;
    const char* digits = name.data() + i + 1;
    if (name[i] == '%' && i + 2 < name.size() && std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2) {
      plain += static_cast<char>(value);
      i += 2;
    } else {
      plain += name[i];
    }
  }
  return plain;
}

}  // namespace

bool is_own_file(const std::string& scene, const std::string& file) {
  const fs::path real = real_path(file), folder = real_path(fs::absolute(scene).parent_path());
  std::error_code error;
  if (real.empty() || folder.empty() || !fs::is_regular_file(real, error)) return false;
  return std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first == folder.end();
}

std::string find_own_file(const std::string& scene, const std::string& name) {
  std::string plain = name.starts_with("file:") ? name.substr(5) : name;
  std::ranges::replace(plain, '\\', '/');
  const fs::path folder = fs::path(scene).parent_path();
  for (const std::string& spelt : {plain, without_escapes(plain)}) {
    if (spelt.find('\0') != std::string::npos) continue;
    for (const fs::path& path : {folder / spelt, folder / fs::path(spelt).filename()}) {
      if (is_own_file(scene, path.string())) return path.string();
    }
  }
  return "";
}

}  // namespace lanewise
