// Small pictures all of whose pixels expect the same, which is known.
#pragma once

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "core/image.h"
#include "core/path_reuse.h"
#include "core/scene.h"
#include "core/settings.h"
#include "tests/statistics/significance.h"

namespace lanewise::test {

#ifdef NDEBUG
constexpr uint32_t kKnownSpp = 128;
#else
constexpr uint32_t kKnownSpp = 32;
#endif

inline Settings small_picture() {
  Settings settings;
  settings.width = 16, settings.height = 12, settings.spp = kKnownSpp, settings.threads = 1;
  return settings;
}

// xfov: in radians.
inline Camera look(const glm::dvec3& eye, const glm::dvec3& target, double xfov) {
  Camera camera;
  const glm::dvec3 up = std::abs(glm::normalize(target - eye).z) < 0.99 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  camera.to_world = glm::inverse(glm::lookAt(eye, target, up));
  camera.xfov = xfov;
  return camera;
}

inline Material diffuse(const glm::dvec3& reflectance) {
  Material m;
  m.reflectance = reflectance;
  return m;
}

// p that the pixels' channel has this mean; what is within rounding of it is it. A number is the mean of a square of pixels: they
// hang together where paths are used again.
inline double pixels_p(const Image& image, size_t channel, double mean) {
  Moments squares;
  for (size_t y = 0; y < image.height; y += kTogetherSide) {
    for (size_t x = 0; x < image.width; x += kTogetherSide) {
      double sum = 0;
      for (size_t i = 0; i < kPathsTogether; ++i) {
        const size_t pixel = (y + i / kTogetherSide) * image.width + x + i % kTogetherSide;
        sum += double(image.rgb[3 * pixel + channel]);
      }
      squares.add(sum / kPathsTogether);
    }
  }
  return t_test_p(squares, mean, 2e-6 * mean);
}

}  // namespace lanewise::test
