// Members of records, one record a lane. They are loaded lane by lane, four floats at a time, and transposed: gather
// instructions take two to three times as long on Zen 2 and 3, and on Intel with the fix for Downfall.
#if defined(LANEWISE_KERNELS_RECORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_RECORDS_INL_H_
#undef LANEWISE_KERNELS_RECORDS_INL_H_
#else
#define LANEWISE_KERNELS_RECORDS_INL_H_
#endif

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
#if HWY_TARGET == HWY_SCALAR
    a = hn::Set(DF(), lane[0][first]);
    b = hn::Set(DF(), lane[0][first + 1]);
    c = hn::Set(DF(), lane[0][first + 2]);
    d = hn::Set(DF(), lane[0][first + 3]);
#else
    // Row i holds lanes i, i + 4, i + 8, ...; each block of four floats is then transposed with its neighbours' in place.
    const DF df;
    const VF r0 = Row(df, first, 0), r1 = Row(df, first, 1), r2 = Row(df, first, 2), r3 = Row(df, first, 3);
    const VF ab_even = hn::InterleaveLower(df, r0, r2), ab_odd = hn::InterleaveLower(df, r1, r3);
    const VF cd_even = hn::InterleaveUpper(df, r0, r2), cd_odd = hn::InterleaveUpper(df, r1, r3);
    a = hn::InterleaveLower(df, ab_even, ab_odd);
    b = hn::InterleaveUpper(df, ab_even, ab_odd);
    c = hn::InterleaveLower(df, cd_even, cd_odd);
    d = hn::InterleaveUpper(df, cd_even, cd_odd);
#endif
  }

  HWY_INLINE Vec3 GetVec3(size_t first) const {
    Vec3 v;
    VF next;
    Get4(first, v.x, v.y, v.z, next);
    return v;
  }

  HWY_INLINE VF Get(size_t member) const {
#if HWY_TARGET == HWY_SCALAR
    return hn::Set(DF(), lane[0][member]);
#else
    return Single(DF(), member, 0);
#endif
  }

#if HWY_TARGET != HWY_SCALAR

 private:
  // Four floats of each of the records lane, lane + 4, ... side by side; combined in registers, since a store of parts and a
  // load of the whole would wait for each other.
  template <class D>
  HWY_INLINE hn::Vec<D> Row(D d, size_t first, size_t k) const {
    if constexpr (hn::MaxLanes(D()) == 4) {
      return hn::LoadU(d, lane[k] + first);
    } else {
      const hn::Half<D> half;
      return hn::Combine(d, Row(half, first, k + hn::MaxLanes(half)), Row(half, first, k));
    }
  }

  // One float of each of the records lane, lane + 1, ...
  template <class D>
  HWY_INLINE hn::Vec<D> Single(D d, size_t member, size_t k) const {
    if constexpr (hn::MaxLanes(D()) == 4) {
      const float *a = lane[k], *b = lane[k + 1], *c = lane[k + 2], *e = lane[k + 3];
      return hn::ConcatUpperLower(d, hn::OddEven(hn::Set(d, e[member]), hn::Set(d, c[member])),
                                  hn::OddEven(hn::Set(d, b[member]), hn::Set(d, a[member])));
    } else {
      const hn::Half<D> half;
      return hn::Combine(d, Single(half, member, k + hn::MaxLanes(half)), Single(half, member, k));
    }
  }
#endif
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
