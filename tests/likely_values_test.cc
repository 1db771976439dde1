#include "core/likely_values.h"

#include <doctest/doctest.h>

#include "tests/flat_means.h"

namespace lanewise {

TEST_CASE("likely values: a pixel's is its own where it is calm, its neighbours' where it is noisy") {
  MeanPicture scene = test::flat_means(5, 5, 1, 1e-6f);
  scene.pixels[12] = {{3, 3, 3}, 1e-6f};
  CHECK(LikelyValues(scene, 1)(2, 2, scene.pixels[12])[0] == doctest::Approx(3).epsilon(1e-4));  // an edge
  scene.pixels[12].variance = 4;                                                                 // a firefly
  CHECK(LikelyValues(scene, 1)(2, 2, scene.pixels[12])[1] == doctest::Approx(1));
  scene.pixels[12].variance = 1;
  CHECK(LikelyValues(scene, 1)(2, 2, scene.pixels[12])[2] == doctest::Approx(1 + 2 * 0.5));
  CHECK(LikelyValues(scene, 1)(0, 0, {{5, 5, 5}, 1e-6f})[0] == doctest::Approx(5).epsilon(1e-4));
  const MeanPicture one = test::flat_means(1, 1, 7, 100);
  CHECK(LikelyValues(one, 1)(0, 0, one.pixels[0])[0] == 7);
}

TEST_CASE("likely values: neighbours that have all missed the bright paths around are likely no darker than those") {
  MeanPicture scene = test::flat_means(12, 12, 0, 0);
  for (uint32_t y = 0; y < 12; y += 3) {
    for (uint32_t x = 0; x < 12; x += 4) scene.pixels[y * 12 + x] = {{12, 12, 12}, 144};
  }
  const PixelMean met = scene.pixels[6 * 12 + 4];
  const double around = 11 * 12 / 135.0,
               noise = 11 * 144 / 135.0 / 2 / 8;  // without the nine here; of the mean of eight
  CHECK(LikelyValues(scene, 2)(4, 6, met)[0] == doctest::Approx(noise / around).epsilon(1e-6).scale(0));
  for (PixelMean& pixel : scene.pixels) pixel.variance = 0;  // no noise: there they are bright, here they are not
  CHECK(LikelyValues(scene, 2)(4, 6, met)[0] == 0);
}

TEST_CASE("likely values: a calm pixel beside noisy ones is no better known than they") {
  MeanPicture scene = test::flat_means(3, 3, 1, 8);
  scene.pixels[4] = {{0, 0, 0}, 0};  // has met no bright path yet
  CHECK(LikelyValues(scene, 1)(1, 1, scene.pixels[4])[0] == doctest::Approx(1));
}

}  // namespace lanewise
