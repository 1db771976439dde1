// PNG pictures, as they are compared.
#include "core/image_io.h"
#include "tests/fuzz/harness.h"

namespace lanewise::fuzz {
namespace {

const Harness harness("png", ".png", [](const std::string& path) { read_image(path); });

}  // namespace
}  // namespace lanewise::fuzz
