#include "tools/render_options.h"

#include <filesystem>
#include <limits>

#include "core/dimensions.h"
#include "core/noise_film.h"
#include "core/types.h"
#include "core/film_file.h"
#include "core/image_io.h"
#include "tools/flags.h"

namespace lanewise {
namespace {

constexpr uint64_t kMaxCount = std::numeric_limits<uint32_t>::max();
constexpr uint32_t kMaxSide = 65536;
constexpr uint32_t kNoiseSpp = 65536;  // -s where --noise is given without it

void add_picture_flags(CLI::App& app, RenderOptions& o) {
  app.add_option("-r,--resolution", o.resolution, "Width and height of the picture")
      ->check(whole_number(1, kMaxSide))
      ->type_name("W H")
      ->default_str(std::to_string(o.resolution.first) + " " + std::to_string(o.resolution.second));
  add_choice<View>(app, "--view", o.settings.view, {{"file", View::kFile}, {"fit", View::kFit}},
                   "The file's camera, or one that frames the whole scene");
  add_choice<Normals>(app, "--normals", o.normals,
                      {{"file", Normals::kFile}, {"smooth", Normals::kSmooth}, {"flat", Normals::kFlat}},
                      "Shading normals: the file's, interpolated, or the faces' own");
  app.add_option("-p,--crop", o.crop, "Only these pixels of it: upper left corner and size")
      ->check(whole_number(0, kMaxSide))
      ->type_name("X Y DX DY");
  CLI::Option* camera = app.add_option("--camera", o.camera, "The scene's camera of this name")
                            ->type_name("NAME")
                            ->default_str("the first");
  app.add_option("-c,--camera-file", o.camera_file,
                 "Camera (JSON: eye, target, up, xfov, aspect) in place of the scene's")
      ->type_name("FILE")
      ->excludes(camera);
  app.add_option(
         "-e,--environment", o.environment,
         "Map of radiance around the scene, .exr or .hdr: longitude atan2(y, x) from pi at its left edge to -pi, up "
         "(z) at its top")
      ->type_name("FILE");
  CLI::Option* radius = app.add_option("-b,--lens-radius", o.settings.lens_radius, "Radius of a thin lens")
                            ->check(real_number(0, 1e6))
                            ->type_name("R")
                            ->default_str("a pinhole");
  CLI::Option* distance = app.add_option("-d,--focal-distance", o.settings.focal_distance,
                                         "Distance along the view axis that it shows sharp")
                              ->check(real_number(1e-6, 1e9))
                              ->type_name("D");
  CLI::Option* autofocus =
      app.add_flag("--autofocus", o.settings.autofocus, "The lens shows sharp what is at the centre of the picture");
  distance->needs(radius);
  autofocus->needs(radius)->excludes(distance);
}

void add_sampling_flags(CLI::App& app, RenderOptions& o) {
  app.add_option("-s,--spp", o.settings.spp, "Camera samples per pixel")
      ->check(whole_number(1, kMaxSpp))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("-l,--light-samples", o.settings.light_samples, "Samples per light at every vertex")
      ->check(whole_number(1, kSetsPerBounce - kSetLight))
      ->type_name("N")
      ->capture_default_str();
  app.add_option(
         "-a,--adaptive", o.adaptive,
         "Stop a pixel whose mean is known to within the share TOL (95%); look after every BATCH samples. Biased low")
      ->check(whole_number(1, kMaxCount).application_index(0))
      ->check(real_number(0, 10).application_index(1))
      ->type_name("BATCH TOL");
  app.add_option("--noise", o.settings.noise,
                 "Stop a pixel where its standard error is the share X of its luminance; unbiased. -s is then the most "
                 "samples, by default " +
                     std::to_string(kNoiseSpp))
      ->check(real_number(0, 10))
      ->type_name("X");
  add_choice<Sampler>(app, "--sampler", o.settings.sampler, {{"sobol", Sampler::kSobol}, {"random", Sampler::kRandom}},
                      "Numbers of a pixel's paths: an Owen-scrambled Sobol sequence, or independent ones");
  app.add_option("--seed", o.settings.seed, "Seed of the random numbers")
      ->check(whole_number(0, std::numeric_limits<uint64_t>::max()))
      ->type_name("N")
      ->capture_default_str();
}

void add_transport_flags(CLI::App& app, RenderOptions& o) {
  app.add_option("-m,--max-depth", o.settings.max_depth, "Most scattering events on a path; 0: the lights alone")
      ->check(whole_number(0, kSetsPerBounce - 1))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--only-bounce", o.settings.only_bounce, "Only light that has been scattered exactly K times")
      ->check(whole_number(0, kSetsPerBounce - 1))
      ->type_name("K");
  add_choice<Direct>(
      app, "--direct", o.settings.direct,
      {{"mis", Direct::kMis}, {"light", Direct::kLight}, {"bsdf", Direct::kBsdf}, {"hemisphere", Direct::kHemisphere}},
      "How direct light is sampled");
  app.add_flag("-H,--hemisphere", o.hemisphere, "Short for --direct hemisphere");
  add_choice<bool>(app, "--reuse", o.settings.reuse, {{"on", true}, {"off", false}},
                   "Paths of neighbouring pixels used again, for light between diffuse surfaces");
  add_choice<bool>(app, "--light-paths", o.settings.light_paths, {{"on", true}, {"off", false}},
                   "Caustics and their glow by paths from the lamps");
  add_choice<bool>(app, "--connect", o.settings.connect, {{"on", true}, {"off", false}},
                   "Samples of lights by way of mirror and glass spheres, where the plan has few");
  add_choice<BsdfSampling>(
      app, "--bsdf-sampling", o.settings.bsdf_sampling,
      {{"vndf", BsdfSampling::kVndf}, {"ndf", BsdfSampling::kNdf}, {"cosine", BsdfSampling::kCosine}},
      "How microfacet metals choose a direction; rough glass does so by vndf alone");
  add_choice<Fresnel>(app, "--fresnel", o.settings.fresnel,
                      {{"exact", Fresnel::kExact}, {"schlick", Fresnel::kSchlick}, {"course", Fresnel::kCourse}},
                      "Formulas for reflectance");
  add_choice<Model>(
      app, "--model", o.model,
      {{"exact", Model::kExact},
       {"course", Model::kCourse},
       {"course-masking", Model::kCourseMasking},
       {"course-clamp", Model::kCourseClamp}},
      "Microfacets and estimators: exact, or as the course program has them (--direct light, --bsdf-sampling ndf, "
      "--fresnel course, --connect off, --reuse off, and its masking and clamp, of which there is also each alone)");
}

void add_material_flags(CLI::App& app, RenderOptions& o) {
  std::vector<std::string> symbols;
  for (const Metal& metal : metals()) symbols.push_back(metal.names.front());
  app.add_option_function<std::string>(
         "--metal", [&o](const std::string& name) { o.metal = find_metal(name); },
         "Metal of all microfacet materials: " + join_names(symbols) + ", or its name in full")
      ->check(CLI::Validator(
          [symbols](std::string& name) {
            return find_metal(name) ? "" : "'" + name + "' is none of " + join_names(symbols);
          },
          ""))
      ->type_name("NAME");
  app.add_option("--alpha", o.alpha, "Roughness of all microfacet materials")
      ->check(real_number(0, 10))
      ->type_name("X");
  app.add_option("--ior", o.ior, "Index of refraction of all glass")->check(real_number(0.01, 100))->type_name("X");
}

void add_machine_flags(CLI::App& app, RenderOptions& o) {
  app.add_option("-t,--threads", o.settings.threads, "Threads; 0: all that the machine has")
      ->check(whole_number(0, 1024))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--wave", o.settings.wave, "Paths in flight per thread, a multiple of 16")
      ->check(whole_number(kLanes, 1 << 20, kLanes))
      ->type_name("N")
      ->capture_default_str();
  app.add_option_function<std::string>(
         "--max-memory", [&o](const std::string& size) { o.max_memory = parse_bytes(size).value_or(0); },
         "The most memory that it takes (500M, 2G); what needs more is refused, before the work where that can be "
         "known")
      ->check(bytes())
      ->type_name("SIZE");
  const std::vector<std::string> isas = {"scalar", "sse4", "avx2", "avx512"};
  app.add_option("--isa", o.isa, "Instruction set of the kernels")
      ->check(one_of(isas))
      ->type_name(join_names(isas))
      ->default_str("the best here");
}

void add_allocation_flag(CLI::App& app, RenderOptions& o) {
  add_choice<Allocation>(app, "--allocation", o.settings.allocation,
                         {{"even", Allocation::kEven}, {"noise", Allocation::kNoise}},
                         "Which pixels get how many samples: all -s, or more where the first of each finds noise and "
                         "fewer where it is calm, -s on average; noise with --time in place of -s")
      ->default_str("even");
}

void add_time_flag(CLI::App& app, RenderOptions& o) {
  app.add_option_function<std::string>(
         "--time", [&o](const std::string& time) { o.settings.seconds = parse_duration(time).value_or(0); },
         "The best picture that is done in this time, loading included; -s and --noise may end it sooner")
      ->check(duration())
      ->type_name("T");
}

void add_reference_flag(CLI::App& app, RenderOptions& o) {
  app.add_option_function<std::string>(
         "--reference",
         [&o](const std::string& type) { o.reference = type == "float" ? Reference::kFloat : Reference::kDouble; },
         "Render with the scalar path tracer that the kernels are tested against")
      ->check(one_of({"float", "double"}))
      ->type_name("float|double");
}

void add_output_flags(CLI::App& app, RenderOptions& o) {
  app.add_option("-f,--output", o.output, "The picture: .png, .exr, .pfm or .hdr")
      ->type_name("FILE")
      ->default_str("the scene's name.png, here");
  app.add_option(
         "--rate", o.rate,
         "Picture of the samples that each pixel took: colours in a .png, their number in an .exr, .pfm or .hdr")
      ->type_name("FILE");
  app.add_option("--stats", o.stats, "Write statistics as JSON")->type_name("FILE");
  app.add_option("--samples", o.samples,
                 "Only samples A to B - 1 of every pixel, or its share of them, from 0 on, in place of -s; the "
                 "picture, an .exr, is then a film file, with exact sums for lanewise merge")
      ->check(sample_range())
      ->type_name("A:B");
  CLI::Option* checkpoint =
      app.add_option("--checkpoint", o.checkpoint,
                     "Keep what has been drawn, to go on from after a crash, in a film file (.exr)")
          ->type_name("FILE");
  app.add_option_function<std::string>(
         "--every", [&o](const std::string& time) { o.every = parse_duration(time).value_or(o.every); },
         "Time between two checkpoints, and so the most that can be lost")
      ->check(duration())
      ->type_name("T")
      ->default_str("60s")
      ->needs(checkpoint);
  app.add_flag("--resume", o.resume, "Go on from the checkpoint, if there is one; it comes to the same bits")
      ->needs(checkpoint);
  o.settings.estimate_error = true;
  app.add_flag_function(
      "--no-estimate", [&o](int64_t) { o.settings.estimate_error = false; },
      "No estimate of the error; saves the second samples of one pixel in 32 that it takes");
  app.add_flag("-q,--quiet", o.quiet, "No progress, no summary");
}

// What flags of their own say stays as they say.
void choose_model(RenderOptions& o, const CLI::App& app) {
  Settings& settings = o.settings;
  const bool all = o.model == Model::kCourse;
  settings.course = {.masking = all || o.model == Model::kCourseMasking,
                     .clamp = all || o.model == Model::kCourseClamp};
  if (!all) return;
  if (app.count("--direct") == 0 && !o.hemisphere) settings.direct = Direct::kLight;
  if (app.count("--bsdf-sampling") == 0) settings.bsdf_sampling = BsdfSampling::kNdf;
  if (app.count("--fresnel") == 0) settings.fresnel = Fresnel::kCourse;
  if (app.count("--connect") == 0) settings.connect = false;
  if (app.count("--reuse") == 0) settings.reuse = false;
}

std::string default_output(const std::string& scene, const char* extension) {
  const size_t colon = scene.starts_with("builtin:") ? scene.find(':') + 1 : 0;
  return std::filesystem::path(scene.substr(colon)).stem().string() + extension;
}

}  // namespace

void add_scene_options(CLI::App& app, RenderOptions& o) {
  app.option_defaults()->take_last();  // so that a flag can be appended to a command line to change it
  app.add_option("SCENE", o.scene, kSceneFiles)->required()->type_name("");
  const auto group = [&app](const char* name) { app.option_defaults()->group(name); };
  group("Picture");
  add_picture_flags(app, o);
  group("Sampling");
  add_sampling_flags(app, o);
  group("Transport");
  add_transport_flags(app, o);
  group("Materials");
  add_material_flags(app, o);
  group("Machine");
  add_machine_flags(app, o);
  group("Advanced");
  add_choice<Accel>(app, "--accel", o.settings.accel, {{"plan", Accel::kPlan}, {"tree", Accel::kTree}},
                    "Where rays look for geometry: as the plan chooses; all in trees, to measure them");
}

void add_render_options(CLI::App& app, RenderOptions& o) {
  add_scene_options(app, o);
  app.option_defaults()->group("Sampling");
  add_allocation_flag(app, o);
  add_time_flag(app, o);
  app.option_defaults()->group("Machine");
  add_reference_flag(app, o);
  app.option_defaults()->group("Output");
  add_output_flags(app, o);
}

void complete(RenderOptions& o, const CLI::App& app) {
  choose_model(o, app);
  if (o.hemisphere && app.count("--direct") > 0 && o.settings.direct != Direct::kHemisphere) {
    throw UsageError("--hemisphere (-H) contradicts --direct");
  }
  if (o.hemisphere) o.settings.direct = Direct::kHemisphere;
  if (app.count("--lens-radius") > 0 && app.count("--focal-distance") == 0 && !o.settings.autofocus) {
    throw UsageError("--lens-radius (-b): needs --focal-distance (-d) or --autofocus");
  }
  if (uint64_t{o.resolution.first} * o.resolution.second > kMostPixels) {
    throw UsageError("--resolution: more than 2^28 pixels");
  }
  if (const auto only = o.settings.only_bounce) {
    if (app.count("--max-depth") > 0 && *only > o.settings.max_depth) {
      throw UsageError("--only-bounce: more than --max-depth (-m) allows");
    }
    o.settings.max_depth = *only;
  }
  std::tie(o.settings.width, o.settings.height) = o.resolution;
  if (app.count("--crop") > 0) {
    const auto [x, y, width, height] = o.crop;
    if (width == 0 || height == 0 || x + width > o.settings.width || y + height > o.settings.height) {
      throw UsageError("--crop: must be a part of the picture's " + std::to_string(o.settings.width) + " x " +
                       std::to_string(o.settings.height) + " pixels");
    }
    o.settings.crop = {x, y, width, height};
  }
  std::tie(o.settings.adaptive_batch, o.settings.adaptive_tolerance) = o.adaptive;
  if (o.settings.noise > 0) {
    if (o.settings.adaptive_batch > 0) throw UsageError("--noise contradicts --adaptive (-a)");
    if (app.count("--spp") == 0) o.settings.spp = o.settings.seconds > 0 ? kMaxSpp : kNoiseSpp;
    if (o.settings.spp < 2 * NoiseFilm::kFirstSamples) {
      throw UsageError("--noise: needs --spp (-s) of at least " + std::to_string(2 * NoiseFilm::kFirstSamples));
    }
  }
  if (o.is_part()) {
    for (const char* flag : {"--spp", "--adaptive", "--noise", "--time"}) {
      if (app.count(flag) > 0) throw UsageError(std::string("--samples contradicts ") + flag);
    }
    const SampleRange range = *parse_sample_range(o.samples);
    o.settings.first_sample = range.begin;
    o.settings.spp = range.end - range.begin;
    o.settings.estimate_error = false;
  }
  if (o.settings.seconds > 0) {
    if (o.settings.adaptive_batch > 0) throw UsageError("--time contradicts --adaptive (-a)");
    if (o.settings.noise == 0 && app.count("--spp") == 0) {
      o.settings.spp = kMaxSpp;
      if (app.count("--allocation") == 0) o.settings.allocation = Allocation::kNoise;
    }
  }
  if (o.settings.allocation == Allocation::kNoise && (o.settings.noise > 0 || o.settings.adaptive_batch > 0)) {
    throw UsageError("--allocation noise contradicts --adaptive (-a) and --noise, which stop pixels one by one");
  }
  if (o.output.empty()) o.output = default_output(o.scene, o.is_part() ? ".exr" : ".png");
  if (o.is_part() && !is_exr(o.output)) throw UsageError("--samples: " + o.output + ": needs an .exr to write");
}

}  // namespace lanewise
