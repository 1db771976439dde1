#include <string>
#include <vector>

#include "core/render.h"
#include "hwy/highway.h"

namespace lanewise {
namespace {

struct Isa {
  const char* name;
  int64_t targets;
};

constexpr Isa kIsas[] = {
    {"scalar", HWY_SCALAR | HWY_EMU128},
    {"sse4", HWY_SSE4},
    {"avx2", HWY_AVX2},
    {"avx512", HWY_AVX3},
};

// Worst first.
std::vector<Isa> supported() {
  std::vector<Isa> result;
  const int64_t here = (hwy::SupportedTargets() | HWY_SCALAR | HWY_EMU128) & HWY_TARGETS;
  for (const Isa& isa : kIsas) {
    if (isa.targets & here) result.push_back({isa.name, isa.targets & here});
  }
  return result;
}

// What hwy finds before anything is chosen; the choice overrides its memory of the machine.
const std::vector<Isa>& machine() {
  static const std::vector<Isa> isas = supported();
  return isas;
}

std::string& chosen() {
  static std::string name = machine().back().name;
  return name;
}

}  // namespace

std::vector<std::string> supported_isas() {
  std::vector<std::string> names;
  for (const Isa& isa : machine()) names.push_back(isa.name);
  return names;
}

std::string chosen_isa() { return chosen(); }

void choose_isa(const std::string& name) {
  for (const Isa& isa : machine()) {
    if (!name.empty() && name != isa.name) continue;
    if (name.empty() && isa.name != machine().back().name) continue;
    hwy::SetSupportedTargetsForTest(isa.targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    chosen() = isa.name;
    return;
  }
  std::string have;
  for (const Isa& isa : machine()) have += std::string(have.empty() ? "" : ", ") + isa.name;
  throw UsageError("--isa " + name + ": not available here (this machine has " + have + ")");
}

}  // namespace lanewise
