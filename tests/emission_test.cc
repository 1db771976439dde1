#include "kernels/reference/emission.h"

#include <doctest/doctest.h>

#include "tests/kernel_harness.h"
#include "tests/test_scene.h"

namespace lanewise {
namespace {

// Moves the path to hit a random emitter.
void hit_emitter(const Plan& plan, std::mt19937& rng, Path<float>& p) {
  do {
    p.prim = static_cast<uint32_t>(rng() % (plan.triangles + plan.spheres));
  } while (plan.prim_bin[p.prim] != kEmitter);
}

}  // namespace

TEST_CASE("emission: SIMD against its twin in every mode of direct light") {
  for (const Direct direct : {Direct::kMis, Direct::kLight, Direct::kBsdf, Direct::kHemisphere}) {
    Settings settings;
    settings.direct = direct;
    settings.light_samples = 3;
    const Plan plan = test::test_plan(settings);
    test::check_kernel(plan,
                       {.kernel = emission,
                        .twin = reference::emission<float>,
                        .writes = {{"L_r", 1e-6, 4e-6}, {"L_g", 1e-6, 4e-6}, {"L_b", 1e-6, 4e-6}},
                        .borderline =
                            [&](const Path<float>& p, const Path<float>&) {
                              const float* n = &plan.prim_shape[4 * size_t{p.prim}];
                              return std::abs(n[0] * p.d_x + n[1] * p.d_y + n[2] * p.d_z) < 1e-4f;
                            }},
                       [&](std::mt19937& rng, Path<float>& p) { hit_emitter(plan, rng, p); });
  }
}

TEST_CASE("emission: a sphere that emits") {
  Scene scene = test::test_box();
  scene.spheres[2].material = test::kSmallLight;
  const Plan plan = make_plan(scene, {});
  test::check_kernel(plan,
                     {.kernel = emission,
                      .twin = reference::emission<float>,
                      .writes = {{"L_r", 1e-4, 1e-4}, {"L_g", 1e-4, 1e-4}, {"L_b", 1e-4, 1e-4}}},
                     [&](std::mt19937& rng, Path<float>& p) {
                       p.prim = plan.triangles + 2;
                       // A point on the sphere seen from outside, head-on enough for the cosine to be well-conditioned.
                       const float* sphere = &plan.prim_shape[4 * size_t{p.prim}];
                       const auto n = glm::normalize(glm::vec3(0.3f, float(rng() % 100) * 0.01f, 1));
                       LANEWISE_SET_VEC3(p, d, -n);
                       LANEWISE_SET_VEC3(p, o, reference::vec3<float>(sphere) + (sphere[3] + p.t) * n);
                     });
}

TEST_CASE("emission: the front emits, the back is black, a camera ray has full weight") {
  const Plan plan = test::test_plan();
  const uint32_t light = [&] {
    for (uint32_t i = 0;; ++i) {
      if (plan.prim_bin[i] == kEmitter) return i;
    }
  }();
  for (const float side : {1.0f, -1.0f}) {
    Path<double> p;
    p.prim = light, p.t = 1, p.d_z = side;  // the light faces down
    p.beta_r = p.beta_g = p.beta_b = 0.5;
    reference::emission(plan, p);
    CHECK(p.L_r == (side > 0 ? 5.0 : 0.0));
  }
}

}  // namespace lanewise
