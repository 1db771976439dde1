#include "core/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/flip_vision.h"
#include "core/image_compare.h"

namespace lanewise {
namespace {

constexpr float kColourExponent = 0.7f;

// The largest colour difference there is, from green to blue, as errors count it.
float largest_difference() {
  const float distance = flip::hyab(flip::hunt_adjusted_lab({0, 1, 0}), flip::hunt_adjusted_lab({0, 0, 1}));
  return std::pow(distance, kColourExponent);
}

// Section 4.1.3: differences up to 0.4 of the largest are spread over [0, 0.95], the rest over what is left.
float colour_error(const flip::Colour& a, const flip::Colour& b) {
  constexpr float kShare = 0.4f, kTo = 0.95f;
  static const float most = largest_difference(), knee = kShare * most;
  const float difference = std::pow(flip::hyab(a, b), kColourExponent);
  return difference < knee ? kTo / knee * difference : kTo + (difference - knee) / (most - knee) * (1 - kTo);
}

// Of column x of two rows. Sections 4.2 and 4.3: features raise the colour's error.
float pixel_error(const flip::SeenRow& a, const flip::SeenRow& b, size_t x) {
  const float feature = std::max(std::abs(a.edge[x] - b.edge[x]), std::abs(a.point[x] - b.point[x]));
  const float exponent = 1 - std::sqrt(std::sqrt(0.5f) * feature);
  return std::min(std::pow(colour_error(a.lab[x], b.lab[x]), exponent), 1.0f);
}

bool has_nan(const float* rgb) { return std::isnan(rgb[0]) || std::isnan(rgb[1]) || std::isnan(rgb[2]); }

// Finite and not below 0.
Image displayable(Image image) {
  for (size_t i = 0; i < image.rgb.size(); i += 3) {
    float* rgb = &image.rgb[i];
    if (has_nan(rgb)) std::fill_n(rgb, 3, 0.0f);
    for (size_t c = 0; c < 3; ++c) rgb[c] = std::clamp(rgb[c], 0.0f, std::numeric_limits<float>::max());
  }
  return image;
}

// The largest error over the displays. Bands of rows, each on a thread and small enough for its cache.
std::vector<float> errors_on(const std::vector<flip::Display>& displays, const Image& test, const Image& reference,
                             double pixels_per_degree) {
  check_same_size(test, reference);
  constexpr uint32_t kBandRows = 32;
  const Image a = displayable(test), b = displayable(reference);
  const flip::Filters filters(pixels_per_degree);
  std::vector<float> errors(a.rgb.size() / 3);
  tbb::parallel_for(uint32_t{0}, (a.height + kBandRows - 1) / kBandRows, [&](uint32_t band) {
    const uint32_t first = band * kBandRows, last = std::min(first + kBandRows, a.height);
    flip::SeenRow row_a, row_b;
    for (const flip::Display& display : displays) {
      const flip::SeenBand seen_a(a, display, filters, first, last), seen_b(b, display, filters, first, last);
      for (uint32_t y = first; y < last; ++y) {
        seen_a.see(y, row_a);
        seen_b.see(y, row_b);
        float* error = &errors[size_t{y} * a.width];
        for (uint32_t x = 0; x < a.width; ++x) error[x] = std::max(error[x], pixel_error(row_a, row_b, x));
      }
    }
  });
  for (size_t i = 0; i < errors.size(); ++i) {
    if (has_nan(&test.rgb[3 * i]) || has_nan(&reference.rgb[3 * i])) errors[i] = 1;
  }
  return errors;
}

// The radiance that the tone curve maps to y.
double radiance_at(double y) {
  const auto& k = flip::kAces;
  const double a = k[0] - y * k[2], half_b = (k[1] - y * k[3]) / 2, c = -y * k[4];
  return (std::sqrt(half_b * half_b - a * c) - half_b) / a;
}

}  // namespace

std::vector<float> flip_ldr(const Image& test, const Image& reference, double pixels_per_degree) {
  return errors_on({{}}, test, reference, pixels_per_degree);
}

std::vector<float> flip_hdr(const Image& test, const Image& reference, const FlipExposures& exposures,
                            double pixels_per_degree) {
  const double step = exposures.count > 1 ? (exposures.stop - exposures.start) / (exposures.count - 1) : 0;
  std::vector<flip::Display> displays;
  for (uint32_t i = 0; i < exposures.count; ++i) displays.push_back({true, std::exp2(exposures.start + i * step)});
  return errors_on(displays, test, reference, pixels_per_degree);
}

FlipExposures flip_exposures(const Image& reference) {
  const Image clean = displayable(reference);
  std::vector<double> luminances;
  for (size_t i = 0; i < clean.rgb.size(); i += 3) {
    luminances.push_back(0.2126 * clean.rgb[i] + 0.7152 * clean.rgb[i + 1] + 0.0722 * clean.rgb[i + 2]);
  }
  std::ranges::sort(luminances);
  const double most = luminances.back();
  if (most == 0) return {};
  auto begin = luminances.begin();
  if (luminances[luminances.size() / 2] == 0) begin = std::ranges::upper_bound(luminances, 0.0);
  const double median = begin[(luminances.end() - begin) / 2];
  const double white = radiance_at(0.85), start = std::log2(white / most), stop = std::log2(white / median);
  return {start, stop, static_cast<uint32_t>(std::max(2.0, std::ceil(stop - start)))};
}

FlipSummary summarize_flip(std::vector<float> errors) {
  std::ranges::sort(errors);
  double sum = 0;
  for (const float e : errors) sum += e;
  const auto weighted = [&](double share) {
    double below = 0;
    for (const float e : errors) {
      below += e;
      if (below >= share * sum) return double{e};
    }
    return double{errors.back()};
  };
  return {sum / static_cast<double>(errors.size()),
          errors.front(),
          errors.back(),
          weighted(0.25),
          weighted(0.5),
          weighted(0.75)};
}

}  // namespace lanewise
