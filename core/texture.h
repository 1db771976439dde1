// A picture that colours diffuse surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace lanewise {

// sRGB in 8 bits, as files have it: a fourth of the memory of floats, and of the cache lines that a lookup waits for.
struct Texture {
  std::string name;  // its file's, or where in a file it is
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<uint32_t> texels;  // red in the lowest byte, then green, blue; row 0 at the top
};

// A channel's value in linear light, by its byte.
extern const std::array<float, 256> kLinearOfByte;

glm::dvec3 linear(uint32_t texel);

// Of all texels, in linear light.
glm::dvec3 mean(const Texture& texture);

}  // namespace lanewise
