// The arrays of one PathState. They, and those below, lie in memory of their own or in some that they are given: of bytes(), zero,
// from a cache line on, to outlast them.
#pragma once

#include <array>

#include "core/path_state.h"
#include "core/plan.h"
#include "core/zeroed_pages.h"

namespace lanewise {

class PathBuffer {
 public:
  // Room for `capacity` paths (a multiple of kLanes) and the padding of every bin; all slots hold the dummy path.
  explicit PathBuffer(uint32_t capacity, float* memory = nullptr);

  // Of memory, that such a buffer takes.
  static size_t bytes(uint32_t capacity);

  PathState& state() { return state_; }
  const PathState& state() const { return state_; }
  uint32_t capacity() const { return capacity_; }

 private:
  uint32_t capacity_;
  uint32_t padded_;
  ZeroedVector<float> own_;
  PathState state_;
};

// The arrays of KeptVertices.
class KeptBuffer {
 public:
  // For slots up to `capacity`; 0: none.
  explicit KeptBuffer(uint32_t capacity, float* memory = nullptr);

  static size_t bytes(uint32_t capacity);

  KeptVertices& vertices() { return vertices_; }
  // Nothing has been kept.
  void clear();

 private:
  uint32_t stride_ = 0;
  ZeroedVector<float> own_;
  KeptVertices vertices_;
};

// Paths set aside from a wave, bounce after bounce, until a kernel runs over them all: what are a few paths a bounce fill
// whole vectors then.
class PathQueue {
 public:
  // For as many paths as the wave's state holds; they retire to its results.
  explicit PathQueue(const PathState& wave, float* memory = nullptr);

  // Copies the KEPT fields of the range behind those that are there.
  void append(const PathState& from, Range range);
  // All of them, padded with dummy paths; the queue is empty then, but what state() holds stays until the next append.
  Range take();
  const PathState& state() const { return buffer_.state(); }

 private:
  PathBuffer buffer_;
  uint32_t size_ = 0;
};

}  // namespace lanewise
