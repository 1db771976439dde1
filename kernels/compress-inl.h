// Moves the members of a mask to the front of a vector, the same way for many vectors.
#if defined(LANEWISE_KERNELS_COMPRESS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_COMPRESS_INL_H_
#undef LANEWISE_KERNELS_COMPRESS_INL_H_
#else
#define LANEWISE_KERNELS_COMPRESS_INL_H_
#endif

#include <array>

#include "kernels/simd-inl.h"

#ifndef LANEWISE_KERNELS_COMPRESS_ONCE
#define LANEWISE_KERNELS_COMPRESS_ONCE
namespace lanewise {

// Row `bits` lists the set bits of an 8-lane mask in rising order, then zeros. (hwy::Compress has tables of its own
// below AVX-512, which GCC copies to the stack at every call.)
struct CompressTable {
  alignas(64) uint8_t rows[256][8];
};

constexpr CompressTable make_compress_table() {
  CompressTable table{};
  for (int bits = 0; bits < 256; ++bits) {
    int n = 0;
    for (int lane = 0; lane < 8; ++lane) {
      if (bits >> lane & 1) table.rows[bits][n++] = static_cast<uint8_t>(lane);
    }
  }
  return table;
}

inline constexpr CompressTable kCompressTable = make_compress_table();

}  // namespace lanewise
#endif

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

#if HWY_TARGET <= HWY_AVX3 || HWY_TARGET == HWY_SCALAR

// One instruction, or one lane.
class Compressor {
 public:
  explicit HWY_INLINE Compressor(hn::Mask<DU> members) : members_(members) {}
  HWY_INLINE VU operator()(VU v) const { return hn::Compress(v, members_); }

 private:
  hn::Mask<DU> members_;
};

#else

// 4 or 8 lanes: a permutation, looked up once.
class Compressor {
 public:
  explicit HWY_INLINE Compressor(hn::Mask<DU> members) : permutation_(Permutation(members)) {}
  HWY_INLINE VU operator()(VU v) const { return hn::TableLookupLanes(v, permutation_); }

 private:
  using Indices = decltype(hn::IndicesFromVec(DU(), VU()));

  static HWY_INLINE Indices Permutation(hn::Mask<DU> members) {
    const DU d;
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, members, bits);
    const hn::Rebind<uint8_t, DU> bytes;
    return hn::IndicesFromVec(d, hn::PromoteTo(d, hn::LoadU(bytes, kCompressTable.rows[bits[0]])));
  }

  Indices permutation_;
};

#endif

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
