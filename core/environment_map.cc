#include "core/environment_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/image.h"
#include "kernels/kernels.h"

namespace lanewise {
namespace {

using std::numbers::pi;

// Random numbers are multiples of it.
constexpr double kUnit = 0x1p-24;

// The sums up to and with each weight, over the sum of all. In whole units, so that the chance of each is exactly its difference
// from the one before; and one unit at least for whatever weighs anything.
template <class Cdf>
void accumulate_chances(const std::vector<double>& weights, Cdf cdf) {
  double all = 0;
  size_t heavy = 0;
  for (const double w : weights) all += w, heavy += w > 0;
  const double shared = 1 / kUnit - static_cast<double>(heavy);
  double sum = 0;
  size_t passed = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i], passed += weights[i] > 0;
    const double units = passed == heavy ? 1 / kUnit : static_cast<double>(passed) + std::round(shared * sum / all);
    cdf(i) = static_cast<float>(units * kUnit);
  }
}

class Compiler {
 public:
  Compiler(const Image& picture, EnvironmentMap& map) : picture_(picture), map_(map) {
    map_.width = picture.width, map_.height = picture.height;
  }

  // Whether there is any light.
  bool run() {
    copy_texels();
    const size_t rows = size_t{map_.height} + 1;
    map_.rows.resize(rows);
    map_.column_cdf.resize(rows * map_.width);
    std::vector<double> row_weights(rows), weights(map_.width);
    for (size_t row = 0; row < rows; ++row) {
      place(row);
      weigh(row, weights);
      for (const double w : weights) row_weights[row] += w;
      row_weights[row] *= solid_angle(row);
      accumulate_chances(weights, [&](size_t column) -> float& { return map_.column_cdf[row * map_.width + column]; });
    }
    if (std::ranges::all_of(row_weights, [](double w) { return w == 0; })) return false;
    accumulate_chances(row_weights, [&](size_t row) -> float& { return map_.rows[row].cdf; });
    for (size_t row = 0; row < rows; ++row) set_pdf(row);
    return true;
  }

 private:
  EnvironmentMap::Texel& texel(size_t row, size_t column) { return map_.texels[row * (map_.width + 1) + column]; }

  void copy_texels() {
    map_.texels.resize((size_t{map_.height} + 2) * (size_t{map_.width} + 1));
    for (uint32_t row = 0; row < map_.height + 2; ++row) {
      const uint32_t y = std::clamp(row, 1u, map_.height) - 1;
      for (uint32_t column = 0; column <= map_.width; ++column) {
        const float* rgb = picture_.pixel(column % map_.width, y);
        texel(row, column) = {{rgb[0], rgb[1], rgb[2]}, 0};
      }
    }
  }

  // Angle from the upper pole to a row's upper edge.
  double theta(size_t row) const {
    if (row == 0) return 0;
    return row > map_.height ? pi : pi * (static_cast<double>(row) - 0.5) / map_.height;
  }

  void place(size_t row) {
    const double upper = theta(row), lower = theta(row + 1);
    const bool north = upper + lower <= pi;
    const auto height = [&](double angle) { return 2 * std::pow(std::sin((north ? angle : pi - angle) / 2), 2); };
    map_.rows[row] = {0, static_cast<float>(height(upper)), static_cast<float>(height(lower) - height(upper)),
                      north ? 1.0f : -1.0f};
  }

  // Of each of its cells.
  double solid_angle(size_t row) const {
    const double upper = theta(row), lower = theta(row + 1);
    return 2 * pi / map_.width * 2 * std::sin((upper + lower) / 2) * std::sin((lower - upper) / 2);
  }

  void weigh(size_t row, std::vector<double>& weights) {
    const auto pair = [&](size_t column) {
      const float *a = texel(row, column).radiance, *b = texel(row + 1, column).radiance;
      return luminance(a[0], a[1], a[2]) + luminance(b[0], b[1], b[2]);
    };
    for (size_t column = 0; column < map_.width; ++column) weights[column] = (pair(column) + pair(column + 1)) / 4;
  }

  void set_pdf(size_t row) {
    const auto chance = [](float sum, float before) { return double{sum} - double{before}; };
    const double of_row = chance(map_.rows[row].cdf, row > 0 ? map_.rows[row - 1].cdf : 0);
    const float* cdf = &map_.column_cdf[row * map_.width];
    for (size_t column = 0; column < map_.width; ++column) {
      const double of_cell = of_row * chance(cdf[column], column > 0 ? cdf[column - 1] : 0);
      texel(row, column).pdf = static_cast<float>(of_cell / solid_angle(row));
    }
  }

  const Image& picture_;
  EnvironmentMap& map_;
};

}  // namespace

EnvironmentMap make_environment_map(const Image& picture, double diagonal, bool y_up) {
  EnvironmentMap map;
  if (picture.width == 0 || !Compiler(picture, map).run()) return {};
  map.y_up = y_up;
  map.reach = static_cast<float>(std::exp2(std::ceil(std::log2(2 * diagonal))));
  return map;
}

}  // namespace lanewise
