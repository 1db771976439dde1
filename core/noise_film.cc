#include "core/noise_film.h"

#include <algorithm>
#include <cmath>

#include "core/film.h"
#include "core/image_compare.h"
#include "core/tile.h"

namespace lanewise {

NoiseFilm::NoiseFilm(uint32_t width, uint32_t height, const Window& window, double noise, uint64_t max_samples)
    : width_(width),
      height_(height),
      window_(window),
      noise_(noise),
      max_drawn_(max_samples / kHalves),
      count_(static_cast<uint32_t>(std::min<uint64_t>(kFirstSamples, max_drawn_))),
      halves_{Half(size_t{width} * height), Half(size_t{width} * height)} {
  // The window's blocks, and those around them.
  const auto reach = [](uint32_t begin, uint32_t size, uint32_t end, uint32_t& first, uint32_t& blocks) {
    first = begin / kBlock - std::min(begin / kBlock, 1u);
    blocks = std::min((begin + size - 1) / kBlock + 2, (end + kBlock - 1) / kBlock) - first;
  };
  reach(window.x, window.width, width, blocks_.x, blocks_.width);
  reach(window.y, window.height, height, blocks_.y, blocks_.height);
  for (Half& half : halves_) {
    half.converged.resize(blocks());
    half.ended.resize(blocks());
  }
  left_ = static_cast<double>(size_t{kHalves} * blocks() * kBlock * kBlock) * count_;
}

namespace {

// 0 without a sample.
std::array<double, 3> mean_of(const Film& film, size_t i) {
  const double scale = film.samples[i] > 0 ? 1 / static_cast<double>(film.samples[i]) : 0;
  const PixelSums& sums = film.sums[i];
  return {sums.r.as<double>() * scale, sums.g.as<double>() * scale, sums.b.as<double>() * scale};
}

}  // namespace

template <class F>
void NoiseFilm::for_each_pixel(uint32_t block, const F& f) const {
  const uint32_t x = (blocks_.x + block % blocks_.width) * kBlock, y = (blocks_.y + block / blocks_.width) * kBlock;
  for (uint32_t j = y; j < std::min(y + kBlock, height_); ++j) {
    for (uint32_t i = x; i < std::min(x + kBlock, width_); ++i) f(i, j);
  }
}

uint32_t NoiseFilm::block_of(uint32_t x, uint32_t y) const {
  return (y / kBlock - blocks_.y) * blocks_.width + x / kBlock - blocks_.x;
}

std::vector<uint32_t> NoiseFilm::drawing(uint32_t half) const {
  std::vector<uint32_t> pixels;
  for (uint32_t b = 0; b < blocks(); ++b) {
    if (halves_[half].draws(b)) for_each_pixel(b, [&](uint32_t x, uint32_t y) { pixels.push_back(y * width_ + x); });
  }
  return pixels;
}

double NoiseFilm::round_pixels() const {
  double pixels = 0;
  for (uint32_t half = 0; half < kHalves; ++half) pixels += static_cast<double>(drawing(half).size());
  return pixels;
}

void NoiseFilm::drew(uint32_t half, const std::vector<uint32_t>& pixels) {
  for (const uint32_t pixel : pixels) halves_[half].film.samples[pixel] = drawn_ + count_;
}

std::vector<uint32_t> NoiseFilm::behind(uint32_t half) const {
  std::vector<uint32_t> pixels = drawing(half);
  std::erase_if(pixels, [&](uint32_t pixel) { return halves_[half].film.samples[pixel] > drawn_; });
  return pixels;
}

Window NoiseFilm::area() const {
  const uint32_t x = blocks_.x * kBlock, y = blocks_.y * kBlock;
  return {x, y, std::min(blocks_.width * kBlock, width_ - x), std::min(blocks_.height * kBlock, height_ - y)};
}

void NoiseFilm::save(SavedRender& saved) const {
  saved.area = area();
  saved.numbers = {{"drawn", drawn_}, {"count", count_}, {"total", static_cast<uint64_t>(total_)}};
  for (uint32_t h = 0; h < kHalves; ++h) {
    const Half& half = halves_[h];
    const std::string name = "half" + std::to_string(h);
    saved.put_film(name, width_, half.film);
    for (size_t c = 0; c < 3; ++c) {
      saved.put(name + ".estimate" + std::to_string(c), width_, [&](size_t i) { return half.estimate[i][c]; });
    }
    const auto block = [&](size_t i) {
      return block_of(static_cast<uint32_t>(i % width_), static_cast<uint32_t>(i / width_));
    };
    saved.put(name + ".converged", width_, [&](size_t i) { return uint32_t{half.converged[block(i)]}; });
    saved.put(name + ".ended", width_, [&](size_t i) { return uint32_t{half.ended[block(i)]}; });
  }
}

void NoiseFilm::load(const SavedRender& saved) {
  saved.check_area(area());
  drawn_ = saved.number("drawn");
  const uint64_t count = saved.number("count");
  saved.check(drawn_ <= max_drawn_ && count <= max_drawn_ - drawn_, "it has more samples than are asked for");
  saved.check(count <= kLongestRound, "damaged: its round is too long");
  count_ = static_cast<uint32_t>(count);
  total_ = static_cast<double>(saved.number("total"));
  left_ = 0;
  for (uint32_t h = 0; h < kHalves; ++h) {
    Half& half = halves_[h];
    const std::string name = "half" + std::to_string(h);
    saved.get_film(name, width_, half.film);
    const bool more = std::ranges::any_of(half.film.samples, [&](uint64_t n) { return n > drawn_ + count_; });
    saved.check(!more, "damaged: a pixel has more samples than its round");
    for (size_t c = 0; c < 3; ++c) {
      saved.get<double>(name + ".estimate" + std::to_string(c), width_,
                        [&](size_t i, double value) { half.estimate[i][c] = value; });
    }
    const auto block = [&](size_t i) {
      return block_of(static_cast<uint32_t>(i % width_), static_cast<uint32_t>(i / width_));
    };
    saved.get<uint32_t>(name + ".converged", width_,
                        [&](size_t i, uint32_t flag) { half.converged[block(i)] = flag != 0; });
    saved.get<uint32_t>(name + ".ended", width_, [&](size_t i, uint32_t flag) { half.ended[block(i)] = flag != 0; });
  }
}

double NoiseFilm::excess(const Half& half, uint32_t block) const {
  // Errors are taken relative to the mean of a quarter of the block: a single pixel's would shrink the very spike that makes
  // its variance, and the whole block's lose the dark side of an edge.
  struct Quarter {
    double pixels = 0, luminance = 0, variance = 0;
  } quarters[4];
  const uint64_t n = drawn_;
  for_each_pixel(block, [&](uint32_t x, uint32_t y) {
    Quarter& q = quarters[y / (kBlock / 2) % 2 * 2 + x / (kBlock / 2) % 2];
    const PixelSums& sums = half.film.sums[size_t{y} * width_ + x];
    q.pixels += 1;
    q.luminance += mean_luminance(sums, n);
    q.variance += luminance_variance(sums, n);
  });
  double pixels = 0, squares = 0;
  for (const Quarter& q : quarters) {
    if (q.pixels == 0) continue;
    const double allowed = noise_ * (q.luminance / q.pixels + kLeastRadiance);
    pixels += q.pixels;
    squares += q.variance / (double{kHalves} * static_cast<double>(n)) / (allowed * allowed);
  }
  return std::sqrt(squares / pixels);
}

bool NoiseFilm::converged_around(const Half& half, uint32_t block) const {
  const uint32_t x = block % blocks_.width, y = block / blocks_.width;
  for (uint32_t j = y - std::min(y, 1u); j < std::min(y + 2, blocks_.height); ++j) {
    for (uint32_t i = x - std::min(x, 1u); i < std::min(x + 2, blocks_.width); ++i) {
      if (!half.converged[j * blocks_.width + i]) return false;
    }
  }
  return true;
}

void NoiseFilm::shorten(uint32_t count) {
  count_ = std::min(count_, count);
  if (count == 0) max_drawn_ = drawn_;
}

void NoiseFilm::end_round() {
  drawn_ += count_;
  const bool last = drawn_ >= max_drawn_;
  const auto now = static_cast<double>(drawn_);
  left_ = 0;
  for (Half& half : halves_) {
    for (uint32_t b = 0; b < blocks(); ++b) {
      if (!half.draws(b)) continue;
      const double e = excess(half, b);
      if (e <= 1) half.converged[b] = 1;  // a NaN has not converged
      double pixels = 0;
      for_each_pixel(b, [&](uint32_t x, uint32_t y) {
        half.film.samples[size_t{y} * width_ + x] = drawn_;
        pixels += 1;
      });
      total_ += pixels * count_;
      const double wanted = std::min((e > 1 ? e * e : 1) * now, static_cast<double>(max_drawn_));
      left_ += pixels * (wanted - now);
    }
  }
  bool draws = false;
  for (uint32_t h = 0; h < kHalves; ++h) {
    Half& half = halves_[h];
    for (uint32_t b = 0; b < blocks(); ++b) {
      if (!half.ended[b] && (last || converged_around(halves_[1 - h], b))) {
        half.ended[b] = 1;
        for_each_pixel(b, [&](uint32_t x, uint32_t y) {
          const size_t i = size_t{y} * width_ + x;
          half.estimate[i] = mean_of(half.film, i);
        });
      }
      draws |= half.draws(b);
    }
  }
  // A quarter more each round: few decisions, and little drawn in vain.
  const uint64_t quarter = std::clamp<uint64_t>(drawn_ / 16 * 4, 4, kLongestRound);
  count_ = draws && !last ? static_cast<uint32_t>(std::min(quarter, max_drawn_ - drawn_)) : 0;
}

Image NoiseFilm::develop() const {
  Image image(window_.width, window_.height);
  for (uint32_t y = 0; y < window_.height; ++y) {
    for (uint32_t x = 0; x < window_.width; ++x) {
      const std::array<double, 3> a = mean(halves_[0], window_.x + x, window_.y + y);
      const std::array<double, 3> b = mean(halves_[1], window_.x + x, window_.y + y);
      for (size_t k = 0; k < 3; ++k) image.pixel(x, y)[k] = static_cast<float>((a[k] + b[k]) / kHalves);
    }
  }
  return image;
}

ZeroedVector<uint64_t> NoiseFilm::sample_counts() const {
  ZeroedVector<uint64_t> counts;
  counts.reserve(size_t{window_.width} * window_.height);
  for (uint32_t y = window_.y; y < window_.y + window_.height; ++y) {
    for (uint32_t x = window_.x; x < window_.x + window_.width; ++x) {
      const size_t i = size_t{y} * width_ + x;
      counts.push_back(halves_[0].film.samples[i] + halves_[1].film.samples[i]);
    }
  }
  return counts;
}

double NoiseFilm::converged() const {
  uint64_t converged = 0;
  for (uint32_t y = window_.y; y < window_.y + window_.height; ++y) {
    for (uint32_t x = window_.x; x < window_.x + window_.width; ++x) {
      const uint32_t b = block_of(x, y);
      converged += halves_[0].converged[b] && halves_[1].converged[b];
    }
  }
  return static_cast<double>(converged) / static_cast<double>(uint64_t{window_.width} * window_.height);
}

std::array<double, 3> NoiseFilm::mean(const Half& half, uint32_t x, uint32_t y) const {
  const uint32_t block = block_of(x, y);
  const size_t i = size_t{y} * width_ + x;
  return half.ended[block] ? half.estimate[i] : mean_of(half.film, i);
}

ErrorEstimate NoiseFilm::estimate_error(uint32_t threads) const {
  MeanPicture picture{window_.width, window_.height, {}};
  std::vector<std::array<float, 3>> squares;  // of half the halves' difference: the mean's error, squared
  for (uint32_t y = window_.y; y < window_.y + window_.height; ++y) {
    for (uint32_t x = window_.x; x < window_.x + window_.width; ++x) {
      const std::array<double, 3> a = mean(halves_[0], x, y), b = mean(halves_[1], x, y);
      PixelMean pixel;
      std::array<float, 3> square{};
      for (size_t c = 0; c < 3; ++c) {
        pixel.rgb[c] = static_cast<float>((a[c] + b[c]) / kHalves);
        square[c] = static_cast<float>((a[c] - b[c]) * (a[c] - b[c]) / (kHalves * kHalves));
      }
      for (const Half& half : halves_) {
        const size_t i = size_t{y} * width_ + x;
        const uint64_t n = half.film.samples[i];
        const double variance = luminance_variance(half.film.sums[i], n) / static_cast<double>(n);
        pixel.variance += static_cast<float>(variance / (kHalves * kHalves));
      }
      picture.pixels.push_back(pixel);
      squares.push_back(square);
    }
  }
  const auto square_of = [&](size_t i) { return std::array<double, 3>{squares[i][0], squares[i][1], squares[i][2]}; };
  return lanewise::estimate_error(picture, square_of, threads);
}

}  // namespace lanewise
