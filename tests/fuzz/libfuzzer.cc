// The way in for libFuzzer, to the one harness that is linked.
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/harness.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const lanewise::fuzz::Harness& harness = *lanewise::fuzz::harnesses().front();
  harness.run({reinterpret_cast<const char*>(data), size});
  return 0;
}
