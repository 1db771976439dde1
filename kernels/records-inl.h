// Members of records, one record a lane. They are loaded lane by lane, four floats at a time, and transposed: gather
// instructions take two to three times as long on Zen 2 and 3, and on Intel with the fix for Downfall.
#if defined(LANEWISE_KERNELS_RECORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_RECORDS_INL_H_
#undef LANEWISE_KERNELS_RECORDS_INL_H_
#else
#define LANEWISE_KERNELS_RECORDS_INL_H_
#endif

#include <cstring>

#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

struct LaneRecords {
  const float* lane[hn::MaxLanes(DF())];

  LaneRecords() = default;
  // Records of `stride` floats at base, by index[0], index[1], ...
  HWY_INLINE LaneRecords(const float* base, size_t stride, const uint32_t* index) {
    for (size_t k = 0; k < hn::Lanes(DF()); ++k) lane[k] = base + stride * index[k];
  }

  // Members first .. first + 3; the last record must be followed by as many floats as are read past its end.
  HWY_INLINE void Get4(size_t first, VF& a, VF& b, VF& c, VF& d) const {
    HWY_ALIGN float values[4 * hn::MaxLanes(DF())];
    for (size_t k = 0; k < hn::Lanes(DF()); ++k) std::memcpy(values + 4 * k, lane[k] + first, 4 * sizeof(float));
    hn::LoadInterleaved4(DF(), values, a, b, c, d);
  }

  HWY_INLINE Vec3 GetVec3(size_t first) const {
    Vec3 v;
    VF next;
    Get4(first, v.x, v.y, v.z, next);
    return v;
  }

  HWY_INLINE VF Get(size_t member) const {
    HWY_ALIGN float values[hn::MaxLanes(DF())];
    for (size_t k = 0; k < hn::Lanes(DF()); ++k) values[k] = lane[k][member];
    return hn::Load(DF(), values);
  }
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
