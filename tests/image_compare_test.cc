#include "core/image_compare.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/types.h"

namespace lanewise {
namespace {

TEST_CASE("compare_images: equal pictures are equal") {
  Image a(3, 2);
  for (size_t i = 0; i < a.rgb.size(); ++i) a.rgb[i] = static_cast<float>(i);
  const ImageComparison c = compare_images(a, a);
  CHECK(c.mean_a[0] == doctest::Approx((0 + 3 + 6 + 9 + 12 + 15) / 6.0));
  CHECK(c.mean_a == c.mean_b);
  CHECK(c.relative_difference[2] == 0);
  CHECK(c.mse == 0);
  CHECK(c.mrse == 0);
  CHECK(c.differing == 0);
}

TEST_CASE("compare_images: values worked out by hand") {
  Image a(2, 2), b(2, 2);
  b.rgb.assign(12, 0.49f);
  a.rgb = b.rgb;
  a.pixel(1, 0)[1] = 0.99f;  // one channel of one of the four pixels, by 0.5
  const ImageComparison c = compare_images(a, b);
  CHECK(c.mean_a[1] == doctest::Approx(0.615));
  CHECK(c.mean_b[1] == doctest::Approx(0.49));
  CHECK(c.relative_difference[0] == 0);
  CHECK(c.relative_difference[1] == doctest::Approx(0.615 / 0.49 - 1));
  CHECK(c.mse == doctest::Approx(0.25 / 12));
  CHECK(c.mrse == doctest::Approx(0.25 / (0.5 * 0.5) / 12));
  CHECK(c.differing == 0.25);
}

TEST_CASE("compare_images: the second picture is the reference") {
  Image dark(1, 1), bright(1, 1);
  bright.rgb.assign(3, 1.0f);
  CHECK(compare_images(bright, dark).mrse == doctest::Approx(1e4));
  CHECK(compare_images(dark, bright).mrse == doctest::Approx(1 / (1.01 * 1.01)));
  CHECK(compare_images(dark, bright).relative_difference[0] == -1);
  CHECK(std::isinf(compare_images(bright, dark).relative_difference[0]));
  CHECK(compare_images(dark, dark).relative_difference[0] == 0);
}

TEST_CASE("compare_images: NaN is not hidden") {
  Image a(2, 1), b(2, 1);
  a.rgb[0] = b.rgb[0] = std::numeric_limits<float>::quiet_NaN();
  const ImageComparison c = compare_images(a, b);
  CHECK(std::isnan(c.mean_a[0]));
  CHECK(std::isnan(c.mse));
  CHECK(c.differing == 0.5);
}

TEST_CASE("compare_images: sizes must agree") {
  CHECK_THROWS_WITH_AS(compare_images(Image(2, 3), Image(3, 2)), "the pictures differ in size: 2x3 and 3x2", Error);
}

}  // namespace
}  // namespace lanewise
