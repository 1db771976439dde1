// COLLADA files; they may name wood.png.
#include "scenes/load.h"
#include "tests/fuzz/harness.h"

namespace lanewise::fuzz {
namespace {

const Harness harness("collada", ".dae", [](const std::string& path) { use(load_scene(path)); });

}  // namespace
}  // namespace lanewise::fuzz
