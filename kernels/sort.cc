#include <bit>

#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/sort.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/compress-inl.h"
#include "kernels/simd-inl.h"

#ifndef LANEWISE_KERNELS_SORT_ONCE
#define LANEWISE_KERNELS_SORT_ONCE
namespace lanewise {

// All fields of a state as arrays of 4-byte words, the KEPT ones first, as the list has them.
struct FieldWords {
#define LANEWISE_COUNT(type, name, meaning) +1
#define LANEWISE_IGNORE(type, name, meaning)
  static constexpr int kKept = 0 LANEWISE_PATH_FIELDS(LANEWISE_COUNT, LANEWISE_IGNORE);
  static constexpr int kAll = 0 LANEWISE_PATH_FIELDS(LANEWISE_COUNT, LANEWISE_COUNT);
#undef LANEWISE_IGNORE
#undef LANEWISE_COUNT
  uint32_t* words[kAll];

  explicit FieldWords(const PathState& s) {
    int n = 0;
#define LANEWISE_WORDS(type, name, meaning) words[n++] = reinterpret_cast<uint32_t*>(s.name);
    LANEWISE_PATH_FIELDS(LANEWISE_WORDS, LANEWISE_WORDS)
#undef LANEWISE_WORDS
  }
};

// What the padding of every bin is filled with: the dummy path.
struct DummyWords {
  uint32_t words[FieldWords::kAll];

  explicit DummyWords(uint32_t capacity) {
    const Path<float> dummy = dummy_path(capacity);
    int n = 0;
#define LANEWISE_WORD(type, name, meaning) words[n++] = std::bit_cast<uint32_t>(dummy.name);
    LANEWISE_PATH_FIELDS(LANEWISE_WORD, LANEWISE_WORD)
#undef LANEWISE_WORD
  }
};

// Those of the first `fields` of the list that are not one array for both states.
struct MovedFields {
  int count = 0;
  const uint32_t* source[FieldWords::kKept];
  uint32_t* target[FieldWords::kKept];

  MovedFields(const PathState& from, const PathState& to, int fields) {
    const FieldWords source_words(from), target_words(to);
    for (int f = 0; f < fields; ++f) {
      if (source_words.words[f] == target_words.words[f]) continue;
      source[count] = source_words.words[f];
      target[count++] = target_words.words[f];
    }
  }
};

}  // namespace lanewise
#endif

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// The bins of the paths at slot i; padding gets kBinCount, which is no bin.
HWY_INLINE VU LoadBins(const PathState& from, size_t i, VU padding_slot) {
  const DU d;
  const auto padding = hn::Eq(hn::Load(d, from.slot + i), padding_slot);
  return hn::IfThenElse(padding, hn::Set(d, uint32_t{kBinCount}), hn::Load(d, from.bin + i));
}

// How many paths each bin gets, and where.
HWY_INLINE Bins CountBins(const PathState& from, Range range, VU padding_slot) {
  const DU d;
  VU counts[kBinCount];
  for (VU& count : counts) count = hn::Zero(d);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const VU bin = LoadBins(from, i, padding_slot);
    for (uint32_t b = 0; b < kBinCount; ++b) {
      counts[b] = hn::Sub(counts[b], hn::VecFromMask(d, hn::Eq(bin, hn::Set(d, b))));
    }
  }
  Bins bins;
  uint32_t begin = 0;
  for (uint32_t b = 0; b < kBinCount; ++b) {
    bins.bin[b] = {begin, begin + hn::GetLane(hn::SumOfLanes(d, counts[b]))};
    begin = round_up_to_lanes(bins.bin[b].end);
  }
  return bins;
}

// Dummy paths from slot `end` on, for as many slots as a bin may be short of.
HWY_INLINE void Pad(const FieldWords& target, const DummyWords& dummy, uint32_t end) {
  const DU d;
  for (int f = 0; f < FieldWords::kAll; ++f) {
    const VU fill = hn::Set(d, dummy.words[f]);
    for (size_t k = 0; k < kLanes; k += hn::Lanes(d)) hn::StoreU(fill, d, target.words[f] + end + k);
  }
}

// Counts first, then moves bin after bin. Within a bin each vector's members are compressed in a register and stored
// whole: what a store writes past the bin's end is overwritten by the padding or by the next bin, which comes later.
// (Compressing stores are microcode on Zen 4, masked stores are slow on Zen 3; plain stores are fast everywhere.)
Bins SortByBin(const PathState& from, const PathState& to, Range range) {
  const DU d;
  const size_t lanes = hn::Lanes(d);
  const VU padding_slot = hn::Set(d, from.capacity);
  Bins bins = CountBins(from, range, padding_slot);

  const FieldWords target(to);
  const DummyWords dummy(from.capacity);
  const MovedFields kept(from, to, FieldWords::kKept), retired(from, to, kRetiredFields);
  for (uint32_t b = 0; b < kBinCount; ++b) {
    if (bins[b].size() == 0) continue;
    uint32_t cursor = bins[b].begin;
    const MovedFields& fields = b == kFinished ? retired : kept;
    for (size_t i = range.begin; i < range.end; i += lanes) {
      const auto member = hn::Eq(LoadBins(from, i, padding_slot), hn::Set(d, b));
      const size_t members = hn::CountTrue(d, member);
      if (members == 0) continue;
      if (b == kFinished) {
        const auto dead = hn::Eq(MaxElement(LoadVec3(from.beta_r, from.beta_g, from.beta_b, i)), hn::Zero(DF()));
        bins.dead += static_cast<uint32_t>(hn::CountTrue(d, hn::And(member, hn::RebindMask(d, dead))));
      }
      if (members == 1 && lanes > 1) {  // as in bins of few paths: faster than stores that straddle cache lines
        const size_t k = i + static_cast<size_t>(hn::FindFirstTrue(d, member));
        for (int f = 0; f < fields.count; ++f) fields.target[f][cursor] = fields.source[f][k];
        ++cursor;
        continue;
      }
      const Compressor compress(member);
      for (int f = 0; f < fields.count; ++f) {
        hn::StoreU(compress(hn::Load(d, fields.source[f] + i)), d, fields.target[f] + cursor);
      }
      cursor += static_cast<uint32_t>(members);
    }
    Pad(target, dummy, cursor);
  }
  return bins;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
HWY_EXPORT(SortByBin);
Bins sort_by_bin(const PathState& from, const PathState& to, Range range) {
  return HWY_DYNAMIC_DISPATCH(SortByBin)(from, to, range);
}
}  // namespace lanewise
#endif
