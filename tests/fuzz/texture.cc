// Pictures for textures: PNG, JPEG, BMP, TGA, which their first bytes tell apart.
#include "scenes/textures.h"
#include "tests/fuzz/harness.h"

namespace lanewise::fuzz {
namespace {

const Harness harness("texture", ".picture", [](const std::string& path) {
  Scene scene;
  scene.path = path;
  Textures(scene).file("input.picture");
});

}  // namespace
}  // namespace lanewise::fuzz
