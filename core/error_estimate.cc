#include "core/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/image_compare.h"
#include "core/likely_values.h"
#include "core/near_pixels.h"
#include "core/probes.h"
#include "core/workers.h"
#include "kernels/kernels.h"

namespace lanewise {
namespace {

// Relative variance that likely values leave in the estimate: where all are those that were seen, and of that which hangs on values
// e times, up or down, what was seen. Measured on the course's scenes, see perf/results/error_estimate.md.
constexpr double kLikelyValueError = 0.05 * 0.05, kDoubt = 0.1;

// Of a picture's squared error to what its samples' variances say. More is chance: one bright path among few probes. Scrambled nets
// are, where they do not help, as good as independent samples (Owen, Annals of Statistics 25, 1997).
constexpr double kMostFactor = 1;

// The mean over channels of square / (truth + 0.01)^2.
double relative(const std::array<double, 3>& square, const std::array<double, 3>& truth) {
  double sum = 0;
  for (size_t c = 0; c < 3; ++c) sum += square[c] / ((truth[c] + kLeastRadiance) * (truth[c] + kLeastRadiance));
  return sum / 3;
}

struct Sums {
  double terms = 0, squares = 0;

  void add(double term) { terms += term, squares += term * term; }
  double share_of(const Sums& whole) const { return whole.terms > 0 ? terms / whole.terms : 0; }
  // Relative variance of the sum of that many independent terms.
  double variance(double n) const {
    return terms > 0 && n > 1 ? std::max(0.0, squares / (terms * terms) * n - 1) / (n - 1) : 0;
  }
};

size_t square_columns(const MeanPicture& picture) { return picture.square_column(picture.width - 1) + size_t{1}; }
size_t square_rows(const MeanPicture& picture) { return picture.square_row(picture.height - 1) + size_t{1}; }

// The sums over the whole picture, a term for each of its squares, of as many kinds of errors as f(x, y) gives: std::array of relative
// squares. With the same bits for any number of threads.
template <size_t kKinds, class F>
std::array<Sums, kKinds> sum_squares(const MeanPicture& picture, uint32_t threads, const F& f) {
  std::vector<std::array<Sums, kKinds>> rows(square_rows(picture));
  for_each_row(threads, static_cast<uint32_t>(rows.size()), [&](uint32_t row) {
    std::vector<std::array<double, kKinds>> terms(square_columns(picture));
    const size_t begin = size_t{row} * picture.side, end = begin + picture.side;
    for (auto y = static_cast<uint32_t>(std::max<size_t>(begin, picture.row) - picture.row);
         y < std::min<size_t>(end - picture.row, picture.height); ++y) {
      for (uint32_t x = 0; x < picture.width; ++x) {
        const std::array<double, kKinds> kinds = f(x, y);
        for (size_t k = 0; k < kKinds; ++k) terms[picture.square_column(x)][k] += kinds[k];
      }
    }
    for (const std::array<double, kKinds>& term : terms) {
      for (size_t k = 0; k < kKinds; ++k) rows[row][k].add(term[k]);
    }
  });
  std::array<Sums, kKinds> all{};
  for (const std::array<Sums, kKinds>& row : rows) {
    for (size_t k = 0; k < kKinds; ++k) all[k].terms += row[k].terms, all[k].squares += row[k].squares;
  }
  return all;
}

// Is all the pixel's variance one bright path's, such as few neighbours have met? One sample F among n dark ones has the variance
// (F / n)^2 of their mean, and lifts it by F / n. (That is what it is off by, too, whatever the other samples are like.) Pixels at
// the edge of something bright look the same, but for what is beside them.
bool is_firefly(const MeanPicture& picture, uint32_t x, uint32_t y, const PixelMean& centre) {
  constexpr float kOutlier = 16, kAlike = 4;
  int neighbours = 0, calmer = 0;
  double around = 0, brightest = 0;
  for_each_neighbour(picture, x, y, [&](const PixelMean& pixel) {
    const double value = luminance(pixel.rgb);
    neighbours += 1, around += value, brightest = std::max(brightest, value);
    calmer += kOutlier * pixel.variance < centre.variance;
  });
  const double value = luminance(centre.rgb);
  if (calmer <= neighbours / 2 || value <= brightest) return false;  // the median is not among the calmer
  const double lift = value - around / neighbours, lift2 = lift * lift;
  return lift2 < kAlike * centre.variance && kAlike * lift2 > centre.variance;
}

// How far a likely value is from what was seen: the square of the logarithm of their ratio.
double doubt(const std::array<double, 3>& likely, const PixelMean& seen) {
  return std::pow(std::log((luminance(likely) + kLeastRadiance) / (luminance(seen.rgb) + kLeastRadiance)), 2);
}

// variance: relative, of what the terms have been multiplied by. doubt: the mean over the terms.
ErrorEstimate with_interval(const MeanPicture& picture, const Sums& all, double variance, double doubt) {
  const auto pixels = static_cast<double>(picture.pixels.size());
  const auto squares = static_cast<double>(square_columns(picture) * square_rows(picture));
  // Both the picture's own error and what is known of it vary.
  variance += 2 * all.variance(squares) + kLikelyValueError + kDoubt * doubt;
  const double value = all.terms / pixels, spread = std::exp(1.96 * std::sqrt(variance));
  return {value, value / spread, value * spread};
}

}  // namespace

ErrorEstimate estimate_error(const MeanPicture& picture, const SquaredError& squares, uint32_t threads) {
  const LikelyValues likely_value(picture, threads);
  const auto relative_square = [&](uint32_t x, uint32_t y) {
    const size_t i = size_t{y} * picture.width + x;
    const std::array<double, 3> likely = likely_value(x, y, picture.pixels[i]);
    const double term = relative(squares(i), likely);
    return std::array{term, term * doubt(likely, picture.pixels[i])};
  };
  const auto [all, doubted] = sum_squares<2>(picture, threads, relative_square);
  return with_interval(picture, all, 0, doubted.share_of(all));
}

ErrorEstimate estimate_error(const MeanPicture& picture, const MeanPicture* light, const Probes& probes,
                             uint32_t threads) {
  MeanPicture with_light;
  if (light) {
    with_light = picture;
    for (size_t i = 0; i < picture.pixels.size(); ++i)
      with_light.pixels[i] = sum_of(picture.pixels[i], light->pixels[i]);
  }
  const MeanPicture& whole = light ? with_light : picture;
  const LikelyValues likely_value(whole, threads);
  const auto place = [&](size_t i) {
    return std::pair(static_cast<uint32_t>(i % picture.width), static_cast<uint32_t>(i / picture.width));
  };
  const auto [calm, fireflies, by_light, doubted] = sum_squares<4>(whole, threads, [&](uint32_t x, uint32_t y) {
    const size_t i = size_t{y} * picture.width + x;
    const double variance = picture.pixels[i].variance, of_light = light ? light->pixels[i].variance : 0;
    if (variance == 0 && of_light == 0) return std::array<double, 4>{};
    const std::array<double, 3> likely = likely_value(x, y, whole.pixels[i]);
    const double to_relative = relative({1, 1, 1}, likely);
    const bool firefly = is_firefly(picture, x, y, picture.pixels[i]);
    return std::array{firefly ? 0 : variance * to_relative, firefly ? variance * to_relative : 0,
                      of_light * to_relative, (variance + of_light) * to_relative * doubt(likely, whole.pixels[i])};
  });

  // The ratio of what squared differences say to what variances say (Cochran, Sampling Techniques, 1977, ch. 6): bright paths
  // that chance has dealt to the probes are in both. Fireflies are left out, whose ratio is 1.
  std::vector<std::array<double, 2>> terms;  // of each square of probes: by difference, by variance
  for (size_t k = 0; k < probes.pixels().size(); ++k) {
    if (!probes.continues(k)) terms.emplace_back();
    const size_t i = probes.place(k);
    const PixelMean &first = picture.pixels[i], second = probes.second(k);
    const auto [x, y] = place(i);
    if (is_firefly(picture, x, y, first) || is_firefly(picture, x, y, second)) continue;
    const double v = double{first.variance} + second.variance;
    std::array<double, 3> difference2{};
    for (size_t c = 0; c < 3; ++c) difference2[c] = std::pow(double{first.rgb[c]} - second.rgb[c], 2);
    std::array<double, 2>& term = terms.back();
    for (const PixelMean& one : {first, second}) {
      const PixelMean centre = light ? sum_of(one, light->pixels[i]) : one;
      const std::array<double, 3> truth = likely_value(x, y, centre);
      term[0] += relative(difference2, truth);
      term[1] += relative({v, v, v}, truth);
    }
  }
  double by_difference = 0, by_variance = 0;
  for (const auto& [d, v] : terms) by_difference += d, by_variance += v;
  double factor = 1, variance = 0;
  if (by_variance > 0 && by_difference > 0) {
    const double n = static_cast<double>(terms.size());
    const double ratio = by_difference / by_variance;
    factor = std::min(ratio, kMostFactor);
    double residues = 0;
    for (const auto& [d, v] : terms) residues += std::pow(d - ratio * v, 2);
    variance = n / std::max(n - 1, 1.0) * residues / (by_difference * by_difference);
  }
  const Sums all{factor * calm.terms + fireflies.terms + by_light.terms,
                 factor * factor * calm.squares + fireflies.squares + by_light.squares};
  const double share = all.terms > 0 ? factor * calm.terms / all.terms : 0;
  const Sums unscaled{calm.terms + fireflies.terms + by_light.terms};
  return with_interval(picture, all, share * share * variance, doubted.share_of(unscaled));
}

}  // namespace lanewise
