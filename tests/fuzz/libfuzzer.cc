// The way in for libFuzzer, to the one harness that is linked.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

#include "tests/fuzz/harness.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const lanewise::fuzz::Harness& harness = *lanewise::fuzz::harnesses().front();
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  harness.run(bytes, std::hash<std::string_view>()(bytes) % 8 == 0);  // the same for the same bytes
  return 0;
}
