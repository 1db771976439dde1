// PLY files, ascii and binary.
#include "scenes/load.h"
#include "tests/fuzz/harness.h"

namespace lanewise::fuzz {
namespace {

const Harness harness("ply", ".ply", [](const std::string& path) { use(load_scene(path)); });

}  // namespace
}  // namespace lanewise::fuzz
