#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "core/explain.h"
#include "core/file.h"
#include "core/plan.h"
#include "tools/chosen_scene.h"
#include "tools/commands.h"
#include "tools/memory_limit.h"
#include "tools/output_files.h"
#include "tools/plan_report.h"
#include "tools/progress.h"
#include "tools/render_options.h"
#include "tools/text.h"
#include "tools/version.h"

namespace lanewise {
namespace {

constexpr const char* kFooter =
    "Nothing is rendered: the plan is what a render with the same flags would begin with.\n\n"
    "Examples:\n"
    "  lanewise plan box.dae                            which stages run, where rays look for what, memory\n"
    "  lanewise plan box.dae -m 3 --direct bsdf         what other flags change\n"
    "  lanewise plan box.dae --accel tree               everything in trees, for measuring against other tracers\n"
    "  lanewise plan box.dae -q --json /dev/stdout      for programs";

struct PlanOptions {
  RenderOptions render;
  std::string json;  // the file; empty: none
};

// The scene, and what of the settings the plan hangs on, in one line.
std::string title(const PlanOptions& o) {
  const Settings& s = o.render.settings;
  return print("%s: %u x %u pixels, %s samples each, depth %u\n\n", o.render.scene.c_str(), s.width, s.height,
               std::to_string(s.spp).c_str(), s.max_depth);
}

std::string plan_json(const PlanOptions& o, const std::string& command_line, const std::vector<Decision>& decisions) {
  const nlohmann::ordered_json json = {
      {"scene", o.render.scene}, {"command", command_line}, {"version", kVersion}, {"plan", decisions_json(decisions)}};
  // Names may hold any bytes; what is not UTF-8 is replaced.
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

void run_plan(const PlanOptions& o, const std::string& command_line) {
  if (!o.json.empty()) {
    check_writable(o.json);
    OutputFiles(o.render).add("--json", o.json);
  }
  hold_memory_to(o.render.max_memory);
  ProgressLine progress(o.render.quiet);
  progress.show("loading " + o.render.scene);
  Scene scene = load_chosen_scene(o.render);
  progress.show("planning");
  const Plan plan = make_plan(std::move(scene), o.render.settings);
  const std::vector<Decision> decisions = explain(plan);
  progress.clear();
  if (!o.json.empty()) write_file(o.json, plan_json(o, command_line, decisions));
  if (!o.render.quiet) std::cout << title(o) << decisions_table(decisions);
  check_memory(o.render, plan);
}

}  // namespace

void add_plan_command(CLI::App& app, const std::string& command_line) {
  CLI::App* command = app.add_subcommand("plan", "Tell what the renderer specialises for a scene, and why");
  command->group("Commands");
  command->footer(kFooter);
  const auto options = std::make_shared<PlanOptions>();
  add_scene_options(*command, options->render);
  command->option_defaults()->group("Output");
  command->add_option("--json", options->json, "Write the decisions, with their figures")->type_name("FILE");
  command->add_flag("-q,--quiet", options->render.quiet, "No progress, no table");
  command->callback([=] {
    complete(options->render, *command);
    run_plan(*options, command_line);
  });
}

}  // namespace lanewise
