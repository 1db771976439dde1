// A ray that starts on a surface must not meet it again, and must start no farther off it than it has to. A fixed epsilon
// can be right for one size of scene only, and floats for one place.
#include <cmath>
#include <iterator>

#include "core/render.h"
#include "core/scene.h"
#include "tests/kernel_harness.h"
#include "tests/scene_paths.h"
#include "tests/scenes_harness.h"
#include "tests/stability/curve.h"
#include "tests/stability/fixed_epsilon.h"

namespace lanewise {
namespace {

#ifdef NDEBUG
constexpr int kScales = 9, kDistances = 7;
#else
constexpr int kScales = 3, kDistances = 2;
#endif

// A scene file with a COLLADA transform around all of it, camera and light too.
Scene placed(const std::string& path, const std::string& transform) {
  std::ifstream file(path);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const size_t open = text.find('>', text.find("<visual_scene")), close = text.find("</visual_scene>");
  REQUIRE(close != std::string::npos);
  text.insert(close, "</node>");
  text.insert(open + 1, "<node id=\"placed\">" + transform);
  return load_text(text);
}

std::string scale(double factor) {
  const std::string s = std::to_string(factor);
  return "<scale>" + s + " " + s + " " + s + "</scale>";
}

std::string move(double distance) {
  return "<translate>" + std::to_string(distance) + " " + std::to_string(-0.3 * distance) + " " +
         std::to_string(0.7 * distance) + "</translate>";
}

Settings small() {
  Settings settings;
  settings.width = 80, settings.height = 60, settings.threads = 1;
  return settings;
}

// What is left of a scene in a renderer that keeps world coordinates in float.
Scene rounded(Scene scene) {
  const auto round = [](glm::dvec3 p) { return glm::dvec3(glm::vec3(p)); };
  for (Mesh& mesh : scene.meshes) {
    for (glm::dvec3& p : mesh.positions) p = round(p);
  }
  for (Sphere& sphere : scene.spheres) sphere.center = round(sphere.center);
  for (Camera& camera : scene.cameras) camera.to_world[3] = {round(glm::dvec3(camera.to_world[3])), 1};
  return scene;
}

struct Change {
  double pixels, mean;  // share of pixels changed by more than 1%; relative change of the mean
};

Change change(const Image& image, const Image& from) {
  size_t changed = 0;
  double sum = 0, sum_from = 0;
  for (size_t i = 0; i < image.rgb.size(); i += 3) {
    bool differs = false;
    for (size_t k = i; k < i + 3; ++k) {
      differs |= !(std::abs(image.rgb[k] - from.rgb[k]) <= 0.01f * from.rgb[k]);
      sum += double(image.rgb[k]), sum_from += double(from.rgb[k]);
    }
    changed += differs;
  }
  return {3.0 * double(changed) / double(image.rgb.size()), std::abs(sum / sum_from - 1)};
}

// Fills the curve's points, one a plan: how far its picture is from `home`'s, and how far that of its naive form.
void compare(const Plan& home, const std::vector<Plan>& plans, const std::vector<Plan>& naive, test::Curve& curve) {
  const Image at_home = render(home).image;
  for (size_t i = 0; i < naive.size(); ++i) curve.points[i].naive = change(render(naive[i]).image, at_home).pixels;
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    const Image want = render(home).image;
    for (size_t i = 0; i < plans.size(); ++i) {
      CAPTURE(curve.points[i].x);
      const Change ours = change(render(plans[i]).image, want);
      CHECK(ours.pixels < 1e-3);
      CHECK(ours.mean < 1e-4);
      test::take_worst(curve.points[i].ours, ours.pixels);
    }
  });
}

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: a scene's picture does not know its scale") {
  test::Curve curve{.name = "self-intersection-scale",
                    .title = "The same scene, scaled: pixels that change by more than 1%",
                    .naive = "rays start 1e-4 units off surfaces",
                    .ours = "rays start each surface's error bound off it",
                    .x_axis = "scale of a room of 2.8 units",
                    .y_axis = "share of pixels changed"};
  const std::string room = test::shipped_scene("cornell_spheres.dae");
  std::vector<Plan> plans, naive;
  for (const double factor : test::log_spaced(1e-4, 1e4, kScales)) {
    plans.push_back(make_plan(placed(room, scale(factor)), small()));
    naive.push_back(test::with_fixed_epsilon(plans.back()));
    curve.points.push_back({factor, 0, 0});
  }
  compare(plans[kScales / 2], plans, naive, curve);
  CHECK(curve.points.front().naive > 0.9);
  CHECK(curve.points.back().naive > 0.3);
  test::record(curve);

  curve.name = "self-intersection-none";
  curve.title = "The same scene, scaled, with rays from surfaces themselves: pixels that change by more than 1%";
  curve.naive = "rays start on surfaces";
  const Image want = render(plans[kScales / 2]).image;
  for (int i = 0; i < kScales; ++i) {
    curve.points[i].naive = change(render(test::with_fixed_epsilon(plans[i], 0)).image, want).pixels;
    CHECK(curve.points[i].naive > 0.3);  // they meet them again at every scale
  }
  test::record(curve);
}

TEST_CASE("stability: a scene's picture does not know its place") {
  test::Curve curve{.name = "self-intersection-place",
                    .title = "The same scene, moved: pixels that change by more than 1%",
                    .naive = "world coordinates in float",
                    .ours = "float coordinates from the scene's centre",
                    .x_axis = "distance of a room of 2.8 units from the origin (units)",
                    .y_axis = "share of pixels changed"};
  const std::string room = test::shipped_scene("cornell_spheres.dae");
  std::vector<Plan> plans, naive;
  for (const double distance : test::log_spaced(10, 1e7, kDistances)) {
    const Scene scene = placed(room, move(distance));
    plans.push_back(make_plan(scene, small()));
    naive.push_back(make_plan(rounded(scene), small()));
    curve.points.push_back({distance, 0, 0});
  }
  compare(make_plan(placed(room, ""), small()), plans, naive, curve);
  CHECK(curve.worst_naive() > 0.5);
  test::record(curve);
}

TEST_CASE("stability: nor do pictures with a mesh, where the course's scenes are at hand") {
  const std::string bunny = test::course_scenes() / "CBbunny_microfacet_cu.dae";
  if (!std::filesystem::exists(bunny)) {
    MESSAGE("skipped: no " << bunny);
    return;
  }
  Settings settings = small();
  settings.threads = 0;
  settings.light_paths = false;  // by rounding, some would fall into other pixels
  const Image want = render(make_plan(placed(bunny, ""), settings)).image;
  for (const std::string& transform : {scale(1e-4), scale(1e4), move(1e5)}) {
    CAPTURE(transform);
    const Change ours = change(render(make_plan(placed(bunny, transform), settings)).image, want);
    CHECK(ours.pixels < 1e-3);
    CHECK(ours.mean < 1e-4);
  }
}

TEST_SUITE_END();

}  // namespace lanewise
