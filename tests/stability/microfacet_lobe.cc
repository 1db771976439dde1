#include "tests/stability/microfacet_lobe.h"

#include "kernels/kernels.h"
#include "tests/shading_harness.h"

namespace lanewise::test {
namespace {

Plan lobe_plan(const Lobe& lobe) {
  Settings settings;
  settings.bsdf_sampling = lobe.sampling;
  settings.course = lobe.course;
  settings.direct = Direct::kLight;  // light samples without a weight
  return material_plan({white_metal(static_cast<float>(lobe.alpha))}, settings);
}

}  // namespace

std::vector<LobeSample> sample_lobe(const Lobe& lobe, double cosine, uint32_t n) {
  PathBuffer paths(n);
  fill_alike(paths, n, cosine);
  shade_microfacet(lobe_plan(lobe), paths.state(), {0, n});
  std::vector<LobeSample> samples(n);
  for (uint32_t i = 0; i < n; ++i) {
    const Path<float> p = load_path<float>(paths.state(), i);
    samples[i] = {{p.d_x, p.d_y, p.d_z}, p.beta_g, p.pdf};
  }
  return samples;
}

std::vector<double> evaluate_lobe(const Lobe& lobe, double cosine, const std::vector<glm::dvec3>& wi) {
  const uint32_t n = static_cast<uint32_t>(wi.size());
  const Plan plan = lobe_plan(lobe);
  PathBuffer paths(n);
  fill_alike(paths, n, cosine);
  const PathState& s = paths.state();
  for (uint32_t i = 0; i < n; ++i) {
    s.l_x[i] = static_cast<float>(wi[i].x);
    s.l_y[i] = static_cast<float>(wi[i].y);
    s.l_z[i] = static_cast<float>(wi[i].z);
  }
  light_microfacet(plan, s, {0, n});
  std::vector<double> f_cos(n);
  for (uint32_t i = 0; i < n; ++i) f_cos[i] = double(s.c_g[i]) / plan.lights[0].radiance[1];
  return f_cos;
}

glm::dvec3 lobe_viewer(double cosine) {
  PathBuffer paths(1);
  fill_alike(paths, 1, cosine);
  const Path<float> p = load_path<float>(paths.state(), 0);
  return {-p.d_x, -p.d_y, -p.d_z};
}

}  // namespace lanewise::test
