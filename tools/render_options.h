// The flags of `lanewise render`, and those of them that other commands on scenes share.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "core/scene.h"
#include "core/settings.h"
#include "tools/metals.h"

namespace lanewise {

enum class Reference { kNone, kFloat, kDouble };  // the scalar path tracer in place of the kernels

enum class Model { kExact, kCourse, kCourseMasking, kCourseClamp };  // all of the course program's departures, or one

// What a command that reads a scene says of it.
inline constexpr char kSceneFiles[] =
    "COLLADA, OBJ, PLY or glTF file (.dae .obj .ply .gltf .glb), or a scene made by code: builtin:dense";

struct RenderOptions {
  std::string scene;
  std::string output;       // the picture's file; complete() fills it in
  std::string camera;       // the name of one of the scene's; empty: the first
  std::string camera_file;  // empty: the scene's camera
  std::string environment;  // the map around the scene; empty: none
  std::string stats;        // the statistics' file; empty: none
  std::string checkpoint;   // what it can be resumed from; empty: none
  double every = 60;        // seconds between two checkpoints
  bool resume = false;
  std::string rate;   // the file of the picture of sample counts; empty: none
  Settings settings;  // settings.seconds: as given, from the program's start
  Normals normals = Normals::kFile;
  std::string isa;          // empty: the best here
  uint64_t max_memory = 0;  // bytes; 0: no limit
  Reference reference = Reference::kNone;
  const Metal* metal = nullptr;  // overrides: null or empty leaves the scene's materials alone
  std::optional<double> alpha;
  std::optional<double> ior;
  bool quiet = false;

  // --samples: the picture is then a film file.
  bool is_part() const { return !samples.empty(); }

  // As the parser needs them; complete() moves them into the settings.
  std::pair<uint32_t, uint32_t> resolution{settings.width, settings.height};
  std::array<uint32_t, 4> crop{};
  std::pair<uint32_t, double> adaptive{settings.adaptive_batch, settings.adaptive_tolerance};
  bool hemisphere = false;
  std::string samples;  // A:B
  Model model = Model::kExact;
};

// Adds the scene and the flags that say what is rendered and how, with checks of each value by itself. Values go to `options`,
// which must live until the parse.
void add_scene_options(CLI::App& app, RenderOptions& options);

// The same, --time, --reference, and the files that a render writes.
void add_render_options(CLI::App& app, RenderOptions& options);

// After the parse: what depends on several flags. Throws UsageError.
void complete(RenderOptions& options, const CLI::App& app);

}  // namespace lanewise
