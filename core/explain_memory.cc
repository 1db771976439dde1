#include <algorithm>
#include <array>
#include <string>

#include "core/explain_topics.h"
#include "core/film.h"
#include "core/likely_values.h"
#include "core/path_reuse.h"
#include "core/plan_light_paths.h"
#include "core/splats.h"
#include "core/stats.h"
#include "core/wave.h"
#include "core/zeroed_pages.h"

namespace lanewise {
namespace {

template <class Vector>
size_t bytes_of(const Vector& v) {
  return v.size() * sizeof(v[0]);
}

class Memory {
 public:
  explicit Memory(std::vector<Decision>& out) : out_(out) {}

  // per: the name of the share of each of n things, or null.
  void add(const std::string& subject, const std::string& choice, const std::string& reason, size_t bytes,
           const char* per = nullptr, size_t n = 1) {
    Decision d{"memory", subject, choice, reason, {{"bytes", static_cast<double>(bytes), FigureUnit::kBytes}}};
    if (per) d.figures.push_back({per, static_cast<double>(bytes) / static_cast<double>(n), FigureUnit::kBytes});
    out_.push_back(std::move(d));
    sum_ += bytes;
  }
  size_t sum() const { return sum_; }

 private:
  std::vector<Decision>& out_;
  size_t sum_ = 0;
};

// Returns its bytes.
size_t add_scene(const Plan& plan, std::vector<Decision>& out) {
  Memory memory(out);
  const size_t primitives = std::max<size_t>(size_t{plan.triangles} + plan.spheres, 1);
  const auto add = [&](const char* subject, const char* choice, const char* reason, size_t bytes) {
    memory.add(subject, choice, reason, bytes, "per_primitive", primitives);
  };
  const size_t flat = bytes_of(plan.flat_quads) + bytes_of(plan.flat_slabs) + bytes_of(plan.flat_triangles) +
                      bytes_of(plan.flat_spheres);
  const size_t nodes = bytes_of(plan.triangle_tree.nodes) + bytes_of(plan.sphere_tree.nodes);
  const bool smooth = !plan.prim_normals.empty();
  if (flat > 0) memory.add("flat lists", "in order", "read by every vector of rays", flat);
  if (nodes > 0) {
    add("trees", "nodes, leaf blocks", "vertices lie in the leaf blocks",
        nodes + bytes_of(plan.triangle_blocks) + bytes_of(plan.sphere_blocks));
  }
  add("primitives", "by index", "fetched for the nearest hit alone",
      bytes_of(plan.prim_shape) + bytes_of(plan.prim_err) + bytes_of(plan.prim_material) + bytes_of(plan.prim_bin) +
          bytes_of(plan.prim_light));
  add("corner normals", smooth ? "by index" : "none stored",
      smooth ? "some faces are smooth: 9 floats a triangle" : "every face is flat", bytes_of(plan.prim_normals));
  memory.add(
      "lights, materials", "by index", "",
      bytes_of(plan.materials) + bytes_of(plan.lights) + bytes_of(plan.light_patches) + bytes_of(plan.light_table));
  if (!plan.textures.empty()) {
    memory.add("textures", "8-bit texels", "4 bytes a texel, 8 floats a primitive to find them by",
               bytes_of(plan.textures) + bytes_of(plan.texels) + bytes_of(plan.prim_texture));
  }
  if (!plan.environment.empty()) {
    memory.add("environment", "by cell", "corners with the density, sums of chances", plan.environment.bytes());
  }
  add("scene", "all of the above", "", memory.sum());
  return memory.sum() / 2;
}

}  // namespace

MemoryNeed memory_need(const Plan& plan, bool saved) {
  std::vector<Decision> ignored;
  const Settings& settings = plan.settings;
  const Window window = settings.window();
  const size_t pixels = size_t{settings.width} * settings.height, shown = size_t{window.width} * window.height;
  // Those of --noise are in two halves, with an estimate of each.
  const size_t films = settings.noise > 0 || has_light_paths(plan) ? 2 : 1;
  const size_t estimate = settings.noise > 0 ? sizeof(std::array<double, 3>) : 0;
  const size_t drawn = films * (sizeof(PixelSums) + sizeof(uint64_t) + estimate);
  const size_t film =
      films * (paged_bytes(sizeof(PixelSums) * pixels) + paged_bytes(sizeof(uint64_t) * pixels) + estimate * pixels) +
      paged_bytes(3 * sizeof(float) * shown) + paged_bytes(sizeof(uint64_t) * shown);
  const size_t splats = has_light_paths(plan) ? paged_bytes(kSplatRoom * sizeof(Splat)) : 0;
  constexpr size_t kEncoded = 6 * sizeof(float);  // of a pixel, in any format, with what it is made from
  // Means; with --noise also their squared errors, both in arrays that grow.
  const size_t pictures = has_light_paths(plan) ? 3 : 1;  // without, with and of the light paths alone
  const size_t mean = settings.noise > 0 ? 3 * (sizeof(PixelMean) + 3 * sizeof(float)) : pictures * sizeof(PixelMean);
  const size_t means = settings.estimate_error ? mean + LikelyValues::bytes_per_pixel() : 0;
  return {.scene = add_scene(plan, ignored),
          .film = film,
          .paths = thread_count(settings) * (paged_bytes(Wave::bytes(plan, settings.wave)) + splats),
          .files = std::max(means, kEncoded + (saved ? 4 * drawn : 0)) * shown};
}

void explain_memory(const Plan& plan, std::vector<Decision>& out) {
  const MemoryNeed need = memory_need(plan, false);
  add_scene(plan, out);
  const Settings& settings = plan.settings;
  const size_t pixels = size_t{settings.width} * settings.height;
  const bool noise = settings.noise > 0;
  const size_t threads = thread_count(settings);
  Memory memory(out);
  const bool light = has_light_paths(plan);
  memory.add("film",
             noise   ? "two halves"
             : light ? "two sums, picture"
                     : "sums, picture",
             noise   ? "each ends the other's estimate"
             : light ? "exact sums, also of light paths"
                     : "exact sums",
             need.film, "per_pixel", pixels);
  memory.add("paths", count_of(threads, "thread"),
             "three buffers of " + std::to_string(settings.wave) +
                 " paths: two that the sort moves between, one for those that met a light" +
                 (reuses_paths(plan) ? "; and what is kept of two vertices" : "") +
                 (light ? "; and what the camera sees of light paths" : ""),
             need.paths, "per_thread", threads);
  memory.add("files", "while they are written", "a checkpoint's takes four times the film beside it", need.files);
  memory.add("all", "scene, film, paths, files", "without stacks, the program, and the loader's peak", need.all());
}

}  // namespace lanewise
