#include "core/texture.h"

#include "core/srgb.h"

namespace lanewise {
namespace {

std::array<float, 256> make_table() {
  std::array<float, 256> table{};
  for (size_t v = 0; v < table.size(); ++v)
    table[v] = static_cast<float>(linear_from_srgb(static_cast<double>(v) / 255));
  return table;
}

}  // namespace

const std::array<float, 256> kLinearOfByte = make_table();

glm::dvec3 linear(uint32_t texel) {
  return {kLinearOfByte[texel & 255], kLinearOfByte[texel >> 8 & 255], kLinearOfByte[texel >> 16 & 255]};
}

glm::dvec3 mean(const Texture& texture) {
  glm::dvec3 sum(0.0);
  for (const uint32_t texel : texture.texels) sum += linear(texel);
  return sum / static_cast<double>(texture.texels.size());
}

}  // namespace lanewise
