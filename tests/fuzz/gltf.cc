// glTF files, as JSON with data: URIs, and in one piece: the reader tells them apart by their first bytes.
#include "scenes/load.h"
#include "tests/fuzz/harness.h"

namespace lanewise::fuzz {
namespace {

const Harness harness("gltf", ".gltf", [](const std::string& path) { use(load_scene(path)); });

}  // namespace
}  // namespace lanewise::fuzz
