#include "core/isa.h"

#include <string>
#include <vector>

#include "core/types.h"
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
std::vector<Isa> among(int64_t targets) {
  std::vector<Isa> result;
  for (const Isa& isa : kIsas) {
    if (isa.targets & targets) result.push_back({isa.name, isa.targets & targets});
  }
  return result;
}

// What hwy finds before anything is chosen; the choice overrides its memory of the machine.
const std::vector<Isa>& machine() {
  static const std::vector<Isa> isas = among((hwy::SupportedTargets() | HWY_SCALAR | HWY_EMU128) & HWY_TARGETS);
  return isas;
}

std::vector<std::string> names_of(const std::vector<Isa>& isas) {
  std::vector<std::string> names;
  for (const Isa& isa : isas) names.push_back(isa.name);
  return names;
}

std::string& chosen() {
  static std::string name = machine().back().name;
  return name;
}

}  // namespace

std::vector<std::string> compiled_isas() { return names_of(among(HWY_TARGETS)); }

std::vector<std::string> supported_isas() { return names_of(machine()); }

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
