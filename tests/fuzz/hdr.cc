// Radiance pictures, as skies.
#include "tests/fuzz/harness.h"

namespace lanewise::fuzz {
namespace {

const Harness harness("hdr", ".hdr", use_sky);

}  // namespace
}  // namespace lanewise::fuzz
