// Points on lights, directions of -H and points in a pixel, against their densities.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "kernels/reference/emission.h"
#include "tests/kernel_harness.h"
#include "tests/shading_harness.h"
#include "tests/statistics/chi_square.h"
#include "core/verify/test_scene.h"

TEST_SUITE_BEGIN("statistics");

namespace lanewise {
namespace {

using Vec = reference::Vec3<double>;
using std::numbers::pi;

// The density of light sampling towards q on the primitive, as `emission` weighs it against a BSDF's of 1.
double density_towards(const Plan& plan, uint32_t prim, const Vec& from, const Vec& q) {
  Path<double> p;
  p.prim = prim;
  p.t = glm::length(q - from);
  const Vec d = (q - from) / p.t;
  LANEWISE_SET_VEC3(p, o, from);
  LANEWISE_SET_VEC3(p, d, d);
  p.beta_r = 1, p.pdf = 1;
  reference::emission(plan, p);
  if (p.L_r == 0) return 0;
  const double weight = p.L_r / plan.lights[plan.prim_light[prim]].radiance[0];
  return std::sqrt(1 / weight - 1);
}

// The same per area at q, where the light's normal is n.
double area_density(const Plan& plan, uint32_t prim, const Vec& from, const Vec& q, const Vec& n) {
  const Vec l = q - from;
  const double distance2 = glm::dot(l, l);
  return density_towards(plan, prim, from, q) * -glm::dot(l, n) / (distance2 * std::sqrt(distance2));
}

// What sample_light reports is what emission weighs with, but for what grazes the light.
void check_density(const Plan& plan, uint32_t prim, const Vec& from, const Vec& q, double reported) {
  if (reported < 1e3) CHECK_UNARY(std::abs(density_towards(plan, prim, from, q) / reported - 1) < 1e-3);
}

uint32_t first_prim_of_light(const Plan& plan, uint32_t light) {
  uint32_t prim = 0;
  while (plan.prim_bin[prim] != kEmitter || plan.prim_light[prim] != light) ++prim;
  return prim;
}

// A shading point that looks around with normal n, in the plan's coordinates; its rays start in it.
Path<float> shading_point(const Vec& o, const Vec& n, uint32_t light) {
  Path<float> p;
  LANEWISE_SET_VEC3(p, o, glm::vec3(o));
  LANEWISE_SET_VEC3(p, n, glm::vec3(n));
  p.pixel = 5;
  p.step = {.bounce = 1, .light = light, .light_sample = 0};
  return p;
}

Vec light_point(const PathState& s, uint32_t i) {
  return Vec(s.o_x[i], s.o_y[i], s.o_z[i]) + Vec(s.l_x[i], s.l_y[i], s.l_z[i]);
}

// A patch with its coordinates (u, v), and (a, b) that cover a triangle by the unit square: u = a, v = (1 - a) b.
struct Patch {
  Vec corner, e1, e2, n;
  bool is_triangle;

  explicit Patch(const LightPatch& p)
      : corner(reference::vec3<double>(p.corner)),
        e1(reference::vec3<double>(p.e1)),
        e2(reference::vec3<double>(p.e2)),
        n(reference::vec3<double>(p.n)),
        is_triangle(p.is_triangle != 0) {}

  Vec at(double a, double b) const { return corner + a * e1 + (is_triangle ? 1 - a : 1) * b * e2; }
  // Area per a and b.
  double area(double a) const { return glm::length(glm::cross(e1, e2)) * (is_triangle ? 1 - a : 1); }
  // (a, b) of the point of its plane below q, and in z how far q is out of the patch.
  Vec locate(const Vec& q) const {
    const Vec d = q - corner, across = glm::cross(e1, e2);
    const double area2 = glm::dot(across, across);
    const double u = glm::dot(glm::cross(d, e2), across) / area2, v = glm::dot(glm::cross(e1, d), across) / area2;
    const double b = is_triangle ? v / std::max(1 - u, 1e-12) : v;
    return {u, b, std::max({-u, u - 1, -b, b - 1, std::abs(glm::dot(d, n))})};
  }
};

// All the patches of a light side by side: x is the patch's number + a, y is b.
double patches_p(const Plan& plan, const Path<float>& point) {
  const PlanLight& light = plan.lights[point.step.light];
  const uint32_t first_prim = first_prim_of_light(plan, point.step.light);
  std::vector<Patch> patches;
  for (uint32_t k = 0; k < light.patches; ++k) patches.emplace_back(plan.light_patches[light.first_patch + k]);
  const Vec from = LANEWISE_VEC3(point, o);
  const auto density = [&](double x, double b) {
    const uint32_t k = std::min(static_cast<uint32_t>(x), light.patches - 1);
    const double a = x - k;
    return area_density(plan, first_prim + k, from, patches[k].at(a, b), patches[k].n) * patches[k].area(a);
  };
  test::ChiSquare test({{0, double(light.patches)}, {0, 1}, 12 * light.patches, 12, density});
  test::for_each_draw(sample_light, plan, point, test::kDraws / 4, [&](const PathState& s, uint32_t i) {
    if (s.l_pdf[i] == 0) return test.add_void();
    const Vec q = light_point(s, i);
    uint32_t best = 0;
    for (uint32_t k = 1; k < light.patches; ++k) {
      if (patches[k].locate(q).z < patches[best].locate(q).z) best = k;
    }
    const Vec at = patches[best].locate(q);
    if (i < 64) check_density(plan, first_prim + best, from, q, s.l_pdf[i]);
    test.add(best + std::clamp(at.x, 0.0, 1 - 1e-9), std::clamp(at.y, 0.0, 1.0));
  });
  return test.p();
}

// A sphere by height and azimuth around the axis to the point, over the cap that the point sees.
double sphere_p(const Plan& plan, const Path<float>& point) {
  const PlanLight& light = plan.lights[point.step.light];
  const Vec center = reference::vec3<double>(light.center), from = LANEWISE_VEC3(point, o);
  const double distance = glm::length(from - center), radius = light.radius;
  const Vec axis = (from - center) / distance;
  Vec b1, b2;
  reference::frame(axis, b1, b2);
  const uint32_t prim = first_prim_of_light(plan, point.step.light);
  const auto density = [&](double z, double phi) {
    const double r = std::sqrt(1 - z * z);
    const Vec n = reference::to_world(Vec(r * std::cos(phi), r * std::sin(phi), z), b1, b2, axis);
    return area_density(plan, prim, from, center + radius * n, n) * radius * radius;
  };
  const double horizon = radius / distance;
  test::ChiSquare test({{horizon, 1}, {-pi, pi}, 12, 24, density});
  test::for_each_draw(sample_light, plan, point, test::kDraws / 4, [&](const PathState& s, uint32_t i) {
    if (s.l_pdf[i] == 0) return test.add_void();
    const Vec q = light_point(s, i), n = glm::normalize(q - center);
    if (i < 64) check_density(plan, prim, from, q, s.l_pdf[i]);
    // The offset of the light's point lets it see a little beyond the horizon.
    const double z = glm::dot(n, axis);
    test.add(z > horizon - 1e-5 ? std::clamp(z, horizon + 1e-9, 1.0) : z, std::atan2(glm::dot(n, b2), glm::dot(n, b1)));
  });
  return test.p();
}

// The test box's lights, and a tent of five triangles of which a point sees some from the front.
Scene lights_scene() {
  Scene scene = test::test_box();
  scene.spheres[2].material = test::kSmallLight;
  Mesh tent;
  tent.name = "tent";
  tent.material = test::kSmallLight;
  tent.positions = {{0, 0, 1.1}, {0.4, 0, 1.3}, {0.3, 0.3, 1.4}, {0, 0.2, 1.4}, {-0.5, 0.4, 1.2}, {-0.2, -0.3, 1.4}};
  tent.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 5, 4}, {0, 1, 5}};
  scene.meshes.push_back(tent);
  return scene;
}

// generate for samples of one pixel.
struct Generate {
  uint32_t of_pixel;

  void operator()(const Plan& plan, const PathState& s, Range range) const {
    PathState batched = s;
    batched.batch = {.pixels = &of_pixel, .samples = test::kDraws, .first_sample = s.sample[0], .paths = range.size()};
    generate(plan, batched, range);
  }
};

struct CameraView {
  Vec eye, right, up, forward;
  double width, height, side;

  explicit CameraView(const Plan& plan)
      : eye(reference::vec3<double>(plan.camera.eye)),
        right(reference::vec3<double>(plan.camera.right)),
        up(reference::vec3<double>(plan.camera.up)),
        forward(reference::vec3<double>(plan.camera.forward)),
        width(plan.settings.width),
        height(plan.settings.height),
        side(plan.camera.pixel) {}

  // Column and row, from the upper left corner, at which a pinhole at the eye sees what lies in this direction.
  glm::dvec2 pixel(const Vec& d) const {
    const double scale = 1 / (glm::dot(d, forward) * side);
    return {glm::dot(d, right) * scale + width / 2, height / 2 - glm::dot(d, up) * scale};
  }
};

// A place in a pixel; a direction in float is good to 1e-4 of one.
double kept(double t) { return std::abs(t - 0.5) < 0.5001 ? std::clamp(t, 0.0, 1.0) : t; }

constexpr uint32_t kQuadLight = 0, kTriangleLight = 1, kTentLight = 2, kSphereLight = 3;

}  // namespace

TEST_CASE("chi-square: points on a parallelogram, a triangle, many patches and a sphere, on every target") {
  Settings settings;
  test::Family family;
  test::for_each_target([&](const char* target) {
    const std::string on = target;
    for (const Vec& o : {Vec(0, 0, -0.7), Vec(0.9, -0.8, 0.1), Vec(-0.6, 0.2, 0.3)}) {
      settings.seed = family.tests();
      const Plan plan = make_plan(lights_scene(), settings);
      REQUIRE(plan.lights.size() == 4);
      REQUIRE(plan.lights[kTentLight].patches == 5);
      const Vec n = glm::normalize(Vec(0.2, -0.3, 1));
      family.add(on + " parallelogram", patches_p(plan, shading_point(o, n, kQuadLight)));
      family.add(on + " triangle", patches_p(plan, shading_point(o, n, kTriangleLight)));
      family.add(on + " tent", patches_p(plan, shading_point(o, n, kTentLight)));
      family.add(on + " sphere", sphere_p(plan, shading_point(o, n, kSphereLight)));
    }
  });
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("chi-square: uniform directions of -H, on every target") {
  test::Family family;
  const Plan plan = test::material_plan({test::grey(1)});
  Path<float> path;
  path.pixel = 9;
  LANEWISE_SET_VEC3(path, s, glm::vec3(0, 0.6f, 0.8f));
  LANEWISE_SET_VEC3(path, d, glm::vec3(0.6f, 0.48f, 0.64f));  // from behind: the hemisphere is around -s
  const Vec z(0, -0.6, -0.8), x(1, 0, 0), y = glm::cross(z, x);
  test::for_each_target([&](const char* target) {
    test::ChiSquare test({{0, 1}, {-pi, pi}, 16, 32, [](double, double) { return 1 / (2 * pi); }});
    bool right_pdf = true;
    test::for_each_draw(sample_hemisphere, plan, path, test::kDraws / 4, [&](const PathState& s, uint32_t i) {
      const Vec l(s.l_x[i], s.l_y[i], s.l_z[i]);
      test.add(std::min(glm::dot(l, z), 1.0), std::atan2(glm::dot(l, y), glm::dot(l, x)));
      right_pdf &= std::abs(s.l_pdf[i] - 1 / (2 * pi)) < 1e-7;
    });
    CHECK(right_pdf);
    family.add(target, test.p());
  });
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("chi-square: camera rays are uniform in their pixel, on every target") {
  test::Family family;
  Settings settings;
  settings.width = 480, settings.height = 360;
  const Plan plan = test::test_plan(settings);
  const CameraView view(plan);
  test::for_each_target([&](const char* target) {
    for (const uint32_t pixel : {0u, 479u, 180u * 480 + 240, 359u * 480 + 17}) {
      test::ChiSquare test({{0, 1}, {0, 1}, 16, 16, [](double, double) { return 1.0; }});
      test::for_each_draw(Generate{pixel}, plan, {}, test::kDraws / 4, [&](const PathState& s, uint32_t i) {
        const glm::dvec2 in_pixel = view.pixel({s.d_x[i], s.d_y[i], s.d_z[i]}) - glm::dvec2(pixel % 480, pixel / 480);
        test.add(kept(in_pixel.x), kept(in_pixel.y));
      });
      family.add(std::string(target) + " pixel " + std::to_string(pixel), test.p());
    }
  });
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE(
    "chi-square: origins are uniform on the lens, and all rays of a point in the pixel meet in focus, on every "
    "target") {
  test::Family family;
  Settings settings;
  settings.width = 480, settings.height = 360;
  settings.lens_radius = 0.15, settings.focal_distance = 2.5;
  const Plan plan = test::test_plan(settings);
  const CameraView view(plan);
  test::for_each_target([&](const char* target) {
    // Over squared radius and azimuth, and over the pixel, in the plane in focus.
    test::ChiSquare lens({{0, 1}, {-pi, pi}, 16, 32, [](double, double) { return 1 / (2 * pi); }});
    test::ChiSquare focus({{0, 1}, {0, 1}, 16, 16, [](double, double) { return 1.0; }});
    constexpr uint32_t kPixel = 100 * 480 + 333;
    test::for_each_draw(Generate{kPixel}, plan, {}, test::kDraws / 4, [&](const PathState& s, uint32_t i) {
      const Vec offset = Vec(s.o_x[i], s.o_y[i], s.o_z[i]) - view.eye, d(s.d_x[i], s.d_y[i], s.d_z[i]);
      const double x = glm::dot(offset, view.right) / 0.15, y = glm::dot(offset, view.up) / 0.15;
      lens.add(std::min(x * x + y * y, 1.0), std::atan2(y, x));
      const Vec at = offset + d * ((2.5 - glm::dot(offset, view.forward)) / glm::dot(d, view.forward));
      const glm::dvec2 in_pixel = view.pixel(at) - glm::dvec2(333, 100);
      focus.add(kept(in_pixel.x), kept(in_pixel.y));
    });
    family.add(std::string(target) + " lens", lens.p());
    family.add(std::string(target) + " focus", focus.p());
  });
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

}  // namespace lanewise

TEST_SUITE_END();
