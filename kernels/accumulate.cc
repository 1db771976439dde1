#include "kernels/kernels.h"

#include <algorithm>

#include "core/path_reuse.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/accumulate.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

using DD = hn::CappedTag<double, kLanes>;
using VD = hn::Vec<DD>;
using DS = hn::Rebind<float, DD>;  // as many floats

// Above this, samples are added one by one: below it, the numbers that Cut makes are below 2^50.
constexpr float kBright = 0x1p20f;

struct Seen {
  uint32_t invalid = 0;  // samples, of those that go to the film, with a NaN, infinite or negative channel
  bool bright = false;   // one is above kBright
};

// By the index of a pixel in the batch.
const uint32_t* SlotsOf(const Batch& batch) { return batch.slots ? batch.slots : batch.pixels; }

bool GoesToFilm(const Batch& batch, uint64_t i) {
  const uint64_t path = batch.first_path + i, group = batch.group;
  return i < batch.paths && SlotsOf(batch)[path / (batch.samples * group) * group + path % group] != kNoPixel;
}

// Blackens invalid samples in place.
Seen BlackenInvalid(const PathState& s) {
  const DF d;
  const VF largest = Splat(3.4028235e38f), zero = hn::Zero(d);
  const auto valid = [&](VF x) HWY_ATTR { return hn::And(hn::Ge(x, zero), hn::Le(x, largest)); };
  Seen seen;
  VF brightest = zero;
  for (size_t i = 0; i < s.batch.paths; i += hn::Lanes(d)) {
    Vec3 L = LoadVec3(s.result_r, s.result_g, s.result_b, i);
    const MF good = hn::And(valid(L.x), hn::And(valid(L.y), valid(L.z)));
    if (HWY_UNLIKELY(!hn::AllTrue(d, good))) {
      HWY_ALIGN uint32_t bits[kLanes];
      hn::Store(hn::BitCast(DU(), hn::VecFromMask(d, good)), DU(), bits);
      // Slots past the last path hold what earlier waves left there.
      for (size_t lane = 0; lane < hn::Lanes(d); ++lane) seen.invalid += !bits[lane] && GoesToFilm(s.batch, i + lane);
      L = IfThenElseZero(good, L);
      StoreVec3(L, s.result_r, s.result_g, s.result_b, i);
    }
    brightest = hn::Max(brightest, MaxElement(L));
  }
  seen.bright = !hn::AllFalse(d, hn::Gt(brightest, Splat(kBright)));
  return seen;
}

// Numbers of a sum's units, in two parts of 64 bits, units = high 2^48 + low. They are kept as the bits of a double that has
// kShift added to it, which makes integers of numbers at no cost: sums of them go modulo 2^64, and lose kShiftBits for each at
// their end.
constexpr size_t kChunk = 64;
constexpr int kLowPlaces = 48;
constexpr double kShift = 0x1.8p52;
constexpr uint64_t kShiftBits = 0x4338000000000000u;

struct alignas(64) Parts {
  uint64_t high[kChunk];
  uint64_t low[kChunk];
};

// x: from 0 to 2^(98 - kPlaces).
template <int kPlaces>
HWY_INLINE void Cut(VD x, size_t i, Parts& parts) {
  const DD d;
  const hn::RebindToUnsigned<DD> bits;
  const VD shift = hn::Set(d, kShift);
  const VD scaled = hn::Mul(x, hn::Set(d, static_cast<double>(Uint128{1} << (kPlaces - kLowPlaces))));
  const VD high = hn::Add(scaled, shift);  // rounded to an integer
  const VD rest = hn::Sub(scaled, hn::Sub(high, shift));
  const VD low = hn::Add(hn::Mul(rest, hn::Set(d, 0x1p48)), shift);
  hn::Store(hn::BitCast(bits, high), bits, parts.high + i);
  hn::Store(hn::BitCast(bits, low), bits, parts.low + i);
}

struct Chunk {
  Parts r, g, b, y, y2;
};

// Of samples begin .. begin + kChunk - 1; those behind the last path are whatever they are.
void Cut(const PathState& s, size_t begin, Chunk& chunk) {
  const DD d;
  const DS f;
  for (size_t i = 0; i < kChunk && begin + i < s.batch.paths; i += hn::Lanes(d)) {
    const auto load = [&](const float* x) HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(f, x + begin + i)); };
    const VD r = load(s.result_r), g = load(s.result_g), b = load(s.result_b);
    const VD weighted = hn::Add(hn::Add(hn::Mul(hn::Set(d, 0.2126), r), hn::Mul(hn::Set(d, 0.7152), g)),
                                hn::Mul(hn::Set(d, 0.0722), b));
    const VD y = hn::PromoteTo(d, hn::DemoteTo(f, weighted));
    Cut<72>(r, i, chunk.r);
    Cut<72>(g, i, chunk.g);
    Cut<72>(b, i, chunk.b);
    Cut<72>(y, i, chunk.y);
    Cut<56>(hn::Mul(y, y), i, chunk.y2);
  }
}

// Every kStep-th from begin on.
template <size_t kStep, class Sum>
HWY_INLINE void Add(const Parts& parts, size_t begin, size_t end, Sum& sum) {
  uint64_t high = 0, low = 0;
  for (size_t i = begin; i < end; i += kStep) {
    high += parts.high[i];
    low += parts.low[i];
  }
  const uint64_t samples = (end - begin + kStep - 1) / kStep;
  high -= samples * kShiftBits;
  low -= samples * kShiftBits;
  sum += Sum((Uint128{high} << kLowPlaces) + static_cast<Uint128>(static_cast<int64_t>(low)));
}

// kGroup: the batch's.
template <size_t kGroup>
void AddToFilm(const PathState& s, bool bright, PixelSums* film) {
  const Batch& batch = s.batch;
  const uint32_t* slots = SlotsOf(batch);
  const uint64_t group_paths = uint64_t{batch.samples} * kGroup;
  uint64_t pixel_index = batch.first_path / group_paths * kGroup;
  uint64_t left = group_paths - batch.first_path % group_paths;  // of the group's paths
  Chunk chunk;
  for (size_t begin = 0; begin < batch.paths; begin += kChunk) {
    const size_t size = std::min<size_t>(kChunk, batch.paths - begin);
    if (!bright) Cut(s, begin, chunk);
    for (size_t first = 0, end = 0; first < size; first = end) {
      end = std::min<size_t>(size, first + left);
      left -= end - first;
      for (size_t i = first; i < first + kGroup; ++i) {
        const uint32_t slot = slots[pixel_index + i - first];
        if (kGroup > 1 && slot == kNoPixel) continue;
        PixelSums& sums = film[slot];
        if (HWY_LIKELY(!bright)) {
          Add<kGroup>(chunk.r, i, end, sums.r);
          Add<kGroup>(chunk.g, i, end, sums.g);
          Add<kGroup>(chunk.b, i, end, sums.b);
          Add<kGroup>(chunk.y, i, end, sums.y);
          Add<kGroup>(chunk.y2, i, end, sums.y2);
          continue;
        }
        for (size_t k = begin + i; k < begin + end; k += kGroup) {
          sums.add(s.result_r[k], s.result_g[k], s.result_b[k]);
        }
      }
      if (left == 0) pixel_index += kGroup, left = group_paths;
    }
  }
}

uint32_t Accumulate(const PathState& s, PixelSums* film) {
  const Seen seen = BlackenInvalid(s);
  (s.batch.group == 1 ? AddToFilm<1> : AddToFilm<kPathsTogether>)(s, seen.bright, film);
  return seen.invalid;
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
