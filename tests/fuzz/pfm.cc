// Portable float maps, as skies.
#include "tests/fuzz/harness.h"

namespace lanewise::fuzz {
namespace {

const Harness harness("pfm", ".pfm", use_sky);

}  // namespace
}  // namespace lanewise::fuzz
