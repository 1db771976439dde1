#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/accumulate.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Blackens samples with a NaN, infinite or negative channel, in place; returns how many.
uint32_t BlackenInvalid(const PathState& s) {
  const DF d;
  const VF largest = Splat(3.4028235e38f), zero = hn::Zero(d);
  const auto valid = [&](VF x) HWY_ATTR { return hn::And(hn::Ge(x, zero), hn::Le(x, largest)); };
  uint32_t invalid = 0;
  for (size_t i = 0; i < s.batch.paths; i += hn::Lanes(d)) {
    const Vec3 L = LoadVec3(s.result_r, s.result_g, s.result_b, i);
    const MF good = hn::And(valid(L.x), hn::And(valid(L.y), valid(L.z)));
    if (HWY_LIKELY(hn::AllTrue(d, good))) continue;
    // Slots past the last path hold what earlier waves left there.
    const MF counted = hn::FirstN(d, s.batch.paths - i);
    invalid += static_cast<uint32_t>(hn::CountTrue(d, hn::AndNot(good, counted)));
    StoreVec3(IfThenElseZero(good, L), s.result_r, s.result_g, s.result_b, i);
  }
  return invalid;
}

uint32_t Accumulate(const PathState& s, PixelSums* film) {
  const uint32_t invalid = BlackenInvalid(s);
  const Batch& batch = s.batch;
  uint64_t pixel_index = batch.first_path / batch.samples;
  uint32_t sample = static_cast<uint32_t>(batch.first_path % batch.samples);
  for (uint32_t i = 0; i < batch.paths; ++pixel_index, sample = 0) {
    PixelSums& pixel = film[batch.pixels[pixel_index]];
    PixelSums sums = pixel;
    for (; sample < batch.samples && i < batch.paths; ++sample, ++i) {
      sums.add(s.result_r[i], s.result_g[i], s.result_b[i]);
    }
    pixel = sums;
  }
  return invalid;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
HWY_EXPORT(Accumulate);
uint32_t accumulate(const PathState& s, PixelSums* film) { return HWY_DYNAMIC_DISPATCH(Accumulate)(s, film); }
}  // namespace lanewise
#endif
