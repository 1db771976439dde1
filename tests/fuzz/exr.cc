// OpenEXR pictures, as skies.
#include "tests/fuzz/harness.h"

namespace lanewise::fuzz {
namespace {

const Harness harness("exr", ".exr", use_sky);

}  // namespace
}  // namespace lanewise::fuzz
