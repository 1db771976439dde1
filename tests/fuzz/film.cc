// Film files, as they are merged and resumed.
#include "core/film_file.h"

#include "core/plan.h"
#include "core/render.h"
#include "core/types.h"
#include "scenes/default_camera.h"
#include "tests/fuzz/harness.h"

namespace lanewise::fuzz {
namespace {

constexpr uint64_t kMostToRender = 32 * 32, kMostSamples = 64;

// A mirror below a grey sky: that the file is of this scene is for others to check.
Plan small_plan(const FilmFile& film) {
  Scene scene;
  scene.environment.width = scene.environment.height = 1;
  scene.environment.rgb = {1, 1, 1};
  scene.materials.push_back({.name = "mirror", .kind = Material::Kind::kMirror, .reflectance = glm::dvec3(1)});
  scene.spheres.push_back({});
  scene.cameras.push_back(default_camera(scene));
  finish_scene(scene);
  Settings settings;
  settings.width = film.width, settings.height = film.height, settings.crop = film.state.area;
  settings.spp = kMostSamples, settings.threads = 1, settings.wave = 64;
  if (film.state.has(SampleShares::kSaved)) settings.allocation = Allocation::kNoise;
  if (film.state.has_film("half0")) {
    settings.noise = 0.1;
    settings.crop = {};
  }
  return make_plan(std::move(scene), settings);
}

void merge(const std::string& path) {
  const FilmFile film = read_film(path, true);
  FilmFile sum = film;
  sum.ranges.clear();
  merge_film(sum, film, path);
  encode_film(sum);
  merge_film(sum, film, path);
}

void resume(const std::string& path) {
  const FilmFile film = read_film(path, false);
  if (uint64_t{film.width} * film.height > kMostToRender) return;
  Plan plan = small_plan(film);
  render(plan, {.resume = &film.state});
  if (film.state.has_film("half0")) return;
  plan.settings.crop = {};
  plan.settings.adaptive_batch = 8;
  render(plan, {.resume = &film.state});
}

const Harness harness("film", ".exr", [](const std::string& path) {
  try {
    merge(path);
  } catch (const Error&) {
    resume(path);
    throw;
  }
  resume(path);
});

}  // namespace
}  // namespace lanewise::fuzz
