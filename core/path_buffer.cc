#include "core/path_buffer.h"

#include <algorithm>
#include <utility>

namespace lanewise {
namespace {

// Odd numbers of cache lines between arrays, so that the same slot of many fields does not fall into the same cache
// set.
constexpr uint32_t kStagger = 3 * kLanes;

constexpr int count_fields() {
  int n = 0;
#define LANEWISE_COUNT(type, name, meaning) ++n;
  LANEWISE_PATH_FIELDS(LANEWISE_COUNT, LANEWISE_COUNT)
#undef LANEWISE_COUNT
  return n;
}

constexpr uint32_t padded(uint32_t capacity) { return round_up_to_lanes(capacity) + 2 * kLanes * kBinCount; }

}  // namespace

size_t PathBuffer::bytes(uint32_t capacity) {
  constexpr uint32_t kResults = 3;
  return sizeof(float) * (padded(capacity) + kStagger) * (count_fields() + kResults);
}

PathBuffer::PathBuffer(uint32_t capacity, float* memory)
    : capacity_(round_up_to_lanes(capacity)), padded_(padded(capacity)) {
  const uint32_t stride = padded_ + kStagger;
  if (!memory) own_.resize(bytes(capacity) / sizeof(float));
  float* next = memory ? memory : own_.data();
#define LANEWISE_PLACE(type, name, meaning)    \
  state_.name = reinterpret_cast<type*>(next); \
  next += stride;
  LANEWISE_PATH_FIELDS(LANEWISE_PLACE, LANEWISE_PLACE)
#undef LANEWISE_PLACE
  for (float** result : {&state_.result_r, &state_.result_g, &state_.result_b}) {
    *result = next;
    next += stride;
  }
  state_.capacity = capacity_;
  const Path<float> dummy = dummy_path(capacity_);
#define LANEWISE_FILL(type, name, meaning) std::fill_n(state_.name, padded_, static_cast<type>(dummy.name));
  LANEWISE_PATH_FIELDS(LANEWISE_FILL, LANEWISE_FILL)
#undef LANEWISE_FILL
}

size_t KeptBuffer::bytes(uint32_t capacity) {
  return capacity == 0 ? 0 : sizeof(float) * kKeptFields * (round_up_to_lanes(capacity) + kStagger);
}

KeptBuffer::KeptBuffer(uint32_t capacity, float* memory) : stride_(round_up_to_lanes(capacity) + kStagger) {
  if (capacity == 0) return;
  if (!memory) own_.resize(bytes(capacity) / sizeof(float));
  float* next = memory ? memory : own_.data();
#define LANEWISE_PLACE(name, meaning) \
  vertices_.name = next;              \
  next += stride_;
  LANEWISE_KEPT_FIELDS(LANEWISE_PLACE)
#undef LANEWISE_PLACE
}

void KeptBuffer::clear() {
  if (!vertices_.gain) return;
  for (float* flags : {vertices_.gain, vertices_.bounce}) std::fill_n(flags, stride_, 0.0f);
}

PathQueue::PathQueue(const PathState& wave, float* memory) : buffer_(wave.capacity, memory) {
  buffer_.state().result_r = wave.result_r;
  buffer_.state().result_g = wave.result_g;
  buffer_.state().result_b = wave.result_b;
}

void PathQueue::append(const PathState& from, Range range) {
  const PathState& to = buffer_.state();
#define LANEWISE_APPEND(type, name, meaning) std::copy_n(from.name + range.begin, range.size(), to.name + size_);
#define LANEWISE_IGNORE(type, name, meaning)
  LANEWISE_PATH_FIELDS(LANEWISE_APPEND, LANEWISE_IGNORE)
#undef LANEWISE_IGNORE
#undef LANEWISE_APPEND
  size_ += range.size();
}

Range PathQueue::take() {
  const Path<float> dummy = dummy_path(buffer_.capacity());
  for (uint32_t i = size_; i < round_up_to_lanes(size_); ++i) store_path(buffer_.state(), i, dummy);
  return {0, std::exchange(size_, 0)};
}

}  // namespace lanewise
