// Owns the arrays of one PathState.
#pragma once

#include <array>

#include "core/path_state.h"
#include "core/plan.h"

namespace lanewise {

class PathBuffer {
 public:
  // Room for `capacity` paths (a multiple of kLanes) and the padding of every bin; all slots hold the dummy path.
  explicit PathBuffer(uint32_t capacity);

  PathState& state() { return state_; }
  const PathState& state() const { return state_; }
  uint32_t capacity() const { return capacity_; }

 private:
  uint32_t capacity_;
  uint32_t padded_;
  AlignedVector<float> memory_;
  PathState state_;
};

}  // namespace lanewise
