// The generator matrices of the first four dimensions of the Sobol sequence (Joe & Kuo, Constructing Sobol sequences with better
// two-dimensional projections, SIAM J. Sci. Comput. 30(5), 2008), for indices of kSequenceBits bits.
//
// Everything is kept with its bits reversed, least significant digit of the fraction in the highest bit: there scrambling
// by multiplication works (see rng-inl.h).
#pragma once

#include <array>
#include <cstdint>

#include "core/dimensions.h"

namespace lanewise {

constexpr uint32_t reverse_bits(uint32_t x) {
  x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
  x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
  x = (x >> 4 & 0x0F0F0F0Fu) | (x & 0x0F0F0F0Fu) << 4;
  x = (x >> 8 & 0x00FF00FFu) | (x & 0x00FF00FFu) << 8;
  return x >> 16 | x << 16;
}

using SobolMatrix = std::array<uint32_t, kSequenceBits>;

// Column j: what bit kSequenceBits - 1 - j of the index, that is bit j of the reversed index, adds (xor) to the reversed number.
constexpr SobolMatrix sobol_matrix(uint32_t dimension) {
  constexpr uint32_t kDegree[4] = {0, 1, 2, 3};                             // of the primitive polynomial
  constexpr uint32_t kInner[4] = {0, 0, 1, 1};                              // its inner coefficients
  constexpr uint32_t kFirst[4][3] = {{}, {1, 0, 0}, {1, 3, 0}, {1, 3, 1}};  // the first direction numbers m
  const uint32_t s = kDegree[dimension], a = kInner[dimension];
  uint32_t v[kSequenceBits] = {};  // of index bit i: m_i 2^(kSequenceBits - 1 - i)
  for (uint32_t i = 0; i < kSequenceBits; ++i) {
    if (dimension == 0 || i < s) {
      v[i] = (dimension == 0 ? 1 : kFirst[dimension][i]) << (kSequenceBits - 1 - i);
    } else {
      v[i] = v[i - s] ^ (v[i - s] >> s);
      for (uint32_t k = 1; k < s; ++k) v[i] ^= (a >> (s - 1 - k) & 1) * v[i - k];
    }
  }
  SobolMatrix columns = {};
  for (uint32_t j = 0; j < kSequenceBits; ++j) {
    columns[j] = reverse_bits(v[kSequenceBits - 1 - j]) >> (32 - kSequenceBits);
  }
  return columns;
}

constexpr SobolMatrix kSobol[4] = {sobol_matrix(0), sobol_matrix(1), sobol_matrix(2), sobol_matrix(3)};

// Sums of columns by groups of kBits bits of the reversed index: [group][the group's value], the last group padded with 0.
template <uint32_t kBits>
struct SobolTable {
  static constexpr uint32_t kGroups = (kSequenceBits + kBits - 1) / kBits;
  alignas(64) uint32_t sums[kGroups][1u << kBits] = {};

  constexpr explicit SobolTable(const SobolMatrix& columns) {
    for (uint32_t g = 0; g < kGroups; ++g) {
      for (uint32_t value = 0; value < 1u << kBits; ++value) {
        for (uint32_t b = 0; b < kBits; ++b) {
          const uint32_t column = g * kBits + b;
          if ((value >> b & 1) && column < kSequenceBits) sums[g][value] ^= columns[column];
        }
      }
    }
  }
};

template <uint32_t kBits>
constexpr SobolTable<kBits> kSobolTables[4] = {SobolTable<kBits>(kSobol[0]), SobolTable<kBits>(kSobol[1]),
                                               SobolTable<kBits>(kSobol[2]), SobolTable<kBits>(kSobol[3])};

}  // namespace lanewise
