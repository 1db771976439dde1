// What each depth must show in a box with a mirror and a glass sphere, row by row, on regions of the picture. A region is
// the pixels all of which sees what it asks for, by rays of our own (tests/sight.h). "Layer k" is
// the picture at -m k less that at -m k - 1, of the same paths: the light that has been scattered k times.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>

#include "core/render.h"
#include "scenes/load.h"
#include "tests/kernel_harness.h"
#include "tests/scene_paths.h"
#include "tests/sight.h"

namespace lanewise {
namespace {

using glm::dvec3;
using test::Hit;
using test::Ray;
using Kind = Material::Kind;
using Pixels = std::vector<size_t>;

#ifdef NDEBUG
constexpr uint32_t kSamples = 96;
constexpr bool kTellMeans = true;
#else
constexpr uint32_t kSamples = 2;  // exact zeros alone; means need more
constexpr bool kTellMeans = false;
#endif
constexpr int kProbes = 4;
constexpr double kProbe = 0.4;  // pixels between them
constexpr uint32_t kWidth = 160, kHeight = 120;

// A scene of one mirror and one glass sphere in a box, its pictures and its regions.
class Room {
 public:
  explicit Room(Scene given) : scene(std::move(given)) {
    for (const Sphere& sphere : scene.spheres) (kind(sphere) == Kind::kMirror ? mirror : glass) = &sphere;
  }
  Room(const Room&) = delete;

  Kind kind(const Sphere& sphere) const { return scene.materials[sphere.material].kind; }

  const RenderResult& at(uint32_t depth) {
    auto [found, is_new] = results_.try_emplace(depth);
    if (is_new) {
      Settings settings;
      settings.width = kWidth, settings.height = kHeight, settings.threads = 1;
      settings.max_depth = depth;
      settings.spp = depth < 5 ? kSamples : std::max(2u, kSamples / 8);
      found->second = render(make_plan(scene, settings));
    }
    return found->second;
  }

  // Mean over the channels of a pixel.
  double value(uint32_t depth, size_t pixel) {
    const float* rgb = &at(depth).image.rgb[3 * pixel];
    return (double(rgb[0]) + double(rgb[1]) + double(rgb[2])) / 3;
  }
  double layer(uint32_t k, size_t pixel) { return value(k, pixel) - value(k - 1, pixel); }

  using Value = std::function<double(size_t)>;
  static double mean(const Pixels& pixels, const Value& of) {
    double sum = 0;
    for (const size_t pixel : pixels) sum += of(pixel);
    return sum / double(pixels.size());
  }
  static double largest(const Pixels& pixels, const Value& of) {
    double most = 0;
    for (const size_t pixel : pixels) most = std::max(most, std::abs(of(pixel)));
    return most;
  }

  Ray ray(double x, double y) const {
    const Camera& camera = scene.cameras[0];
    const double pixel = 2 * std::tan(camera.xfov / 2) / kWidth;
    const glm::dmat3 axes(camera.to_world);
    return {dvec3(camera.to_world[3]),
            glm::normalize(axes * dvec3((x - kWidth / 2.0) * pixel, (kHeight / 2.0 - y) * pixel, -1))};
  }

  // The pixel in which the camera sees the point, if it does.
  std::optional<size_t> pixel_of(const dvec3& p) const {
    const Camera& camera = scene.cameras[0];
    const dvec3 eye(camera.to_world[3]), local = glm::transpose(glm::dmat3(camera.to_world)) * (p - eye);
    const double pixel = 2 * std::tan(camera.xfov / 2) / kWidth;
    const double x = kWidth / 2.0 - local.x / local.z / pixel, y = kHeight / 2.0 + local.y / local.z / pixel;
    if (local.z >= 0 || x < 0 || y < 0 || x >= kWidth || y >= kHeight) return {};
    const auto hit = test::nearest(scene, {eye, glm::normalize(p - eye)});
    if (!hit || glm::length(hit->p - p) > 1e-6) return {};
    return size_t(y) * kWidth + size_t(x);
  }

  // Pixels that it holds in: at 4 x 4 points that cover a little more than the pixel.
  Pixels where(const std::function<bool(const Ray&)>& holds) const {
    Pixels pixels;
    for (uint32_t y = 0; y < kHeight; ++y) {
      for (uint32_t x = 0; x < kWidth; ++x) {
        bool all = true;
        for (int i = 0; i < kProbes * kProbes && all; ++i) {
          all = holds(ray(x + kProbe * (i % kProbes) - 0.1, y + kProbe * (i / kProbes) - 0.1));
        }
        if (all) pixels.push_back(size_t{y} * kWidth + x);
      }
    }
    return pixels;
  }

  std::optional<Hit> see(const Ray& ray) const { return test::nearest(scene, ray); }
  bool is(const std::optional<Hit>& hit, const Sphere* sphere) const { return hit && hit->shape == sphere; }
  // A ray on its way by a reflection at the sphere, or through it; none if it does not meet it.
  std::optional<Ray> by(const std::optional<Ray>& ray, const Sphere* sphere, bool through = false) const {
    if (!ray) return {};
    const auto hit = see(*ray);
    if (!is(hit, sphere)) return {};
    return through ? refracted_through(*ray, *hit) : reflected(*ray, *hit);
  }

  // Floor: faces up, at the foot of the room. Hidden from every corner of every light by this sphere, hence, for the sphere
  // is convex, from all of them.
  bool in_umbra(const Ray& ray, const Sphere& sphere) const {
    const auto hit = see(ray);
    if (!hit || hit->material->kind != Kind::kDiffuse || hit->n.z < 0.99) return false;
    for (const dvec3& corner : light_corners()) {
      if (!test::meets(sphere, hit->p, corner)) return false;
    }
    return true;
  }

  std::vector<dvec3> light_corners() const {
    std::vector<dvec3> corners;
    for (const Mesh& mesh : scene.meshes) {
      if (scene.materials[mesh.material].kind != Kind::kEmission) continue;
      for (const auto& triangle : mesh.triangles) {
        for (const uint32_t corner : triangle) corners.push_back(mesh.positions[corner]);
      }
    }
    return corners;
  }

  // The share of the directions from the point to the glass sphere that, refracted through it, satisfy `reaches`.
  double through_glass(const dvec3& p, const std::function<bool(const Ray&)>& reaches) const {
    constexpr int kSide = 16;
    const dvec3 axis = glm::normalize(glass->center - p);
    const dvec3 side = glm::normalize(glm::cross(axis, dvec3(0.6, 0.64, 0.48))), up = glm::cross(side, axis);
    const double distance = glm::length(glass->center - p);
    const double spread = glass->radius / std::sqrt(distance * distance - glass->radius * glass->radius);
    int found = 0;
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        const double x = (2 * i + 1.0) / kSide - 1, y = (2 * j + 1.0) / kSide - 1;
        const Ray start{p, glm::normalize(axis + spread * (x * side + y * up))};
        const auto out = by(start, glass, true);
        found += out && reaches(*out);
      }
    }
    return double(found) / (kSide * kSide);
  }

  Scene scene;
  const Sphere* mirror = nullptr;
  const Sphere* glass = nullptr;

 private:
  std::map<uint32_t, RenderResult> results_;
};

Room::Value layer_of(Room& room, uint32_t k) {
  return [&room, k](size_t pixel) { return room.layer(k, pixel); };
}

// Along `route` a pixel shows a diffuse point that the camera also sees directly, where it is in the picture at -m 1: layer
// k of the one is that times `share`. Upside down or mirrored, all of it must be where the route says.
void check_shows(Room& room, uint32_t k, const std::function<std::optional<Ray>(const Ray&)>& route,
                 const std::function<double(const Ray&)>& share) {
  CAPTURE(k);
  std::map<size_t, std::pair<size_t, double>> seen;  // by pixel: the pixel that it shows, and how much of it
  const Pixels pixels = room.where([&](const Ray& ray) {
    const auto end = route(ray);
    const auto hit = end ? room.see(*end) : std::nullopt;
    return hit && hit->material->kind == Kind::kDiffuse && room.pixel_of(hit->p);
  });
  double expected = 0, found = 0, apart = 0;
  for (const size_t pixel : pixels) {
    const Ray ray = room.ray(double(pixel % kWidth) + 0.5, double(pixel / kWidth) + 0.5);
    const double shown = share(ray) * room.value(1, *room.pixel_of(room.see(*route(ray))->p));
    expected += shown, found += room.layer(k, pixel), apart += std::abs(shown - room.layer(k, pixel));
  }
  REQUIRE(pixels.size() >= 10);
  CAPTURE(pixels.size());
  if (!kTellMeans) return;
  CHECK(found / expected > 0.97);
  CHECK(found / expected < 1.06);  // light that comes otherwise in as many scatterings
  CHECK(apart / expected < 0.1);
}

void check_depth_0(Room& room) {
  const Pixels light = room.where([&](const Ray& ray) { return is_light(room.see(ray)); });
  const Pixels rest = room.where([&](const Ray& ray) { return !is_light(room.see(ray)); });
  REQUIRE(light.size() >= 20);
  CHECK(Room::largest(rest, [&](size_t pixel) { return room.value(0, pixel); }) == 0);
  for (const size_t pixel : light) CHECK(room.value(0, pixel) > 5);
}

Pixels ceiling(Room& room) {
  const double top = bounds(room.scene).hi.z;
  return room.where([&](const Ray& ray) {
    const auto hit = room.see(ray);
    return hit && hit->material->kind == Kind::kDiffuse && hit->p.z > top - 1e-4;
  });
}

void check_depth_1(Room& room) {
  const auto value = [&](size_t pixel) { return room.value(1, pixel); };
  REQUIRE(ceiling(room).size() >= 20);
  CHECK(Room::largest(ceiling(room), value) == 0);
  for (const Sphere* sphere : {room.mirror, room.glass}) {
    const Pixels umbra = room.where([&](const Ray& ray) { return room.in_umbra(ray, *sphere); });
    REQUIRE(umbra.size() >= 8);
    CHECK(Room::largest(umbra, value) == 0);
  }
  const Pixels lit = room.where([&](const Ray& ray) {
    const auto hit = room.see(ray);
    if (!hit || hit->material->kind != Kind::kDiffuse || hit->n.z < 0.99) return false;
    for (const dvec3& corner : room.light_corners()) {
      if (test::meets(*room.mirror, hit->p, corner) || test::meets(*room.glass, hit->p, corner)) return false;
    }
    return true;
  });
  REQUIRE(lit.size() >= 100);
  for (const size_t pixel : lit) CHECK(value(pixel) > 0);

  std::array<double, 2> images{};
  for (const bool in_glass : {false, true}) {
    CAPTURE(in_glass);
    const Sphere* sphere = in_glass ? room.glass : room.mirror;
    const Pixels image = room.where([&](const Ray& ray) {
      const auto next = room.by(ray, sphere);
      return next && is_light(room.see(*next));
    });
    REQUIRE(image.size() >= 2);
    images[in_glass] = Room::mean(image, value);
    const double expected = Room::mean(image, [&](size_t pixel) {
      const Ray ray = room.ray(double(pixel % kWidth) + 0.5, double(pixel / kWidth) + 0.5);
      const Hit hit = *room.see(ray);
      const dvec3 radiance = room.see(reflected(ray, hit))->material->radiance;
      const dvec3 share = in_glass ? dvec3(reflectance(ray, hit)) : hit.material->reflectance;
      return (share.x * radiance.x + share.y * radiance.y + share.z * radiance.z) / 3;
    });
    if (kTellMeans) CHECK(images[in_glass] == doctest::Approx(expected).epsilon(0.2));
  }
  if (kTellMeans) CHECK(images[1] < 0.3 * images[0]);
}

void check_depth_2(Room& room) {
  if (kTellMeans) {
    for (const size_t pixel : ceiling(room)) CHECK(room.value(2, pixel) > 0);
  }
  check_shows(
      room, 2, [&](const Ray& ray) { return room.by(ray, room.mirror); },
      [&](const Ray& ray) { return room.see(ray)->material->reflectance.x; });
  // The glass in the mirror, but for where it reflects the light.
  const Pixels glass_in_mirror = room.where([&](const Ray& ray) {
    const auto next = room.by(room.by(ray, room.mirror), room.glass);
    return next && !is_light(room.see(*next));
  });
  REQUIRE(glass_in_mirror.size() >= 4);
  CHECK(Room::largest(glass_in_mirror, [&](size_t pixel) { return room.value(2, pixel); }) == 0);
  if (kTellMeans) CHECK(Room::mean(glass_in_mirror, layer_of(room, 3)) > 0);
}

// In a room that is black but for its floor, so that no other light is in the shadow.
void check_focused_light(const Scene& scene) {
  Scene dark = scene;
  for (Material& material : dark.materials) {
    if (material.kind == Kind::kMirror) material.reflectance = dvec3(0);
  }
  Material black;
  black.name = "black";
  dark.materials.push_back(black);
  for (Mesh& mesh : dark.meshes) {
    const auto& [i, j, k] = mesh.triangles[0];
    const dvec3 n = glm::cross(mesh.positions[j] - mesh.positions[i], mesh.positions[k] - mesh.positions[i]);
    const bool is_floor = std::abs(n.z) > 0.99 * glm::length(n) && mesh.positions[0].z < 0.01;
    const bool is_diffuse = dark.materials[mesh.material].kind == Kind::kDiffuse;
    if (is_diffuse && !is_floor) mesh.material = uint32_t(dark.materials.size() - 1);
  }
  Room room(std::move(dark));
  const Pixels umbra = room.where([&](const Ray& ray) { return room.in_umbra(ray, *room.glass); });
  REQUIRE(umbra.size() >= 8);
  CHECK(Room::largest(umbra, [&](size_t pixel) { return room.value(2, pixel); }) == 0);
  if (kTellMeans) CHECK(Room::mean(umbra, [&](size_t pixel) { return room.value(3, pixel); }) > 0.1);
}

void check_depth_3(Room& room) {
  check_shows(
      room, 3, [&](const Ray& ray) { return room.by(ray, room.glass, true); },
      [&](const Ray& ray) { return std::pow(1 - reflectance(ray, *room.see(ray)), 2); });
  const Pixels caustic = room.where([&](const Ray& ray) {
    if (!room.in_umbra(ray, *room.glass)) return false;
    return room.through_glass(room.see(ray)->p, [&](const Ray& out) { return is_light(room.see(out)); }) > 0.02;
  });
  REQUIRE(caustic.size() >= 4);
  if (kTellMeans) CHECK(Room::mean(caustic, layer_of(room, 3)) > 5 * Room::mean(caustic, layer_of(room, 2)));
}

void check_depth_4(Room& room) {
  check_shows(
      room, 4, [&](const Ray& ray) { return room.by(room.by(ray, room.mirror), room.glass, true); },
      [&](const Ray& ray) {
        const Hit hit = *room.see(ray);
        const Ray next = reflected(ray, hit);
        return hit.material->reflectance.x * std::pow(1 - reflectance(next, *room.see(next)), 2);
      });
  // The wall on the glass's side, where the light's way by the mirror and through the glass ends.
  const double side = room.glass->center.x > room.mirror->center.x ? 1 : -1;
  std::array<Pixels, 2> wall;
  for (const size_t pixel : room.where([&](const Ray& ray) {
         const auto hit = room.see(ray);
         return hit && hit->material->kind == Kind::kDiffuse && hit->n.x * side < -0.99;
       })) {
    const Hit hit = *room.see(room.ray(double(pixel % kWidth) + 0.5, double(pixel / kWidth) + 0.5));
    const double share = room.through_glass(hit.p, [&](const Ray& out) {
      const auto next = room.by(out, room.mirror);
      return next && is_light(room.see(*next));
    });
    if (share == 0 || share > 0.01) wall[share > 0].push_back(pixel);
  }
  REQUIRE(wall[1].size() >= 20);
  if (kTellMeans) CHECK(Room::mean(wall[1], layer_of(room, 4)) > 2 * Room::mean(wall[0], layer_of(room, 4)));
}

// Of the same paths: what is deeper has all that was there, and rays are counted, for seconds hang on the machine.
void check_depth_5_and_more(Room& room) {
  constexpr std::array<uint32_t, 4> kDepths = {5, 7, 100, 1000};
  constexpr std::array<double, 4> kMore = {0, 0.04, 0.02, 1e-4};  // light and rays, at most, than at the depth before
  for (size_t i = 1; i < kDepths.size(); ++i) {
    CAPTURE(kDepths[i]);
    const RenderResult &less = room.at(kDepths[i - 1]), &more = room.at(kDepths[i]);
    double before = 0, after = 0;
    bool loses = false;
    for (size_t k = 0; k < less.image.rgb.size(); ++k) {
      before += double(less.image.rgb[k]), after += double(more.image.rgb[k]);
      loses = loses || more.image.rgb[k] < 0.9999f * less.image.rgb[k];
    }
    CHECK(!loses);
    CHECK(more.stats.bounce_rays >= less.stats.bounce_rays);
    if (!kTellMeans) continue;
    CHECK(after < (1 + kMore[i]) * before);
    CHECK(double(more.stats.bounce_rays) < (1 + kMore[i]) * double(less.stats.bounce_rays));
  }
}

void check_table(Scene scene) {
  Room room(std::move(scene));
  REQUIRE(room.mirror);
  REQUIRE(room.glass);
  check_depth_0(room);
  check_depth_1(room);
  check_depth_2(room);
  check_focused_light(room.scene);
  check_depth_3(room);
  check_depth_4(room);
  check_depth_5_and_more(room);
}

TEST_CASE("depth table: each depth shows what it must, in the shipped box") {
  check_table(load_scene(test::shipped_scene("cornell_spheres.dae").string()));
}

TEST_CASE("depth table: each depth shows what it must, in the course's box") {
  const std::filesystem::path path = test::course_scenes() / "CBspheres.dae";
  if (!std::filesystem::exists(path)) {
    MESSAGE("skipped: no " << path);
    return;
  }
  Scene scene = load_scene(path.string());
  scene.cameras[0] = test::fit_camera(scene);
  check_table(std::move(scene));
}

}  // namespace
}  // namespace lanewise
