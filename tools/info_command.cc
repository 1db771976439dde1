#include <iostream>
#include <memory>
#include <string>

#include "core/scene.h"
#include "scenes/load.h"
#include "tools/commands.h"
#include "tools/info_report.h"
#include "tools/progress.h"
#include "tools/render_options.h"

namespace lanewise {
namespace {

constexpr const char* kFooter =
    "Lengths are in the scene's unit, radiance in W/(m^2 sr) and power in W where that is the metre. Notes tell what "
    "the\n"
    "loader decided, warnings what may not render as it is meant. Nothing is rendered.\n\n"
    "Examples:\n"
    "  lanewise info box.dae\n"
    "  lanewise info box.glb --json                             for programs";

}  // namespace

void add_info_command(CLI::App& app) {
  struct Options {
    std::string scene;
    bool json = false;
  };
  CLI::App* command = app.add_subcommand("info", "Tell what a scene holds");
  command->group("Commands");
  command->footer(kFooter);
  const auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scene, kSceneFiles)->required()->type_name("");
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options] {
    ProgressLine progress(false);
    progress.show("loading " + options->scene);
    const Scene scene = load_scene(options->scene);
    progress.show("looking at " + options->scene);
    const std::string report = options->json ? info_json(scene) : info_text(scene);
    progress.clear();
    std::cout << report;
  });
}

}  // namespace lanewise
