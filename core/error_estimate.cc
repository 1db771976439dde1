#include "core/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/probes.h"
#include "core/workers.h"
#include "kernels/kernels.h"

namespace lanewise {
namespace {

constexpr double kLeastRadiance = 0.01;  // MRSE's

// Relative standard error that likely_value() leaves in the estimate: measured on the course's scenes, see
// perf/results/error_estimate.md.
constexpr double kLikelyValueError = 0.05;

template <class T>
double luminance_of(const std::array<T, 3>& rgb) {
  return luminance(rgb[0], rgb[1], rgb[2]);
}

// The mean over channels of square / (truth + 0.01)^2.
double relative(const std::array<double, 3>& square, const std::array<double, 3>& truth) {
  double sum = 0;
  for (size_t c = 0; c < 3; ++c) sum += square[c] / ((truth[c] + kLeastRadiance) * (truth[c] + kLeastRadiance));
  return sum / 3;
}

struct Sums {
  double terms = 0, squares = 0;

  void add(double term) { terms += term, squares += term * term; }
  // Relative variance of the sum of that many independent terms.
  double variance(double n) const {
    return terms > 0 && n > 1 ? std::max(0.0, squares / (terms * terms) * n - 1) / (n - 1) : 0;
  }
};

size_t square_columns(const MeanPicture& picture) { return picture.square_column(picture.width - 1) + size_t{1}; }
size_t square_rows(const MeanPicture& picture) { return picture.square_row(picture.height - 1) + size_t{1}; }

// Over the whole picture, a term for each of its squares, with the same bits for any number of threads.
Sums sum_relative(const MeanPicture& picture, const SquaredError& squares, uint32_t threads) {
  std::vector<Sums> rows(square_rows(picture));
  const auto sum_row = [&](size_t row, uint32_t) {
    std::vector<double> terms(square_columns(picture));
    const size_t begin = row * picture.side, end = begin + picture.side;
    for (auto y = static_cast<uint32_t>(std::max<size_t>(begin, picture.row) - picture.row);
         y < std::min<size_t>(end - picture.row, picture.height); ++y) {
      for (uint32_t x = 0; x < picture.width; ++x) {
        const size_t i = size_t{y} * picture.width + x;
        const std::array<double, 3> square = squares(i);
        if (square == std::array<double, 3>{}) continue;
        terms[picture.square_column(x)] += relative(square, likely_value(picture, x, y, picture.pixels[i]));
      }
    }
    for (const double term : terms) rows[row].add(term);
    return uint64_t{0};
  };
  run_workers(threads, rows.size(), sum_row, nullptr);
  Sums all;
  for (const Sums& row : rows) all.terms += row.terms, all.squares += row.squares;
  return all;
}

// f(pixel) for the up to eight pixels around (x, y) that are independent of it.
template <class F>
void for_each_neighbour(const MeanPicture& picture, uint32_t x, uint32_t y, const F& f) {
  for (uint32_t j = y - std::min(y, 1u); j < std::min(y + 2, picture.height); ++j) {
    for (uint32_t i = x - std::min(x, 1u); i < std::min(x + 2, picture.width); ++i) {
      const bool together =
          picture.square_column(i) == picture.square_column(x) && picture.square_row(j) == picture.square_row(y);
      if (!together) f(picture.pixels[size_t{j} * picture.width + i]);
    }
  }
}

// Is all the pixel's variance one bright path's, such as few neighbours have met? One sample F among n dark ones has the variance
// (F / n)^2 of their mean, and lifts it by F / n. (That is what it is off by, too, whatever the other samples are like.)
bool is_firefly(const MeanPicture& picture, uint32_t x, uint32_t y, const PixelMean& centre) {
  constexpr double kOutlier = 16, kAlike = 4;
  double around = 0;
  std::array<float, 8> variances{};
  size_t neighbours = 0;
  for_each_neighbour(picture, x, y, [&](const PixelMean& pixel) {
    variances[neighbours++] = pixel.variance;
    around += luminance_of(pixel.rgb);
  });
  if (neighbours == 0) return false;
  auto* const median = variances.begin() + neighbours / 2;
  std::nth_element(variances.begin(), median, variances.begin() + neighbours);
  if (centre.variance <= kOutlier * *median) return false;
  const double lift = luminance_of(centre.rgb) - around / static_cast<double>(neighbours), lift2 = lift * lift;
  return lift > 0 && lift2 < kAlike * centre.variance && kAlike * lift2 > centre.variance;
}

// variance: relative, of what the terms have been multiplied by.
ErrorEstimate with_interval(const MeanPicture& picture, const Sums& all, double variance) {
  const auto pixels = static_cast<double>(picture.pixels.size());
  const auto squares = static_cast<double>(square_columns(picture) * square_rows(picture));
  // Both the picture's own error and what is known of it vary.
  variance += 2 * all.variance(squares) + kLikelyValueError * kLikelyValueError;
  const double value = all.terms / pixels, spread = std::exp(1.96 * std::sqrt(variance));
  return {value, value / spread, value * spread};
}

}  // namespace

std::array<double, 3> likely_value(const MeanPicture& picture, uint32_t x, uint32_t y, const PixelMean& centre) {
  std::array<double, 3> around{}, own{};
  for (size_t c = 0; c < 3; ++c) own[c] = centre.rgb[c];
  double variance = centre.variance, neighbours = 0;
  for_each_neighbour(picture, x, y, [&](const PixelMean& pixel) {
    for (size_t c = 0; c < 3; ++c) around[c] += pixel.rgb[c];
    variance += pixel.variance;
    neighbours += 1;
  });
  if (neighbours == 0) return own;
  for (double& value : around) value /= neighbours;
  // Neither may a pixel that has met no bright path yet pass for calm beside noisy ones.
  variance = std::max<double>(centre.variance, variance / (neighbours + 1) / 2);
  const double difference = luminance_of(own) - luminance_of(around);
  const double weight = variance < difference * difference ? 1 - variance / (difference * difference) : 0;
  for (size_t c = 0; c < 3; ++c) around[c] += weight * (own[c] - around[c]);
  return around;
}

ErrorEstimate estimate_error(const MeanPicture& picture, const SquaredError& squares, uint32_t threads) {
  return with_interval(picture, sum_relative(picture, squares, threads), 0);
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
  const auto place = [&](size_t i) {
    return std::pair(static_cast<uint32_t>(i % picture.width), static_cast<uint32_t>(i / picture.width));
  };
  const auto sum_variances = [&](bool fireflies) {
    return sum_relative(
        whole,
        [&](size_t i) {
          const auto [x, y] = place(i);
          const double v = picture.pixels[i].variance;
          if (is_firefly(picture, x, y, picture.pixels[i]) != fireflies) return std::array<double, 3>{};
          return std::array<double, 3>{v, v, v};
        },
        threads);
  };
  const Sums calm = sum_variances(false), fireflies = sum_variances(true);
  const auto light_variance = [&](size_t i) {
    const double v = light->pixels[i].variance;
    return std::array<double, 3>{v, v, v};
  };
  const Sums by_light = light ? sum_relative(whole, light_variance, threads) : Sums{};

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
      const std::array<double, 3> truth = likely_value(whole, x, y, centre);
      term[0] += relative(difference2, truth);
      term[1] += relative({v, v, v}, truth);
    }
  }
  double by_difference = 0, by_variance = 0;
  for (const auto& [d, v] : terms) by_difference += d, by_variance += v;
  double factor = 1, variance = 0;
  if (by_variance > 0 && by_difference > 0) {
    const double n = static_cast<double>(terms.size());
    factor = by_difference / by_variance;
    double residues = 0;
    for (const auto& [d, v] : terms) residues += std::pow(d - factor * v, 2);
    variance = n / std::max(n - 1, 1.0) * residues / (by_difference * by_difference);
  }
  const Sums all{factor * calm.terms + fireflies.terms + by_light.terms,
                 factor * factor * calm.squares + fireflies.squares + by_light.squares};
  const double share = all.terms > 0 ? factor * calm.terms / all.terms : 0;
  return with_interval(picture, all, share * share * variance);
}

}  // namespace lanewise
