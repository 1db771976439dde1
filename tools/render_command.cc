#include <algorithm>
#include <csignal>
#include <cstdio>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/explain.h"
#include "core/file.h"
#include "core/film_file.h"
#include "core/image_io.h"
#include "core/mpi_messenger.h"
#include "core/plan.h"
#include "core/remote_ranks.h"
#include "core/render.h"
#include "core/serve_rank.h"
#include "core/scene.h"
#include "core/types.h"
#include "core/isa.h"
#include "tools/checkpoint.h"
#include "tools/chosen_scene.h"
#include "tools/commands.h"
#include "tools/memory_limit.h"
#include "tools/output_files.h"
#include "tools/progress.h"
#include "tools/rate_picture.h"
#include "tools/render_options.h"
#include "tools/render_report.h"
#include "tools/rescue.h"
#include "tools/stop_signals.h"
#include "tools/version.h"

namespace lanewise {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  lanewise render box.dae                                  a quick look, to box.png\n"
    "  lanewise render box.dae -s 1024 -f box.exr               a clean picture, in floats\n"
    "  lanewise render box.dae -r 1920 1080 --noise 0.05        samples where the noise is\n"
    "  lanewise render box.dae --time 10s                       the best picture in ten seconds\n"
    "  lanewise render box.dae --metal gold --alpha 0.05        another material";

// Seconds that f takes, added to `seconds`.
template <class F>
auto timed(double& seconds, F f) {
  const auto start = std::chrono::steady_clock::now();
  auto result = f();
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

// What can be known to fail before the work begins.
void check_outputs(const RenderOptions& o) {
  check_image_extension(o.output);
  check_image_writable(o.output);
  OutputFiles files(o);
  files.add("--output", o.output);
  if (!o.rate.empty()) {
    check_image_extension(o.rate);
    check_image_writable(o.rate);
    files.add("--rate", o.rate);
  }
  if (!o.stats.empty()) {
    check_writable(o.stats);
    files.add("--stats", o.stats);
  }
  if (!o.checkpoint.empty()) {
    check_writable(o.checkpoint);
    files.add("--checkpoint", o.checkpoint);
  }
}

RenderResult render_with(const RenderOptions& o, const Plan& plan, const RenderControl& control) {
  switch (o.reference) {
    case Reference::kFloat:
      return render_reference<float>(plan, control);
    case Reference::kDouble:
      return render_reference<double>(plan, control);
    case Reference::kNone:
      break;
  }
  return render(plan, control, {.clock = !o.stats.empty()});
}

std::string isa_name(Reference reference) {
  switch (reference) {
    case Reference::kFloat:
      return "reference-float";
    case Reference::kDouble:
      return "reference-double";
    case Reference::kNone:
      break;
  }
  return chosen_isa();
}

// What to say of a render that a signal has ended.
std::string farewell(const RenderOptions& o, const RenderStats& stats, int signal) {
  char samples[64];
  std::snprintf(samples, sizeof samples, "%.1f", stats.samples_per_pixel);
  std::string text = std::string("lanewise: stopped by ") + (signal == SIGINT ? "SIGINT" : "SIGTERM") + " after " +
                     samples + " samples per pixel; " + (o.is_part() ? "no part is written" : o.output + " shows them");
  if (!o.checkpoint.empty()) text += "; the same command with --resume goes on";
  return text + "\n";
}

std::string encode_picture(const RenderOptions& o, const RenderResult& result, const std::string& command_line) {
  return encode_image(o.output, result.image,
                      {{"software", std::string("lanewise ") + kVersion},
                       {"command", command_line},
                       {"scene", o.scene},
                       {"spp", samples_per_pixel(o, result.stats)},
                       {"seed", std::to_string(o.settings.seed)}});
}

// What all ranks must agree in.
RenderIdentity of_rank(RenderIdentity identity, const std::string& command_line) {
  identity.emplace_back("version", kVersion);
  identity.emplace_back("command", command_line);
  return identity;
}

// What the other ranks of an mpirun do. Signals are for rank 0.
void draw_for_rank_0(const RenderOptions& o, Messenger& messenger, const std::string& command_line) {
  const StopSignals ignored;
  const auto load = [&] {
    choose_isa(o.isa);
    hold_memory_to(o.max_memory);
    Scene scene = load_chosen_scene(o);
    RenderIdentity identity = render_identity(scene, o.settings, arithmetic_of(isa_name(o.reference)));
    return RankJob{make_plan(std::move(scene), o.settings), of_rank(std::move(identity), command_line)};
  };
  serve_rank(messenger, load, {.clock = !o.stats.empty()});
}

void run_render(const RenderOptions& o, const std::string& command_line) {
  const std::unique_ptr<Messenger> messenger = mpi_messenger();
  if (messenger && messenger->rank() > 0) return draw_for_rank_0(o, *messenger, command_line);
  std::optional<RemoteRanks> remote;
  if (messenger) remote.emplace(*messenger);
  if (messenger && o.reference != Reference::kNone)
    throw UsageError("--reference draws in one process, without mpirun");
  check_outputs(o);
  choose_isa(o.isa);
  hold_memory_to(o.max_memory);
  std::optional<Checkpoint> checkpoint;
  if (!o.checkpoint.empty()) checkpoint.emplace(o);

  const auto start = std::chrono::steady_clock::now();
  RenderSeconds seconds;
  ProgressLine progress(o.quiet);
  progress.show("loading " + o.scene);
  Scene scene = timed(seconds.load, [&] { return load_chosen_scene(o); });
  RenderIdentity identity;
  if (o.is_part() || checkpoint || remote)
    identity = render_identity(scene, o.settings, arithmetic_of(isa_name(o.reference)));
  progress.show("planning");
  Plan plan = timed(seconds.plan, [&] { return make_plan(std::move(scene), o.settings); });
  check_memory(o, plan);
  if (remote) {
    progress.show("waiting for the other ranks");
    remote->meet(of_rank(identity, command_line));
  }
  if (o.settings.seconds > 0) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    constexpr double kLeast = 1e-9;  // time is up: one sample a pixel
    plan.settings.seconds = std::max(kLeast, o.settings.seconds - spent.count());
  }
  const StopSignals signals;
  RenderControl control{.progress = [&](const Progress& p) { progress.show(p); },
                        .stop = [] { return StopSignals::received() != 0; },
                        .remote = remote ? &*remote : nullptr};
  FilmFile film;  // of a part, or for the checkpoint
  if (checkpoint) {
    control.resume = checkpoint->resumed(identity);
    control.save_every = o.every;
  }
  if (checkpoint || o.is_part()) {
    control.save = [&](SavedRender&& state) {
      film = film_file(o, identity, std::move(state));
      progress.clear();  // for a warning to have its line
      if (checkpoint) checkpoint->write(film);
    };
  }
  const RenderResult result = timed(seconds.render, [&] { return render_with(o, plan, control); });

  Rescue files;
  timed(seconds.write, [&] {
    if (!o.is_part()) files.write(o.output, encode_picture(o, result, command_line));
    if (o.is_part() && !result.stats.stopped) files.write(o.output, encode_film(film));
    return true;
  });
  if (!o.rate.empty()) {
    const Image rate = rate_picture(o.rate, result.samples, result.image.width, result.image.height);
    files.write(o.rate, encode_image(o.rate, rate));
  }
  const std::vector<Decision> decisions = explain(plan);
  const RenderReport report{o, result.stats, seconds, isa_name(o.reference), command_line, decisions};
  if (!o.stats.empty()) files.write(o.stats, stats_json(report));
  if (checkpoint && !checkpoint->failure().empty()) {
    files.keep(o.checkpoint, encode_film(film), checkpoint->failure());
  }

  progress.clear();
  files.finish();
  if (result.stats.stopped) {
    std::cerr << farewell(o, result.stats, StopSignals::received());
    throw Stopped{StopSignals::received()};
  }
  if (result.stats.invalid_samples > 0) {
    std::cerr << "lanewise: warning: " << result.stats.invalid_samples
              << " samples were NaN, infinite or negative and count as black\n";
  }
  if (o.quiet) return;
  for (const std::string& notice : scene.notices) std::cout << "note: " << notice << "\n";
  std::cout << summary(report);
}

}  // namespace

void add_render_command(CLI::App& app, const std::string& command_line) {
  CLI::App* command = app.add_subcommand("render", "Render a scene to a picture");
  command->group("Commands");
  command->footer(kExamples);
  const auto options = std::make_shared<RenderOptions>();
  add_render_options(*command, *options);
  command->callback([=] {
    complete(*options, *command);
    run_render(*options, command_line);
  });
}

}  // namespace lanewise
