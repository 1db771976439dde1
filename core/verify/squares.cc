#include "core/verify/squares.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/path_buffer.h"
#include "core/path_state.h"
#include "kernels/kernels.h"
#include "kernels/reference/share_paths.h"

namespace lanewise::verify {
namespace {

using reference::KeptPath;
using reference::Vec3;
using Rng = std::mt19937;

constexpr double kUlp = 0x1p-23;

double unit(Rng& rng) { return std::uniform_real_distribution<double>(0, 1)(rng); }
Vec3<float> random_unit(Rng& rng) {
  const double z = 2 * unit(rng) - 1, phi = 2 * std::numbers::pi * unit(rng), r = std::sqrt(1 - z * z);
  return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z)};
}
Vec3<float> random_rgb(Rng& rng) {
  return {static_cast<float>(unit(rng)), static_cast<float>(unit(rng)), static_cast<float>(unit(rng))};
}

template <class T>
KeptPath<T> load_kept(const KeptVertices& kept, uint32_t i) {
  KeptPath<T> k;
#define LANEWISE_LOAD(name, meaning) k.name = kept.name[i];
  LANEWISE_KEPT_FIELDS(LANEWISE_LOAD)
#undef LANEWISE_LOAD
  return k;
}

void store_kept(const KeptVertices& kept, uint32_t i, const KeptPath<float>& k) {
#define LANEWISE_STORE(name, meaning) kept.name[i] = k.name;
  LANEWISE_KEPT_FIELDS(LANEWISE_STORE)
#undef LANEWISE_STORE
}

// Paths with what is kept of them by slot.
class KeptPaths {
 public:
  explicit KeptPaths(uint32_t paths)
      : paths_(round_up_to_lanes(paths)), buffer_(paths_ + kLanes), kept_(buffer_.capacity()) {
    state().kept = kept_.vertices();
    kept_.clear();
  }
  uint32_t paths() const { return paths_; }
  Range all() const { return {0, paths_}; }
  PathState& state() { return buffer_.state(); }

 private:
  uint32_t paths_;
  PathBuffer buffer_;
  KeptBuffer kept_;
};

// At a surface, shaded by its own normal (one in four is not), on its way.
Path<float> random_vertex(Rng& rng, uint32_t slot) {
  Path<float> p;
  p.slot = slot;
  const Vec3<float> n = random_unit(rng);
  LANEWISE_SET_VEC3(p, n, n);
  LANEWISE_SET_VEC3(p, s, rng() % 4 == 0 ? random_unit(rng) : rng() % 2 ? n : -n);
  LANEWISE_SET_VEC3(p, o, random_unit(rng));
  LANEWISE_SET_VEC3(p, d, random_unit(rng));
  LANEWISE_SET_RGB(p, beta, random_rgb(rng));
  LANEWISE_SET_RGB(p, L, random_rgb(rng));
  const uint32_t faint = rng() % 16;
  if (faint < 2) LANEWISE_SET_RGB(p, beta, Vec3<float>(faint == 0 ? 0 : kLeastShared / 2));
  p.err = 1e-5f;
  return p;
}

// Of neighbours: first vertices near each other, often on one surface, second ones around them; some lack one or both. grazes: a
// vertex may be seen at any angle.
std::array<KeptPath<float>, kPathsTogether> random_square(Rng& rng, bool grazes) {
  std::array<KeptPath<float>, kPathsTogether> square;
  const Vec3<float> middle = random_unit(rng), normal = random_unit(rng);
  const float apart = static_cast<float>(std::pow(10.0, -4 * unit(rng)));
  for (KeptPath<float>& k : square) {
    if (rng() % 8 == 0) continue;
    LANEWISE_SET_VEC3(k, x, middle + apart * random_unit(rng));
    LANEWISE_SET_VEC3(k, n, rng() % 4 == 0 ? random_unit(rng) : normal);
    LANEWISE_SET_RGB(k, f, random_rgb(rng));
    k.bounce = rng() % 8 == 0 ? 3 : 1;
    if (rng() % 8 == 0) continue;
    const Vec3<float> n = LANEWISE_VEC3(k, n);
    Vec3<float> to = random_unit(rng);
    if (glm::dot(to, n) < 0) to = -to;
    if (!grazes) to = glm::normalize(to + 0.5f * n);
    const float distance = static_cast<float>(std::pow(10.0, 1 - 3 * unit(rng)));
    LANEWISE_SET_VEC3(k, y, LANEWISE_VEC3(k, x) + distance * to);
    LANEWISE_SET_VEC3(k, m, grazes ? random_unit(rng) : glm::normalize(0.5f * random_unit(rng) - to));
    LANEWISE_SET_RGB(k, L, random_rgb(rng));
    k.gain = 1 / static_cast<float>(unit(rng) + 0.01);
  }
  return square;
}

void put_square(KeptPaths& paths, uint32_t begin, const std::array<KeptPath<float>, kPathsTogether>& square, Rng& rng) {
  const PathState& s = paths.state();
  for (uint32_t i = 0; i < kPathsTogether; ++i) {
    store_kept(s.kept, begin + i, square[i]);
    const Vec3<float> result = random_rgb(rng);
    s.result_r[begin + i] = result.x, s.result_g[begin + i] = result.y, s.result_b[begin + i] = result.z;
  }
}

double largest(const Vec3<double>& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// Some other paths' rays are blocked, by which and to where.
bool is_open(uint32_t second, uint32_t partner) { return (second * 7 + partner * 3) % 5 != 0; }

}  // namespace

double keep_first_error(uint32_t paths, uint32_t seed) {
  Rng rng(seed);
  KeptPaths all(paths);
  PathState& s = all.state();
  s.step.bounce = seed % kFirstBounces;
  std::vector<KeptPath<double>> want(all.paths());
  for (uint32_t i = 0; i < all.paths(); ++i) {
    store_path(s, i, random_vertex(rng, all.paths() - 1 - i));
    KeptPath<float> kept;
    if (rng() % 4 == 0) kept.bounce = rng() % 2 ? -1.0f : 1.0f;  // has been at a diffuse surface before
    store_kept(s.kept, s.slot[i], kept);
    want[i] = load_kept<double>(s.kept, s.slot[i]);
  }
  keep_first(Plan{}, s, all.all());
  double wrong = 0;
  for (uint32_t i = 0; i < all.paths(); ++i) {
    reference::keep_first(load_path<double>(s, i), want[i]);
    const KeptPath<double> got = load_kept<double>(s.kept, s.slot[i]);
#define LANEWISE_COMPARE(name, meaning) wrong += got.name != want[i].name;
    LANEWISE_KEPT_FIELDS(LANEWISE_COMPARE)
#undef LANEWISE_COMPARE
  }
  return wrong;
}

double keep_second_error(uint32_t paths, uint32_t seed) {
  Rng rng(seed);
  KeptPaths all(paths);
  PathState& s = all.state();
  s.step.bounce = 1 + seed % kFirstBounces;
  std::vector<Path<double>> before;
  std::vector<KeptPath<double>> want(all.paths());
  for (uint32_t i = 0; i < all.paths(); ++i) {
    const Path<float> p = random_vertex(rng, all.paths() - 1 - i);
    store_path(s, i, p);
    before.push_back(load_path<double>(s, i));
    if (rng() % 3 == 0) continue;  // no first vertex
    KeptPath<float> kept;
    kept.bounce = static_cast<float>(rng() % 4 == 0 ? s.step.bounce + 1 : s.step.bounce);
    store_kept(s.kept, p.slot, kept);
    want[i] = load_kept<double>(s.kept, p.slot);
  }
  keep_second(Plan{}, s, all.all());
  double worst = 0;
  for (uint32_t i = 0; i < all.paths(); ++i) {
    Path<double> p = before[i];
    reference::keep_second(p, want[i]);
    const KeptPath<double> got = load_kept<double>(s.kept, s.slot[i]);
    const auto off = [&](double a, double b, double of) { worst = std::max(worst, std::abs(a - b) / (kUlp * of)); };
    const double point = largest(LANEWISE_VEC3(p, o));
    off(got.y_x, want[i].y_x, point), off(got.y_y, want[i].y_y, point), off(got.y_z, want[i].y_z, point);
    if (want[i].gain > 0 || got.gain > 0) off(got.gain, want[i].gain, want[i].gain);
    // These to the bit.
    const bool same = LANEWISE_VEC3(got, m) == LANEWISE_VEC3(want[i], m) &&
                      LANEWISE_RGB(got, L) == LANEWISE_RGB(want[i], L) &&
                      Vec3<double>(s.L_r[i], s.L_g[i], s.L_b[i]) == LANEWISE_RGB(p, L) &&
                      Vec3<double>(s.beta_r[i], s.beta_g[i], s.beta_b[i]) == LANEWISE_RGB(p, beta);
    if (!same) return HUGE_VAL;
  }
  return worst;
}

double connect_paths_error(uint32_t paths, uint32_t seed) {
  Rng rng(seed);
  KeptPaths all(paths);
  PathState& s = all.state();
  for (uint32_t i = 0; i < all.paths(); i += kPathsTogether) put_square(all, i, random_square(rng, true), rng);
  double worst = 0;
  for (uint32_t partner = 1; partner < kPathsTogether; ++partner) {
    s.step.partner = partner;
    connect_paths(Plan{}, s, all.all());
    const float* const density[] = {s.c_r, s.c_g, s.c_b};
    for (uint32_t i = 0; i < all.paths(); ++i) {
      const KeptPath<double> first = load_kept<double>(s.kept, i ^ partner), second = load_kept<double>(s.kept, i);
      Vec3<double> l;
      const double want = reference::connect_paths(first, second, l), squared = glm::dot(l, l);
      const double got = density[partner - 1][i];
      if (s.err[i] != 0 || Vec3<double>(s.o_x[i], s.o_y[i], s.o_z[i]) != LANEWISE_VEC3(first, x)) return HUGE_VAL;
      if (squared == 0) continue;
      worst = std::max(worst, std::abs(got - want) * squared / kUlp);
      worst =
          std::max(worst, glm::length(Vec3<double>(s.l_x[i], s.l_y[i], s.l_z[i]) - l) / (kUlp * std::sqrt(squared)));
    }
  }
  return worst;
}

double share_paths_error(uint32_t paths, uint32_t seed) {
  Rng rng(seed);
  KeptPaths all(paths);
  PathState& s = all.state();
  std::vector<char> grazes;
  const float bad[] = {NAN, -NAN, INFINITY};
  for (uint32_t i = 0; i < all.paths(); i += kPathsTogether) {
    grazes.push_back(rng() % 2);
    std::array<KeptPath<float>, kPathsTogether> square = random_square(rng, grazes.back());
    // So that the sum of the results says something.
    for (KeptPath<float>& k : square) {
      if (grazes.back() && k.f_r > 0) k.f_r = k.f_g = k.f_b = 1;
    }
    put_square(all, i, square, rng);
    if (!grazes.back() && rng() % 4 == 0) s.result_g[i + rng() % kPathsTogether] = bad[rng() % std::size(bad)];
  }
  std::vector<Vec3<double>> before;
  for (uint32_t i = 0; i < all.paths(); ++i) before.emplace_back(s.result_r[i], s.result_g[i], s.result_b[i]);
  std::vector<reference::Square<double>> kept;
  for (uint32_t i = 0; i < all.paths(); i += kPathsTogether) {
    kept.emplace_back();
    for (uint32_t k = 0; k < kPathsTogether; ++k) kept.back()[k] = load_kept<double>(s.kept, i + k);
  }
  for (uint32_t partner = 1; partner < kPathsTogether; ++partner) {
    s.step.partner = partner;
    connect_paths(Plan{}, s, all.all());
    for (uint32_t i = 0; i < all.paths(); ++i) {
      if (!is_open(i, partner)) continue;
      s.L_r[i] += s.c_r[i], s.L_g[i] += s.c_g[i], s.L_b[i] += s.c_b[i];
    }
  }
  share_paths(Plan{}, s, all.all());
  double worst = 0;
  for (uint32_t i = 0; i < all.paths(); i += kPathsTogether) {
    const reference::Square<double>& square = kept[i / kPathsTogether];
    std::array<Vec3<double>, kPathsTogether> want;
    Vec3<double> all_of_it(0), sum(0);
    for (uint32_t k = 0; k < kPathsTogether; ++k) {
      want[k] = before[i + k];
      if (!std::isfinite(before[i + k].y)) continue;
      all_of_it += square[k].gain > 0 ? LANEWISE_RGB(square[k], L) + square[k].gain * before[i + k] : before[i + k];
    }
    reference::share_paths(square, want, [&](uint32_t first, uint32_t second, const Vec3<double>&) {
      return is_open(i + second, first ^ second);
    });
    for (uint32_t k = 0; k < kPathsTogether; ++k) {
      const Vec3<double> got(s.result_r[i + k], s.result_g[i + k], s.result_b[i + k]);
      sum += got;
      if (std::isfinite(got.y) != std::isfinite(before[i + k].y)) return HUGE_VAL;  // stays with its own pixel
      if (!std::isfinite(got.y)) continue;
      if (!grazes[i / kPathsTogether]) worst = std::max(worst, largest(got - want[k]) / (kUlp * largest(all_of_it)));
    }
    if (grazes[i / kPathsTogether]) worst = std::max(worst, largest(sum - all_of_it) / (kUlp * largest(all_of_it)));
  }
  return worst;
}

}  // namespace lanewise::verify
