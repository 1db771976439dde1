#include "core/image_compare.h"

#include <string>

#include "core/types.h"

namespace lanewise {
namespace {

std::string size_of(const Image& image) { return std::to_string(image.width) + "x" + std::to_string(image.height); }

double relative_difference(double a, double b) { return a == b ? 0 : a / b - 1; }

}  // namespace

void check_same_size(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) {
    throw Error("the pictures differ in size: " + size_of(a) + " and " + size_of(b));
  }
}

ImageComparison compare_images(const Image& a, const Image& b) {
  check_same_size(a, b);
  ImageComparison result;
  size_t differing = 0;
  for (size_t i = 0; i < a.rgb.size(); i += 3) {
    bool same = true;
    for (size_t c = 0; c < 3; ++c) {
      const double va = a.rgb[i + c], vb = b.rgb[i + c];
      const double error = va - vb;
      result.mean_a[c] += va;
      result.mean_b[c] += vb;
      result.mse += error * error;
      result.mrse += error * error / ((vb + kLeastRadiance) * (vb + kLeastRadiance));
      same = same && va == vb;
    }
    differing += !same;
  }
  const double pixels = static_cast<double>(a.rgb.size() / 3);
  for (size_t c = 0; c < 3; ++c) {
    result.mean_a[c] /= pixels;
    result.mean_b[c] /= pixels;
    result.relative_difference[c] = relative_difference(result.mean_a[c], result.mean_b[c]);
  }
  result.mse /= 3 * pixels;
  result.mrse /= 3 * pixels;
  result.differing = static_cast<double>(differing) / pixels;
  return result;
}

}  // namespace lanewise
