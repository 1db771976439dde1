#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "core/file.h"
#include "core/plan.h"
#include "core/types.h"
#include "scenes/export.h"
#include "tools/chosen_scene.h"
#include "tools/commands.h"
#include "tools/memory_limit.h"
#include "tools/output_files.h"
#include "tools/progress.h"
#include "tools/render_options.h"

namespace lanewise {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFooter =
    "Meshes go to a folder beside the file, OUT_meshes, as PLY. The picture, materials and normals are those that a "
    "render\n"
    "with the same flags shows, and -m and -s are written too; what says how this program renders is not.\n"
    "Mitsuba shows the same picture but for noise; what pbrt has otherwise is told as a note.\n\n"
    "Examples:\n"
    "  lanewise convert box.dae -f box.xml --view fit            for mitsuba box.xml\n"
    "  lanewise convert box.gltf -f box.pbrt -r 1920 1080 -s 64  for pbrt box.pbrt";

struct ConvertOptions {
  RenderOptions render;
  std::string output;
};

enum class Target { kMitsuba, kPbrt };

Target target_of(const std::string& output) {
  const std::string extension = fs::path(output).extension().string();
  if (extension == ".xml") return Target::kMitsuba;
  if (extension == ".pbrt") return Target::kPbrt;
  throw UsageError("--output: " + output + " ends in neither .xml (Mitsuba 3) nor .pbrt (pbrt-v4)");
}

// The scene's file comes last: where it stands, all that it names does. A folder that is made for nothing is taken away again.
void write_scene(const std::string& output, const fs::path& folder, const ExportedScene& exported) {
  std::error_code error;
  const bool made = !exported.files.empty() && fs::create_directory(folder, error);
  if (error) throw Error(folder.string() + ": cannot write: " + error.message());
  try {
    for (const ExportedFile& file : exported.files) write_file((folder.parent_path() / file.path).string(), file.bytes);
    write_file(output, exported.text);
  } catch (...) {
    if (made) fs::remove_all(folder, error);
    throw;
  }
}

void run_convert(const ConvertOptions& o) {
  const Target target = target_of(o.output);
  if (o.render.settings.crop.width > 0) throw UsageError("--crop: a part of the picture cannot be converted");
  check_writable(o.output);
  OutputFiles(o.render).add("--output", o.output);
  const fs::path folder = fs::path(o.output).parent_path() / (fs::path(o.output).stem().string() + "_meshes");
  hold_memory_to(o.render.max_memory);
  ProgressLine progress(o.render.quiet);
  progress.show("loading " + o.render.scene);
  const Scene scene = load_chosen_scene(o.render);
  Settings settings = o.render.settings;
  if (settings.autofocus) settings.focal_distance = make_plan(scene, settings).settings.focal_distance;
  progress.show("writing " + o.output);
  const auto convert = target == Target::kMitsuba ? export_mitsuba : export_pbrt;
  const ExportedScene exported = convert(scene, settings, folder.filename().string());
  write_scene(o.output, folder, exported);
  progress.clear();
  if (o.render.quiet) return;
  for (const std::string& notice : scene.notices) std::cout << "note: " << notice << "\n";
  for (const std::string& loss : exported.losses) std::cout << "note: " << loss << "\n";
  std::cout << o.output << ": " << scene.triangle_count() << " triangles in " << scene.meshes.size() << " meshes, "
            << scene.spheres.size() << " spheres\n";
}

}  // namespace

void add_convert_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("convert", "Write a scene for Mitsuba 3 or pbrt-v4");
  command->group("Commands");
  command->footer(kFooter);
  const auto options = std::make_shared<ConvertOptions>();
  add_scene_options(*command, options->render);
  command->option_defaults()->group("Output");
  command->add_option("-f,--output", options->output, "The file: .xml for Mitsuba 3, .pbrt for pbrt-v4")
      ->required()
      ->type_name("FILE");
  command->add_flag("-q,--quiet", options->render.quiet, "No progress, no summary");
  command->callback([=] {
    complete(options->render, *command);
    run_convert(*options);
  });
}

}  // namespace lanewise
