#include "scenes/load.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/types.h"
#include "scenes/assimp_scene.h"
#include "scenes/builtin.h"
#include "scenes/collada.h"

namespace lanewise {
namespace {

constexpr uint64_t kMaxFileBytes = uint64_t{4} << 30;

std::string lower_case_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

std::string read_text(const std::string& path) {
  std::error_code error;
  const auto type = std::filesystem::status(path, error).type();
  if (type == std::filesystem::file_type::not_found) throw Error(path + ": no such file");
  if (type == std::filesystem::file_type::directory) throw Error(path + ": is a directory, not a scene file");
  if (type != std::filesystem::file_type::regular) throw Error(path + ": is not a readable file");
  const uint64_t bytes = std::filesystem::file_size(path, error);
  if (error) throw Error(path + ": " + error.message());
  if (bytes > kMaxFileBytes) throw Error(path + ": is larger than 4 GiB");

  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path + ": cannot be opened: " + std::strerror(errno));
  std::string text(bytes, '\0');
  in.read(text.data(), static_cast<std::streamsize>(bytes));
  if (static_cast<uint64_t>(in.gcount()) != bytes) throw Error(path + ": cannot be read to its end");
  return text;
}

}  // namespace

Scene load_scene(const std::string& path) {
  if (path.starts_with(kBuiltinPrefix)) return load_builtin(path);
  const std::string text = read_text(path), extension = lower_case_extension(path);
  if (extension == ".dae") return load_collada(path, text);
  if (extension == ".obj" || extension == ".ply" || extension == ".gltf" || extension == ".glb") {
    return load_assimp(path, text);
  }
  throw Error(path + ": unknown scene format \"" + extension +
              "\"; scenes are COLLADA (.dae), OBJ (.obj), PLY (.ply) and glTF (.gltf, .glb) files");
}

}  // namespace lanewise
