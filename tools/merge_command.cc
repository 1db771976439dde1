#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "core/file.h"
#include "core/film_file.h"
#include "core/image_io.h"
#include "core/types.h"
#include "tools/commands.h"
#include "tools/output_files.h"

namespace lanewise {
namespace {

struct MergeOptions {
  std::vector<std::string> parts;
  std::string output;
  bool quiet = false;
};

constexpr const char* kExamples =
    "Examples:\n"
    "  lanewise render box.dae --samples 0:512 -f a.exr         on one machine\n"
    "  lanewise render box.dae --samples 512:1024 -f b.exr      on another\n"
    "  lanewise merge a.exr b.exr -f box.png                    the picture of -s 1024, to the bit\n"
    "  lanewise merge a.exr b.exr -f ab.exr                     a film file again, to merge with more";

void run_merge(const MergeOptions& o) {
  check_image_extension(o.output);
  check_image_writable(o.output);
  OutputFiles files;
  for (const std::string& part : o.parts) files.keep(part);
  files.add("--output", o.output);

  FilmFile film = read_film(o.parts.front(), true);
  for (size_t i = 1; i < o.parts.size(); ++i) merge_film(film, read_film(o.parts[i], true), o.parts[i]);
  if (is_exr(o.output)) {
    write_file(o.output, encode_film(film));
  } else {
    write_image(o.output, develop(film));
  }
  if (o.quiet) return;
  uint64_t samples = 0;
  std::string ranges;
  for (const SampleRange& r : film.ranges) {
    samples += r.end - r.begin;
    ranges += (ranges.empty() ? "" : ", ") + std::to_string(r.begin) + ":" + std::to_string(r.end);
  }
  std::cout << o.parts.size() << (o.parts.size() == 1 ? " part -> " : " parts -> ") << o.output << "\n"
            << film.state.area.width << " x " << film.state.area.height << ", " << samples
            << " samples per pixel: " << ranges << "\n";
  if (film.ranges.size() > 1) std::cout << "note: samples between these are missing\n";
  if (film.state.invalid_samples > 0) {
    std::cerr << "lanewise: warning: " << film.state.invalid_samples
              << " samples were NaN, infinite or negative and count as black\n";
  }
}

}  // namespace

void add_merge_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("merge", "Merge film files of parts of a render's samples, exactly");
  command->group("Commands");
  command->footer(kExamples);
  const auto options = std::make_shared<MergeOptions>();
  command
      ->add_option("PART", options->parts,
                   "Film files (.exr): what `lanewise render --samples`, --checkpoint and this command write")
      ->required()
      ->type_name("");
  command
      ->add_option("-f,--output", options->output,
                   "The picture: .png, .exr, .pfm or .hdr; an .exr is a film file again")
      ->required()
      ->type_name("FILE");
  command->add_flag("-q,--quiet", options->quiet, "No summary");
  command->callback([=] { run_merge(*options); });
}

}  // namespace lanewise
