// The scalar path tracer: one path at a time through the twins, no waves, no sort, no vectors. Obviously correct rather
// than fast; in float it is what the SIMD renderer must reproduce, in double the oracle of its accuracy.
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>

#include "core/path_reuse.h"
#include "core/plan_connections.h"
#include "core/plan_light_paths.h"
#include "core/render.h"
#include "core/schedule.h"
#include "core/stats.h"
#include "kernels/reference/adjoint.h"
#include "kernels/reference/connect_camera.h"
#include "kernels/reference/connect_sphere.h"
#include "kernels/reference/emission.h"
#include "kernels/reference/emit.h"
#include "kernels/reference/environment.h"
#include "kernels/reference/gather_emission.h"
#include "kernels/reference/generate.h"
#include "kernels/reference/intersect.h"
#include "kernels/reference/keep_vertices.h"
#include "kernels/reference/occlude.h"
#include "kernels/reference/roulette.h"
#include "kernels/reference/sample_environment.h"
#include "kernels/reference/sample_hemisphere.h"
#include "kernels/reference/sample_light.h"
#include "kernels/reference/shade_diffuse.h"
#include "kernels/reference/shade_glass.h"
#include "kernels/reference/shade_microfacet.h"
#include "kernels/reference/shade_mirror.h"
#include "kernels/reference/shade_rough_glass.h"
#include "kernels/reference/share_paths.h"
#include "kernels/reference/surface.h"
#include "kernels/reference/take_lamps.h"
#include "kernels/reference/texture.h"

namespace lanewise {
namespace {

template <class T>
void weigh_light(const Plan& plan, Path<T>& p) {
  if (p.bin == kDiffuse) plan.textures.empty() ? reference::light_diffuse(plan, p) : reference::light_textured(plan, p);
  if (p.bin == kMicrofacet) reference::light_microfacet(plan, p);
  if (p.bin == kRoughGlass) reference::light_rough_glass(plan, p);
}

template <class T>
void shade(const Plan& plan, Path<T>& p) {
  switch (p.bin) {
    case kDiffuse:
      return plan.textures.empty() ? reference::shade_diffuse(plan, p) : reference::shade_textured(plan, p);
    case kMicrofacet:
      return reference::shade_microfacet(plan, p);
    case kRoughGlass:
      return reference::shade_rough_glass(plan, p);
    case kMirror:
      return reference::shade_mirror(plan, p);
    case kGlass:
      return reference::shade_glass(plan, p);
  }
}

template <class T>
bool is_black(const Path<T>& p) {
  return p.c_r == 0 && p.c_g == 0 && p.c_b == 0;
}

template <class T>
void add_connection(const Plan& plan, Path<T>& p, Profile& profile) {
  p.step.connection = true;
  reference::connect_sphere(plan, p);
  weigh_light(plan, p);
  p.step.connection = false;
  if (is_black(p)) return;
  profile.shadow_rays += 2;
  reference::occlude_connection(plan, p);
}

template <class T>
void add_light_sample(const Plan& plan, Path<T>& p, Profile& profile) {
  const bool hemisphere = plan.settings.direct == Direct::kHemisphere;
  const bool sky = !hemisphere && is_environment(plan, p.step.light);
  sky          ? reference::sample_environment(plan, p)
  : hemisphere ? reference::sample_hemisphere(plan, p)
               : reference::sample_light(plan, p);
  weigh_light(plan, p);
  if (is_black(p)) return;
  ++profile.shadow_rays;
  hemisphere ? reference::gather_emission(plan, p) : reference::occlude(plan, p);
}

template <class T>
void add_direct_light(const Plan& plan, Path<T>& p, Profile& profile) {
  const Settings& settings = plan.settings;
  if (p.bin >= kRoughBins || settings.direct == Direct::kBsdf) return;
  const uint32_t lights = settings.direct == Direct::kHemisphere ? 1 : sampled_lights(plan);
  for (p.step.light = 0; p.step.light < lights; ++p.step.light) {
    for (p.step.light_sample = 0; p.step.light_sample < settings.light_samples; ++p.step.light_sample) {
      if (settings.shows(p.step.bounce + 1)) add_light_sample(plan, p, profile);
      if (connects_at(plan, p.step.bounce) && !is_environment(plan, p.step.light)) add_connection(plan, p, profile);
    }
  }
}

template <class T>
void take_lamps(const Plan& plan, Path<T>& p, bool leaving) {
  p.step.diffuse = p.bin == kDiffuse;
  p.step.leaving = leaving;
  if (has_light_paths(plan)) reference::take_lamps(plan, p);
}

// Follows the path of (p.pixel, p.sample) to its end; its radiance is left in L. kept: null if paths are not used again.
template <class T>
void trace(const Plan& plan, Path<T>& p, Profile& profile, reference::KeptPath<T>* kept) {
  reference::generate(plan, p);
  ++profile.samples;
  for (uint32_t bounce = 0;; ++bounce) {
    p.step.bounce = bounce;
    if (bounce > 0) ++profile.bounce_rays;
    reference::intersect(plan, p);
    if (plan.settings.shows(bounce)) {
      if (p.bin == kEmitter) reference::emission(plan, p);
      if (p.bin == kSky) reference::environment(plan, p);
    }
    if (p.bin >= kSurfaceBins) return profile.count_paths(bounce, 1);
    reference::surface(plan, p);
    if (!plan.textures.empty() && p.bin == kDiffuse) reference::texture(plan, p);
    take_lamps(plan, p, false);
    if (kept && bounce > 0 && p.bin == kDiffuse) reference::keep_second(p, *kept);
    add_direct_light(plan, p, profile);
    shade(plan, p);
    if (kept && bounce < kFirstBounces && p.bin == kDiffuse) reference::keep_first(p, *kept);
    if (!plan.prim_normals.empty()) take_lamps(plan, p, true);
    reference::roulette(plan, p);
    if (p.beta_r == 0 && p.beta_g == 0 && p.beta_b == 0) return profile.count_paths(bounce + 1, 1);
  }
}

template <class T>
void take_adjoint(const Plan& plan, Path<T>& p, bool leaving) {
  p.step.leaving = leaving;
  if (!plan.prim_normals.empty()) reference::adjoint(plan, p);
}

// The same of a light path; see(p) where the camera sees p.L of it.
template <class T, class See>
void trace_light_path(const Plan& plan, Path<T>& p, Profile& profile, const See& see) {
  p.step.from_light = true;
  reference::emit(plan, p);
  ++profile.light_paths;
  for (uint32_t bounce = 0;; ++bounce) {
    p.step.bounce = bounce;
    if (bounce > 0) ++profile.bounce_rays;
    reference::intersect(plan, p);
    if (p.bin >= kSurfaceBins || (bounce == 0 && p.bin == kDiffuse)) return;
    reference::surface(plan, p);
    take_adjoint(plan, p, false);
    if (p.bin == kDiffuse && !plan.textures.empty()) reference::texture(plan, p);
    if (p.bin == kDiffuse && plan.settings.shows(bounce + 1)) {
      reference::connect_camera(plan, p);
      if (!is_black(p)) {
        ++profile.shadow_rays;
        reference::occlude(plan, p);
      }
      see(p);
    }
    if (bounce + 1 == plan.settings.max_depth) return;
    shade(plan, p);
    take_adjoint(plan, p, true);
    reference::roulette(plan, p);
    if (p.beta_r == 0 && p.beta_g == 0 && p.beta_b == 0) return;
  }
}

// NaN, infinite and negative samples count as black, as in accumulate.
template <class T>
bool is_valid(const reference::Vec3<T>& L) {
  const auto valid = [](T x) { return x >= 0 && std::isfinite(x); };
  return valid(L.x) && valid(L.y) && valid(L.z);
}

template <class T>
reference::Vec3<T> sample_pixel(const Plan& plan, uint32_t pixel, uint64_t sample, Profile& profile,
                                reference::KeptPath<T>* kept) {
  Path<T> p;
  p.pixel = pixel;
  p.sample = static_cast<uint32_t>(sample);
  p.step.epoch = epoch_of(sample);
  trace(plan, p, profile, kept);
  return LANEWISE_RGB(p, L);
}

template <class T>
void add_sample(const reference::Vec3<T>& L, PixelSums& sums, Profile& profile) {
  if (is_valid(L)) {
    sums.add(L.x, L.y, L.z);
  } else {
    sums.add(0, 0, 0);
    ++profile.invalid_samples;
  }
}

// One sample of each pixel of a square; film: as Batch has the slots.
template <class T>
void sample_square(const Plan& plan, const uint32_t* pixels, const uint32_t* slots, uint64_t sample, PixelSums* film,
                   Profile& profile) {
  reference::Square<T> kept;
  std::array<reference::Vec3<T>, kPathsTogether> results{};
  for (uint32_t i = 0; i < kPathsTogether; ++i) {
    if (pixels[i] != kNoPixel) results[i] = sample_pixel(plan, pixels[i], sample, profile, &kept[i]);
  }
  const auto sees = [&](uint32_t i, uint32_t, const reference::Vec3<T>& l) {
    ++profile.shadow_rays;
    return !reference::any_hit(plan, LANEWISE_VEC3(kept[i], x), l);
  };
  reference::share_paths(kept, results, sees);
  for (uint32_t i = 0; i < kPathsTogether; ++i) {
    if (slots[i] != kNoPixel) add_sample(results[i], film[slots[i]], profile);
  }
}

template <class T>
class LightPaths : public LightPathDraw {
 public:
  LightPaths(const Plan& plan, std::vector<Profile>& profiles) : plan_(plan), profiles_(profiles) {}

  std::vector<LightPiece> pieces(uint64_t first, uint64_t passes, uint32_t workers) const override {
    return light_pieces(plan_, first, passes, workers);
  }
  uint64_t passes_at_a_time(uint32_t workers) const override { return lanewise::passes_at_a_time(plan_, workers); }
  uint64_t draw(const LightPiece& piece, LightFilm& film, uint32_t worker) override {
    Profile& profile = profiles_[worker];
    const uint64_t before = profile.rays();
    Splats splats;
    const auto see = [&](const Path<T>& p) {
      const bool valid = is_valid(LANEWISE_RGB(p, L));
      if (!valid) ++profile.invalid_samples;
      if (!valid || (p.L_r == 0 && p.L_g == 0 && p.L_b == 0)) return;
      splats.push_back({p.raster, static_cast<float>(p.L_r), static_cast<float>(p.L_g), static_cast<float>(p.L_b)});
    };
    for (uint32_t i = 0; i < piece.count; ++i) {
      const uint64_t number = piece.first + i;
      Path<T> p;
      p.pixel = light_path_pixel(number);
      p.sample = light_path_sample(number);
      p.step = {.light = piece.light, .epoch = piece.epoch};
      trace_light_path(plan_, p, profile, see);
    }
    film.add(splats);
    return profile.rays() - before;
  }

 private:
  const Plan& plan_;
  std::vector<Profile>& profiles_;
};

}  // namespace

template <class T>
RenderResult render_reference(const Plan& plan, const RenderControl& control) {
  const auto start = std::chrono::steady_clock::now();
  const uint32_t threads = thread_count(plan.settings);
  std::vector<Profile> profiles(threads);
  const auto draw = [&](const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                        uint32_t worker) {
    Profile& profile = profiles[worker];
    const uint64_t before = profile.rays();
    if (reuses_paths(plan)) {
      const PixelSquares squares = squares_of(pixels, nullptr, plan.settings.width, plan.settings.height);
      for (size_t j = 0; j < squares.pixels.size(); j += kPathsTogether) {
        for (uint64_t i = first; i < first + count; ++i) {
          sample_square<T>(plan, &squares.pixels[j], &squares.slots[j], i, sums, profile);
        }
      }
      return profile.rays() - before;
    }
    for (const uint32_t pixel : pixels) {
      for (uint64_t i = first; i < first + count; ++i) {
        add_sample(sample_pixel<T>(plan, pixel, i, profile, nullptr), sums[pixel], profile);
      }
    }
    return profile.rays() - before;
  };
  const RenderControl counting = count_invalid(control, [&] {
    return std::accumulate(profiles.begin(), profiles.end(), uint64_t{0},
                           [](uint64_t sum, const Profile& p) { return sum + p.invalid_samples; });
  });
  LightPaths<T> light(plan, profiles);
  Exposure exposure =
      expose(plan.settings, threads, draw, counting, has_light_paths(plan) ? &light : nullptr, side_together(plan));

  return make_result(std::move(exposure), profiles, control.resume, std::chrono::steady_clock::now() - start);
}

template RenderResult render_reference<float>(const Plan&, const RenderControl&);
template RenderResult render_reference<double>(const Plan&, const RenderControl&);

}  // namespace lanewise
