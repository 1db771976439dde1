#include <algorithm>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "core/file.h"
#include "core/plan.h"
#include "core/render.h"
#include "core/scene.h"
#include "core/types.h"
#include "core/isa.h"
#include "tools/chosen_scene.h"
#include "tools/commands.h"
#include "tools/flags.h"
#include "tools/memory_limit.h"
#include "tools/output_files.h"
#include "tools/profile_compare.h"
#include "tools/profile_html.h"
#include "tools/profile_json.h"
#include "tools/profile_measure.h"
#include "tools/profile_table.h"
#include "tools/profile_trace.h"
#include "tools/progress.h"
#include "tools/render_options.h"
#include "tools/version.h"

namespace lanewise {
namespace {

constexpr const char* kFooter =
    "Times of stages are medians of the runs, and in each of calm waves: those in which the thread ran all the time.\n"
    "Renders with the clock and without it take turns, which shows what profiling costs.\n"
    "--compare marks a stage as faster or slower where the medians differ by more than 3 % (10 % if it has less than\n"
    "1 % of the time; more on a busy machine) and where the runs, by the rank test, would differ so in fewer than 1 "
    "of\n"
    "100 comparisons of equals; that takes five runs on both sides.\n"
    "In place of the scene may stand a profile that --json has written: it is shown again, and nothing is rendered.\n\n"
    "Examples:\n"
    "  lanewise profile box.dae                                       tables of stages and bounces\n"
    "  lanewise profile box.dae -s 64 --html box.html                 and a page of charts\n"
    "  lanewise profile box.dae --json old.json                       before a change\n"
    "  lanewise profile box.dae --compare old.json                    after it\n"
    "  lanewise profile box.dae -t 1 --no-scaling --trace box.trace   calls in time, for ui.perfetto.dev\n"
    "  lanewise profile new.json --compare old.json                   of two saved profiles";

struct ProfileOptions {
  RenderOptions render;
  uint32_t repeat = 5;
  bool no_scaling = false;
  std::string json, html, trace, compare;  // empty: none
  uint32_t trace_waves = 50;
};

// Flags that also a saved profile takes.
const std::set<std::string> kOfReports = {"SCENE", "--json", "--html", "--compare", "--quiet"};

std::string name_of(const CLI::Option& option) {
  return option.get_lnames().empty() ? option.get_name() : "--" + option.get_lnames().front();
}

bool is_saved_profile(const std::string& scene) { return scene.ends_with(".json"); }

void add_profile_flags(CLI::App& app, ProfileOptions& o) {
  app.option_defaults()->group("Profiling");
  app.add_option("--repeat", o.repeat, "Renders that are clocked")
      ->check(whole_number(1, 50))
      ->type_name("N")
      ->capture_default_str();
  app.add_flag("--no-scaling", o.no_scaling, "No renders with fewer threads");
  app.add_option("--compare", o.compare, "Tell what changed since this profile")->type_name("OLD.json");
  app.option_defaults()->group("Output");
  app.add_option("--json", o.json, "Write the profile, with what each run took")->type_name("FILE");
  app.add_option("--html", o.html, "Write a page of charts")->type_name("FILE");
  app.add_option("--trace", o.trace, "Write the calls in time, of one further render (Chrome's format)")
      ->type_name("FILE");
  app.add_option("--trace-waves", o.trace_waves, "Only of the first N waves of each thread")
      ->check(whole_number(1, 10'000))
      ->needs("--trace")
      ->type_name("N")
      ->capture_default_str();
  app.add_flag("-q,--quiet", o.render.quiet, "No progress, no tables");
}

void check_outputs(const ProfileOptions& o) {
  OutputFiles files(o.render);
  if (!o.compare.empty()) files.keep(o.compare);
  for (const auto& [flag, path] : {std::pair{"--json", o.json}, {"--html", o.html}, {"--trace", o.trace}}) {
    if (path.empty()) continue;
    check_writable(path);
    files.add(flag, path);
  }
}

// Every flag that says what is rendered, and how, as it was given or is by default.
std::vector<std::pair<std::string, std::string>> settings_of(const CLI::App& app) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = name_of(*option), group = option->get_group();
    if (group == "Profiling" || group == "Output" || group == "Not yet supported") continue;
    if (name == "--help" || name == "SCENE" || name == "--threads" || name == "--max-memory") continue;
    std::string value = option->get_default_str();
    if (option->count() > 0) {
      value.clear();
      for (const std::string& part : option->reduced_results()) value += (value.empty() ? "" : " ") + part;
    }
    settings.emplace_back(name, value);
  }
  return settings;
}

ProfileReport measure_scene(const ProfileOptions& o, const CLI::App& app, const std::string& command_line) {
  choose_isa(o.render.isa);
  hold_memory_to(o.render.max_memory);
  ProgressLine progress(o.render.quiet);
  progress.show("loading " + o.render.scene);
  const Scene scene = load_chosen_scene(o.render);
  progress.show("planning");
  const Plan plan = make_plan(scene, o.render.settings);
  check_memory(o.render, plan);
  ProfileReport report =
      measure(plan, {o.repeat, !o.no_scaling, [&](const std::string& text) { progress.show(text); }});
  report.command = command_line;
  report.version = kVersion;
  report.scene = o.render.scene;
  report.settings = settings_of(app);
  if (!o.trace.empty()) {
    progress.show("tracing");
    write_file(o.trace, trace_json(log_calls(plan, o.trace_waves), command_line, o.render.scene));
  }
  return report;
}

ProfileReport read_saved(const ProfileOptions& o, const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = name_of(*option);
    if (option->count() > 0 && !kOfReports.contains(name)) {
      throw UsageError(name + ": nothing is rendered where a saved profile is shown");
    }
  }
  return read_profile(o.render.scene);
}

void run_profile(const ProfileOptions& o, const CLI::App& app, const std::string& command_line) {
  check_outputs(o);
  std::optional<ProfileReport> before;
  if (!o.compare.empty()) before = read_profile(o.compare);
  const ProfileReport report =
      is_saved_profile(o.render.scene) ? read_saved(o, app) : measure_scene(o, app, command_line);

  if (!o.json.empty()) write_file(o.json, profile_json(report));
  if (!o.html.empty()) write_file(o.html, profile_page(report));
  if (o.render.quiet && !before) return;
  if (!o.render.quiet) std::cout << profile_table(report) << (before ? "\n" : "");
  if (before) std::cout << compare_profiles(o.compare, *before, report);
}

}  // namespace

void add_profile_command(CLI::App& app, const std::string& command_line) {
  CLI::App* command = app.add_subcommand("profile", "Measure where a render's time goes");
  command->group("Commands");
  command->footer(kFooter);
  const auto options = std::make_shared<ProfileOptions>();
  add_scene_options(*command, options->render);
  command->get_option("SCENE")->description(std::string(kSceneFiles) + "; or a profile (.json)");
  add_profile_flags(*command, *options);
  command->callback([=] {
    complete(options->render, *command);
    run_profile(*options, *command, command_line);
  });
}

}  // namespace lanewise
