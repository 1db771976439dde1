// Degenerate input: triangles without area, coplanar duplicates, edges of three and more faces, cameras inside spheres, pictures
// of one pixel. (Vertices that are not finite, indices out of range, empty scenes and zero samples are refused with a line each:
// scenes_finish_test.cc, scenes_bad_input_test.cc and command_line_test.cc.)
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/path_reuse.h"
#include "core/render.h"
#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"
#include "core/verify/test_scene.h"
#include "tests/trace_plan.h"

namespace lanewise {
namespace {

using test::Ray;
using test::Triangle;

Settings small() {
  Settings settings;
  settings.width = 32, settings.height = 24, settings.spp = 4, settings.threads = 1;
  return settings;
}

double mean(const Image& image) {
  double sum = 0;
  for (const float x : image.rgb) sum += double{x};
  return sum / static_cast<double>(image.rgb.size());
}

// Renders on every target, which must make no invalid sample; the last one's result.
RenderResult sound_render(const Scene& scene, const Settings& settings) {
  const Plan plan = make_plan(scene, settings);
  RenderResult result;
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    result = render(plan);
    CHECK(result.stats.invalid_samples == 0);
    CHECK(std::ranges::all_of(result.image.rgb, [](float x) { return x >= 0 && std::isfinite(x); }));
  });
  return result;
}

// One of the ways to have no area: two corners alike, all alike, or on a line (where floats can say so exactly).
// a, b: vertices.
std::array<uint32_t, 3> degenerate(std::mt19937& rng, Mesh& mesh, uint32_t a, uint32_t b) {
  switch (rng() % 3) {
    case 0:
      return {a, b, a};
    case 1:
      return {a, a, a};
  }
  mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
  return {a, b, static_cast<uint32_t>(mesh.positions.size() - 1)};
}

// Puts so many triangles without area at random places among the others.
void add_degenerate(std::mt19937& rng, Mesh& mesh, size_t triangles) {
  const uint32_t vertices = static_cast<uint32_t>(mesh.positions.size());
  for (size_t i = 0; i < triangles; ++i) {
    const uint32_t a = static_cast<uint32_t>(rng()) % vertices, b = static_cast<uint32_t>(rng()) % vertices;
    const auto bad = degenerate(rng, mesh, a, b);
    const auto at = static_cast<ptrdiff_t>(rng() % (mesh.triangles.size() + 1));
    mesh.triangles.insert(mesh.triangles.begin() + at, bad);
    const glm::dvec3 up(0, 0, 1);
    if (!mesh.normals.empty()) mesh.normals.insert(mesh.normals.begin() + at, {up, up, up});
  }
}

// Smooth normals as often written: each face's own normalised, then summed at its vertices.
void naive_normals(Mesh& mesh) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0));
  const auto face = [&](const std::array<uint32_t, 3>& t) {
    const glm::dvec3 a = mesh.positions[t[0]];
    return glm::normalize(glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a));
  };
  for (const auto& t : mesh.triangles) {
    for (const uint32_t v : t) sums[v] += face(t);
  }
  mesh.normals.clear();
  for (const auto& t : mesh.triangles) {
    mesh.normals.push_back({glm::normalize(sums[t[0]]), glm::normalize(sums[t[1]]), glm::normalize(sums[t[2]])});
  }
}

// The share of the corners of triangles with area whose normal is not a number.
double without_normal(const Mesh& mesh) {
  size_t corners = 0, bad = 0;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const glm::dvec3 a = mesh.positions[t[0]];
    if (glm::length(glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a)) < 1e-12) continue;
    for (const glm::dvec3& n : mesh.normals[i]) bad += !(std::abs(glm::length(n) - 1) < 1e-6);
    corners += 3;
  }
  return static_cast<double>(bad) / static_cast<double>(corners);
}

TEST_SUITE("stability") {
  TEST_CASE("degenerate input: triangles without area among the others change no bit of the picture") {
    test::Curve curve{.name = "degenerate-triangles",
                      .title = "Triangles without area in a mesh with smooth normals",
                      .naive = "normalises every face's normal",
                      .ours = "adds up area vectors, apply_normals",
                      .x_axis = "triangles without area, of all triangles of the mesh",
                      .y_axis = "share of the other triangles' corners left without a normal",
                      .log_x = false,
                      .points = {}};
    Scene clean = test::test_scene();
    finish_scene(clean);
    Scene smooth = clean;
    apply_normals(smooth, Normals::kSmooth);
    const ZeroedVector<float> want = sound_render(smooth, small()).image.rgb;
    Settings ball = small();  // the pixels in the middle of the mesh
    ball.crop = {15, 9, 3, 3}, ball.spp = 64;
    const double brightness = mean(sound_render(smooth, ball).image);
    for (const double share : {0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 0.9}) {
      CAPTURE(share);
      std::mt19937 rng(23);
      Scene scene = clean;
      Mesh& mesh = scene.meshes.back();
      add_degenerate(rng, mesh, static_cast<size_t>(share / (1 - share) * static_cast<double>(mesh.triangles.size())));
      Scene naive = scene;
      naive_normals(naive.meshes.back());
      // Should such normals come, `surface` takes the face's own, and the ball does not turn black.
      CHECK(mean(sound_render(naive, ball).image) == doctest::Approx(brightness).epsilon(0.2));
      // Once with what finish_scene drops still there.
      apply_normals(scene, Normals::kSmooth);
      CHECK(sound_render(scene, small()).image.rgb == want);
      finish_scene(scene);
      CHECK(sound_render(scene, small()).image.rgb == want);
      curve.points.push_back({share, without_normal(naive.meshes.back()), without_normal(scene.meshes.back())});
    }
    CHECK(curve.points.front().naive == 0);
    CHECK(curve.worst_naive() > 0.9);
    CHECK(curve.worst_ours() == 0);
    test::record(curve);
  }

  TEST_CASE("degenerate input: a scene full of it, lights among it") {
    Scene clean = test::test_scene();
    finish_scene(clean);
    Scene scene = clean;
    std::mt19937 rng(24);
    for (Mesh& mesh : scene.meshes) add_degenerate(rng, mesh, 1000);
    for (const uint32_t material :
         {test::kWhite, test::kMirrorMaterial, test::kGlassMaterial, test::kGold, test::kSmallLight}) {
      Mesh nothing = clean.meshes[0];
      nothing.material = material;
      nothing.triangles.clear();
      add_degenerate(rng, nothing, 1000);
      scene.meshes.push_back(nothing);
    }
    CHECK(scene.triangle_count() > 10000);
    finish_scene(scene);
    CHECK(scene.triangle_count() == clean.triangle_count());
    CHECK(sound_render(scene, small()).image.rgb == sound_render(clean, small()).image.rgb);
  }

  TEST_CASE("degenerate input: of coplanar duplicates the first is seen, and neither shadows the other") {
    const Scene clean = test::test_scene();
    Scene scene = clean;
    for (const Mesh& mesh : clean.meshes) {
      if (clean.materials[mesh.material].kind == Material::Kind::kEmission) continue;
      scene.meshes.push_back(mesh);
      scene.meshes.back().material = test::kBlue;
    }
    // The same but for the last bits: duplicates fill the flat list, and other meshes go to the tree.
    const double want = mean(sound_render(clean, small()).image);
    CHECK(mean(sound_render(scene, small()).image) == doctest::Approx(want).epsilon(2e-3));
  }

  TEST_CASE("degenerate input: edges of many faces") {
    std::mt19937 rng(25);
    const glm::vec3 a(0, 0, -1), b(0, 0, 1);
    std::vector<Triangle> pages;
    for (int i = 0; i < 7; ++i) {
      const float angle = 0.9f * static_cast<float>(i);
      pages.push_back({a, b, glm::vec3(std::cos(angle), std::sin(angle), 0)});
    }
    std::uniform_real_distribution<float> unit(0.01f, 0.99f);
    std::vector<Ray> rays;
    while (rays.size() < 20'000) {
      // From anywhere, and along the axes, where floats can meet the edge itself.
      const glm::vec3 target = glm::mix(a, b, unit(rng));
      glm::vec3 o = 2.0f * test::random_direction(rng);
      if (rays.size() % 2 == 0) o[static_cast<int>(rays.size() / 2 % 2)] = 0, o.z = target.z;
      rays.push_back({o, glm::normalize(target - o)});
    }
    test::for_each_target([&](const char* target) {
      CAPTURE(target);
      for (const test::Keep keep : {test::Keep::kFlat, test::Keep::kTrees}) {
        uint32_t missed = 0;
        for (const Path<float>& p : test::trace(test::trace_plan(pages, {}, keep), rays)) missed += p.prim == kNoPrim;
        CHECK(missed == 0);
      }
    });

    Scene scene = test::test_box();
    Mesh book;
    book.material = test::kRed;
    for (const Triangle& page : pages) {
      const uint32_t first = static_cast<uint32_t>(book.positions.size());
      for (const glm::vec3& v : page) book.positions.push_back(glm::dvec3(0, 0.2, 0.75) + 0.4 * glm::dvec3(v));
      book.triangles.push_back({first, first + 1, first + 2});
    }
    scene.meshes.push_back(book);
    for (const Normals normals : {Normals::kFlat, Normals::kSmooth}) {
      finish_scene(scene);
      apply_normals(scene, normals);
      CHECK(mean(sound_render(scene, small()).image) > 0);
    }
  }

  TEST_CASE("degenerate input: cameras inside spheres") {
    for (const uint32_t material :
         {test::kWhite, test::kMirrorMaterial, test::kGlassMaterial, test::kGold, test::kSmallLight}) {
      CAPTURE(material);
      Scene scene = test::test_box();
      const glm::dvec3 eye(scene.cameras[0].to_world[3]);
      for (const glm::dvec3& offset : {glm::dvec3(0), glm::dvec3(0.3, -0.2, 0.1)}) {
        scene.spheres[0] = {"around the camera", eye + offset, 0.5, material};
        Settings settings = small();
        settings.max_depth = 100;
        const double seen = mean(sound_render(scene, settings).image);
        // Only glass lets the box be seen; the back of a light is black.
        CHECK((seen > 0) == (material == test::kGlassMaterial));
      }
    }
  }

  TEST_CASE("degenerate input: every setting at its edge") {
    const Scene scenes[] = {test::test_box(), test::test_scene()};
    std::vector<Settings> edges(14);
    for (Settings& s : edges) s.width = s.height = 1, s.spp = 1, s.wave = kLanes, s.threads = 1;
    edges[1].max_depth = 0;
    edges[2].max_depth = 65535;
    edges[3].adaptive_batch = 1, edges[3].spp = 3;
    edges[4].max_depth = 65535, edges[4].direct = Direct::kLight;
    edges[5].threads = 64;
    edges[6].light_samples = 500;
    edges[7].wave = 1 << 16;
    edges[8].width = 300;
    edges[9].height = 300;
    edges[10].width = edges[10].height = 512, edges[10].crop = {511, 511, 1, 1};
    edges[11].seed = ~uint64_t{0};
    edges[12].direct = Direct::kHemisphere;
    edges[13].direct = Direct::kBsdf;
    for (size_t i = 0; i < edges.size(); ++i) {
      CAPTURE(i);
      for (const Scene& scene : scenes) {
        const RenderResult result = sound_render(scene, edges[i]);
        CHECK(result.stats.samples >= result.samples.size());
        CHECK(result.stats.samples <= kPathsTogether * result.samples.size() * edges[i].spp);
      }
    }
  }
}

}  // namespace
}  // namespace lanewise
