// What rank 0 and the others say to each other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/bytes.h"
#include "core/profile.h"

namespace lanewise {

// The first byte of a message, and what follows it.
enum class MessageKind : uint8_t {
  kReady,      // to rank 0: threads, identity
  kFailed,     // to rank 0: why
  kDraw,       // to another: desk, first sample, count, pixels as runs
  kDrawn,      // to rank 0: desk, Drawn, each pixel's sums packed; of light paths as pack_splats() has them
  kDrawLight,  // to another: desk, LightPiece
  kEnd,        // to another
  kProfile     // to rank 0, the last: what it counted, nothing if it failed
};

inline ByteWriter message(MessageKind kind) {
  ByteWriter out;
  out.put(kind);
  return out;
}

inline MessageKind kind_of(const std::string& bytes) { return static_cast<MessageKind>(bytes.at(0)); }

// Pixels that follow each other, as most of a tile's do.
struct PixelRun {
  uint32_t first, count;
};

std::vector<PixelRun> runs_of(const std::vector<uint32_t>& pixels);
std::vector<uint32_t> pixels_of(const std::vector<PixelRun>& runs);

// Without the stages that did not run.
void put(ByteWriter& out, const Profile& profile);
Profile get_profile(ByteReader& in);

}  // namespace lanewise
