// The fields that each stage's kernel touches, from their lists in kernels.h.
#pragma once

#include "core/stages.h"
#include "kernels/kernels.h"

namespace lanewise {

inline const KernelFields& stage_fields(Stage stage) {
  static constexpr KernelFields kFields[] = {
#define LANEWISE_FIELDS(enumerator, name) enumerator##Fields,
      LANEWISE_STAGES(LANEWISE_FIELDS)
#undef LANEWISE_FIELDS
  };
  return kFields[static_cast<size_t>(stage)];
}

}  // namespace lanewise
