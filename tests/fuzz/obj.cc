// OBJ files with their materials. What follows the line "# a.mtl", if there is one, goes to that file.
#include <filesystem>

#include "scenes/load.h"
#include "tests/fuzz/harness.h"
#include "tests/temporary_folder.h"

namespace lanewise::fuzz {
namespace {

const Harness harness("obj", ".obj", [](const std::string& path) {
  constexpr std::string_view kDivider = "# a.mtl\n";
  const std::filesystem::path materials = std::filesystem::path(path).replace_filename("a.mtl");
  const std::string bytes = test::read_text(path);
  const size_t at = bytes.find(kDivider);
  if (at != std::string::npos) test::write_text(materials.string(), bytes.substr(at + kDivider.size()));
  struct Removed {
    const std::filesystem::path& path;
    ~Removed() { std::filesystem::remove(path); }
  } removed{materials};
  use(load_scene(path));
});

}  // namespace
}  // namespace lanewise::fuzz
