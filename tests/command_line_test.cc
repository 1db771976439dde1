// The program from outside: what it prints, writes and returns. LANEWISE_BINARY names it, LANEWISE_SOURCE_DIR the
// checkout.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/image_io.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

using test::ProcessResult;
using test::TemporaryFolder;
using Arguments = std::vector<std::string>;

std::string environment(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value ? value : otherwise;
}

const std::string& binary() {
  static const std::string path = std::filesystem::absolute(environment("LANEWISE_BINARY", "./lanewise")).string();
  return path;
}

std::string scene(const std::string& name) {
  return (std::filesystem::absolute(environment("LANEWISE_SOURCE_DIR", ".")) / "scenes" / name).string();
}

const std::string& box() {
  static const std::string path = scene("cornell_spheres.dae");
  return path;
}

// True, with a message, where there is no program to test.
bool nothing_to_test() {
  if (std::filesystem::exists(binary())) return false;
  MESSAGE("skipped: no program at " << binary());
  return true;
}

ProcessResult lanewise(const TemporaryFolder& folder, const Arguments& arguments) {
  return test::run_process(binary(), arguments, folder.path());
}

Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// A picture of a moment.
const Arguments kSmall = {"-r", "24", "18", "-s", "4", "-m", "4", "-q"};

ProcessResult render_small(const TemporaryFolder& folder, const Arguments& more) {
  return lanewise(folder, Arguments{"render"} + kSmall + more);
}

// The values of the picture that these flags make.
ZeroedVector<float> picture_of(const TemporaryFolder& folder, const Arguments& more) {
  const std::string path = folder.file("picture.pfm");
  std::filesystem::remove(path);
  const ProcessResult result = render_small(folder, more + Arguments{"-f", path});
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  return read_image(path).rgb;
}

bool is_one_line(const std::string& text) {
  return !text.empty() && std::count(text.begin(), text.end(), '\n') == 1 && text.back() == '\n';
}

// The arguments must fail with one line on standard error that has `mentions` in it, and leave old.png as it is.
void check_failure(const TemporaryFolder& folder, int exit_code, const Arguments& arguments,
                   const std::string& mentions) {
  const std::string call = std::accumulate(arguments.begin(), arguments.end(), std::string(),
                                           [](const std::string& a, const std::string& b) { return a + " " + b; });
  CAPTURE(call);
  test::write_text(folder.file("old.png"), "old");
  const ProcessResult result = lanewise(folder, arguments);
  CAPTURE(result.err);
  CHECK(result.exit_code == exit_code);
  CHECK(is_one_line(result.err));
  CHECK(result.err.starts_with("lanewise: "));
  CHECK(result.err.find(mentions) != std::string::npos);
  CHECK(result.out.empty());
  const bool old_picture_stands = test::read_text(folder.file("old.png")) == "old";
  CHECK(old_picture_stands);
}

TEST_CASE("command line: help and version") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  for (const Arguments& arguments : {Arguments{}, Arguments{"--help"}, Arguments{"-h"}}) {
    const ProcessResult result = lanewise(folder, arguments);
    CHECK(result.exit_code == 0);
    CHECK(result.out.find("render") != std::string::npos);
    CHECK(result.out.find("compare") != std::string::npos);
    CHECK(result.err.empty());
  }
  const ProcessResult help = lanewise(folder, {"render", "--help"});
  CHECK(help.exit_code == 0);
  for (const char* text : {"--spp N", "[16]", "Transport:", "--direct mis|light|bsdf", "BATCH TOL", "Examples:"}) {
    CAPTURE(text);
    CHECK(help.out.find(text) != std::string::npos);
  }
  CHECK(lanewise(folder, {"--version"}).out.starts_with("lanewise "));
}

TEST_CASE("command line: wrong flags end with 2, one line and the old picture") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{"-s", "0"}, "--spp"},
      {{"-s", "-5"}, "--spp"},
      {{"-s", "576460752303423489"}, "--spp"},
      {{"-s", "ten"}, "--spp"},
      {{"--samples", "8"}, "--samples"},
      {{"--samples", "8:8", "-f", "a.exr"}, "--samples"},
      {{"--samples", "0:8"}, "--samples: old.png: needs an .exr"},
      {{"--samples", "0:8", "-s", "8", "-f", "a.exr"}, "--samples contradicts --spp"},
      {{"--samples", "0:8", "--noise", "0.1", "-f", "a.exr"}, "--samples contradicts --noise"},
      {{"--resume"}, "--checkpoint"},
      {{"--every", "1s"}, "--checkpoint"},
      {{"--checkpoint", "c.exr", "--every", "0"}, "--every"},
      {{"--checkpoint", "old.png"}, "--checkpoint: would overwrite"},
      {{"-s", "1.5"}, "--spp"},
      {{"-s"}, "--spp"},
      {{"-l", "0"}, "--light-samples"},
      {{"-l", "100000"}, "--light-samples"},
      {{"-m", "-1"}, "--max-depth"},
      {{"-m", "65536"}, "--max-depth"},
      {{"-t", "1025"}, "--threads"},
      {{"-t", "-1"}, "--threads"},
      {{"-r", "0", "10"}, "--resolution"},
      {{"-r", "10", "-10"}, "--resolution"},
      {{"-r", "65537", "1"}, "--resolution"},
      {{"-r", "65536", "65536"}, "--resolution"},
      {{"-r", "100"}, "--resolution"},
      {{"-a", "0", "0.1"}, "--adaptive"},
      {{"-a", "64", "nan"}, "--adaptive"},
      {{"-a", "64", "-0.1"}, "--adaptive"},
      {{"-a", "64"}, "--adaptive"},
      {{"--allocation", "some"}, "--allocation"},
      {{"--allocation", "noise", "-a", "64", "0.1"}, "--allocation noise contradicts --adaptive"},
      {{"--allocation", "noise", "--noise", "0.1"}, "--allocation noise contradicts --adaptive (-a) and --noise"},
      {{"--noise", "0"}, "--noise"},
      {{"--noise", "nan"}, "--noise"},
      {{"--noise", "0.1", "-a", "64", "0.1"}, "--noise contradicts --adaptive"},
      {{"--noise", "0.1", "-s", "31"}, "--noise: needs --spp (-s) of at least 32"},
      {{"--time", ""}, "--time"},
      {{"--time", "0s"}, "--time"},
      {{"--time", "-1"}, "--time"},
      {{"--time", "nan"}, "--time"},
      {{"--time", "1m1m"}, "--time"},
      {{"--time", "1s1m"}, "--time"},
      {{"--time", "10s5"}, "--time"},
      {{"--time", "ten"}, "--time: 'ten' is not a time"},
      {{"--time", "10s", "-a", "64", "0.1"}, "--time contradicts --adaptive"},
      {{"--rate", "rate.txt"}, "rate.txt"},
      {{"--rate", "old.png"}, "--rate: would overwrite old.png"},
      {{"--rate", "rate.png", "--stats", "rate.png"}, "--stats: would overwrite rate.png"},
      {{"--rate", "rate.png", "--stats", "./rate.png"}, "--stats: would overwrite rate.png"},
      {{"-c", "old.png", "-f", "./old.png"}, "--output: would overwrite old.png"},
      {{"--seed", "-1"}, "--seed"},
      {{"--seed", "18446744073709551616"}, "--seed"},
      {{"--wave", "0"}, "--wave"},
      {{"--wave", "100"}, "--wave"},
      {{"--wave", "2097152"}, "--wave"},
      {{"--alpha", "nan"}, "--alpha"},
      {{"--alpha", "0"}, "--alpha"},
      {{"--alpha", "inf"}, "--alpha"},
      {{"--alpha", "0.1"}, "--alpha"},   // no microfacets in this scene
      {{"--metal", "gold"}, "--metal"},  // nor here
      {{"--metal", "tin"}, "--metal"},
      {{"--ior", "0"}, "--ior"},
      {{"--ior", "x"}, "--ior"},
      {{"--isa", "mmx"}, "--isa"},
      {{"--reference", "half"}, "--reference"},
      {{"--view", "nice"}, "--view"},
      {{"--normals", "none"}, "--normals"},
      {{"--direct", "all"}, "--direct"},
      {{"--bsdf-sampling", "best"}, "--bsdf-sampling"},
      {{"--fresnel", "fast"}, "--fresnel"},
      {{"-H", "--direct", "mis"}, "--hemisphere"},
      {{"-e", "sky.png"}, "sky.png: an environment map holds radiance"},
      {{"-b", "0.1"}, "--focal-distance (-d) or --autofocus"},
      {{"--autofocus"}, "--lens-radius"},
      {{"--autofocus", "-b", "0.1", "-d", "3"}, "--autofocus"},
      {{"--only-bounce", "-1"}, "--only-bounce"},
      {{"--only-bounce", "6", "-m", "5"}, "--only-bounce: more than"},
      {{"--model", "nice"}, "--model"},
      {{"-d", "3"}, "--lens-radius"},
      {{"-b", "-0.1", "-d", "3"}, "--lens-radius"},
      {{"-b", "0.1", "-d", "0"}, "--focal-distance"},
      {{"-p", "0", "0", "5"}, "--crop"},
      {{"-p", "0", "0", "0", "5"}, "--crop: must be a part"},
      {{"-r", "16", "12", "-p", "8", "0", "9", "5"}, "--crop: must be a part of the picture's 16 x 12"},
      {{"-p", "-1", "0", "5", "5"}, "--crop"},
      {{"--stats", box()}, "--stats"},
      {{"--stats", "old.png"}, "--stats"},
      {{"--frobnicate"}, "--frobnicate"},
      {{"second.dae"}, "second.dae"},
  };
  for (const auto& [flags, mentions] : cases) {
    check_failure(folder, 2, Arguments{"render", box(), "-f", "old.png"} + flags, mentions);
  }
  check_failure(folder, 2, {"render"}, "SCENE");
  check_failure(folder, 2, {"paint", box()}, "paint");
  check_failure(folder, 2, {"compare", "old.png"}, "B");
  for (const char* name : {"picture", "picture.jpg", "picture.png.txt"}) {
    check_failure(folder, 2, {"render", box(), "-f", name}, name);
  }
}

TEST_CASE("command line: files that cannot be used end with 1, one line and the old picture") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("folder.dae"));
  std::filesystem::create_directory(folder.file("folder.png"));
  test::write_text(folder.file("empty.dae"), "");
  test::write_text(folder.file("page.dae"), "<!DOCTYPE html>\n<html><body>Not found</body></html>\n");
  const std::string whole = test::read_text(box());
  test::write_text(folder.file("half.dae"), whole.substr(0, whole.size() / 2));
  for (const char* name : {"missing.dae", "folder.dae", "empty.dae", "page.dae", "half.dae"}) {
    check_failure(folder, 1, {"render", name, "-f", "old.png"}, name);
  }
  for (const char* name : {"none/a.png", "folder.png", "empty.dae/a.png"}) {
    check_failure(folder, 1, {"render", box(), "-f", name}, name);
    check_failure(folder, 1, {"render", box(), "-f", "old.png", "--stats", name}, name);
  }
  test::write_text(folder.file("damaged.png"), "not a picture");
  for (const char* name : {"missing.png", "folder.png", "damaged.png"}) {
    check_failure(folder, 1, {"compare", name, name}, name);
  }
}

TEST_CASE("command line: flags stand before or after the scene, short or long") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const Arguments flags = {"-t", "2", "-s", "8", "-l", "2", "-m", "3", "-r", "16", "12", "-a", "4", "0.05", "-q"};
  const Arguments long_flags = {"--threads=2",  "--spp", "8",  "--light-samples", "2", "--max-depth", "3",
                                "--resolution", "16",    "12", "--adaptive",      "4", "0.05",        "--quiet"};
  const Arguments output = {"-f", "picture.pfm"};
  std::vector<ZeroedVector<float>> pictures;
  for (const Arguments& arguments :
       {Arguments{"render"} + flags + output + Arguments{box()}, Arguments{"render", box()} + flags + output,
        Arguments{"render"} + output + flags + Arguments{box()}, Arguments{"render", box()} + output + flags,
        Arguments{"render"} + long_flags + Arguments{box()} + output}) {
    const ProcessResult result = lanewise(folder, arguments);
    CAPTURE(result.err);
    CHECK(result.exit_code == 0);
    pictures.push_back(read_image(folder.file("picture.pfm")).rgb);
    std::filesystem::remove(folder.file("picture.pfm"));
  }
  CHECK(pictures[0].size() == 16 * 12 * 3);
  for (const auto& picture : pictures) CHECK(picture == pictures[0]);
}

TEST_CASE("command line: -H is --direct hemisphere, and the last of two equal flags holds") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const ZeroedVector<float> hemisphere = picture_of(folder, {box(), "-H"});
  CHECK(hemisphere == picture_of(folder, {box(), "--direct", "hemisphere"}));
  CHECK(hemisphere == picture_of(folder, {box(), "--direct", "light", "--direct", "hemisphere", "-H"}));
  CHECK(hemisphere != picture_of(folder, {box()}));
  CHECK(picture_of(folder, {box(), "--seed", "5", "--seed", "6"}) == picture_of(folder, {box(), "--seed", "6"}));
}

TEST_CASE("command line: --rate shows the samples of each pixel") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  for (const Arguments& rule : {Arguments{"--noise", "0.3", "-s", "4096"}, Arguments{"-s", "64", "-a", "16", "0.5"}}) {
    for (const char* name : {"rate.pfm", "rate.PNG"}) {
      const ProcessResult result =
          render_small(folder, Arguments{box(), "--rate", name, "--stats", "stats.json"} + rule);
      CAPTURE(result.err);
      REQUIRE(result.exit_code == 0);
    }
    const Image counts = read_image(folder.file("rate.pfm")), colours = read_image(folder.file("rate.PNG"));
    const auto stats = nlohmann::json::parse(test::read_text(folder.file("stats.json")));
    double samples = 0;
    for (const float n : counts.rgb) samples += n / 3;
    CHECK(samples == doctest::Approx(stats["samples"].get<double>()));
    CHECK(stats["converged"].get<double>() > 0);
    const auto fewest = std::min_element(counts.rgb.begin(), counts.rgb.end());
    const auto most = std::max_element(counts.rgb.begin(), counts.rgb.end());
    REQUIRE(*fewest < *most);
    const float* dark = &colours.rgb[static_cast<size_t>(fewest - counts.rgb.begin())];
    const float* bright = &colours.rgb[static_cast<size_t>(most - counts.rgb.begin())];
    CHECK(dark[1] < 0.01f);
    CHECK(bright[1] > 0.7f);
  }
}

TEST_CASE("command line: every format, by extension, and a default beside the caller") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  for (const char* name : {"a.png", "a.exr", "a.pfm", "a.hdr"}) {
    CAPTURE(name);
    const ProcessResult result = render_small(folder, {box(), "-f", name});
    CHECK(result.exit_code == 0);
    CHECK(result.out.empty());
    CHECK(result.err.empty());
    const Image image = read_image(folder.file(name));
    CHECK(image.width == 24);
    CHECK(image.height == 18);
  }
  CHECK(render_small(folder, {box()}).exit_code == 0);
  CHECK(read_image(folder.file("cornell_spheres.png")).rgb == read_image(folder.file("a.png")).rgb);
  CHECK(read_image(folder.file("a.exr")).rgb == read_image(folder.file("a.pfm")).rgb);
  CHECK(folder.names().size() == 5);

  const std::string exr = test::read_text(folder.file("a.exr"));
  for (const char* text :
       {"command", "lanewise render -r 24 18 -s 4", "spp", "seed", "cornell_spheres.dae", "software"}) {
    CAPTURE(text);
    CHECK(exr.find(text) != std::string::npos);
  }
}

TEST_CASE("command line: a summary of a few lines, unless quiet") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const ProcessResult result = lanewise(folder, {"render", box(), "-r", "24", "18", "-s", "4", "-f", "a.png"});
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());  // progress is for terminals
  for (const char* text : {"cornell_spheres.dae -> a.png", "24 x 18", "4 samples per pixel", "render", "rays/s"}) {
    CAPTURE(text);
    CHECK(result.out.find(text) != std::string::npos);
  }
}

TEST_CASE("command line: the pixels depend on neither threads nor wave, but on the seed") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const ZeroedVector<float> one = picture_of(folder, {box(), "-t", "1"});
  CHECK(one == picture_of(folder, {box(), "-t", "2"}));
  CHECK(one == picture_of(folder, {box(), "-t", "3", "--wave", "16"}));
  CHECK(one == picture_of(folder, {box(), "--wave", "256"}));
  CHECK(one == picture_of(folder, {box(), "--wave", "4096"}));
  CHECK(one != picture_of(folder, {box(), "--seed", "1"}));
}

TEST_CASE("command line: stats.json adds up") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const Arguments flags = {box(),     "-t",        "2", "--no-estimate", "--seed", "12345678901234567890",
                           "--stats", "stats.json"};
  const ProcessResult result = render_small(folder, flags);
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  const std::string text = test::read_text(folder.file("stats.json"));
  CHECK(text.find("null") == std::string::npos);  // how JSON writes NaN
  const nlohmann::json stats = nlohmann::json::parse(text);
  CHECK(stats["scene"] == box());
  CHECK(stats["width"] == 24);
  CHECK(stats["height"] == 18);
  CHECK(stats["spp"] == 4);
  CHECK(stats["max_depth"] == 4);
  CHECK(stats["seed"] == 12345678901234567890u);
  CHECK(stats["threads"].get<int>() >= 1);
  CHECK(stats["isa"].is_string());
  CHECK(stats["wave"] == 4096);
  CHECK(stats["command"].get<std::string>().starts_with("lanewise render "));
  CHECK(stats["version"].is_string());
  for (const char* phase : {"load", "plan", "render", "write"}) CHECK(stats["seconds"][phase].get<double>() >= 0);
  CHECK(stats["samples"] == 24 * 18 * 4);
  const auto& rays = stats["rays"];
  CHECK(rays["camera"] == stats["samples"]);
  CHECK(stats["plan"].size() > 2);
  CHECK(rays["total"].get<uint64_t>() == rays["camera"].get<uint64_t>() + rays["light"].get<uint64_t>() +
                                             rays["bounce"].get<uint64_t>() + rays["shadow"].get<uint64_t>());
  CHECK(rays["bounce"].get<uint64_t>() > 0);
  CHECK(rays["shadow"].get<uint64_t>() > 0);
  CHECK(stats["rays_per_second"].get<double>() > 0);
  CHECK(stats["peak_rss_bytes"].get<uint64_t>() > 1000000);
  CHECK(stats["invalid_samples"] == 0);
  const auto lengths = stats["paths_by_length"].get<std::vector<uint64_t>>();
  CHECK(lengths.size() <= 4 + 1);
  CHECK(std::accumulate(lengths.begin(), lengths.end(), uint64_t{0}) == stats["samples"]);
  REQUIRE(!stats["stages"].empty());
  for (const auto& stage : stats["stages"]) {
    CAPTURE(stage.dump());
    CHECK(stage["name"].is_string());
    CHECK(stage["calls"].get<uint64_t>() > 0);
    CHECK(stage["paths"].is_number_unsigned());
    CHECK(stage["seconds"].get<double>() >= 0);
    CHECK(stage["lanes_live"].get<double>() >= 0);
    CHECK(stage["lanes_live"].get<double>() <= 1);
  }
}

TEST_CASE(
    "command line: the estimated error is in the summary and in stats.json, and the picture the same without it") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const Arguments flags = {"render", box(), "-r", "48", "36", "-s", "16", "-f", "a.pfm", "--stats", "a.json"};
  const ProcessResult with = lanewise(folder, flags);
  REQUIRE(with.exit_code == 0);
  CHECK(with.out.find("estimated error: MRSE 0.") != std::string::npos);
  const nlohmann::json error = nlohmann::json::parse(test::read_text(folder.file("a.json")))["estimated_mrse"];
  CHECK(error["value"].get<double>() > 0.01);
  CHECK(error["low"].get<double>() < error["value"].get<double>());
  CHECK(error["high"].get<double>() > error["value"].get<double>());
  const ZeroedVector<float> picture = read_image(folder.file("a.pfm")).rgb;
  const ProcessResult without = lanewise(folder, flags + Arguments{"--no-estimate"});
  CHECK(without.out.find("estimated") == std::string::npos);
  CHECK(!nlohmann::json::parse(test::read_text(folder.file("a.json"))).contains("estimated_mrse"));
  CHECK(picture == read_image(folder.file("a.pfm")).rgb);
}

TEST_CASE("command line: --time ends by itself, and with -s where that comes first") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const ZeroedVector<float> four = picture_of(folder, {box()});  // -s 4
  for (const auto& [time, seconds] : std::vector<std::pair<std::string, double>>{{"1000", 1000},
                                                                                 {"1234.5s", 1234.5},
                                                                                 {"500000ms", 500},
                                                                                 {"1h30m", 5400},
                                                                                 {"90.5m", 5430},
                                                                                 {"9h1m1s1ms", 32461.001}}) {
    CAPTURE(time);
    CHECK(picture_of(folder, {box(), "--time", time, "--stats", "stats.json"}) == four);
    const nlohmann::json stats = nlohmann::json::parse(test::read_text(folder.file("stats.json")));
    CHECK(stats["time_budget"].get<double>() == doctest::Approx(seconds).epsilon(1e-12));
  }
  picture_of(folder, {box(), "--time", "1ms", "-s", "1000000", "--stats", "stats.json"});
  const nlohmann::json stats = nlohmann::json::parse(test::read_text(folder.file("stats.json")));
  CHECK(stats["samples_per_pixel"].get<double>() >= 1);
  CHECK(stats["samples_per_pixel"].get<double>() < 100000);
  const ProcessResult result =
      lanewise(folder, {"render", box(), "-r", "24", "18", "--time", "20ms", "--noise", "1e-6", "-f", "a.png"});
  CHECK(result.out.find(" samples per pixel, depth 5") != std::string::npos);
  CHECK(result.out.find("reached in 0 % of the pixels") != std::string::npos);
}

TEST_CASE("command line: the scalar references make the same picture but for rounding") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  REQUIRE(render_small(folder, {box(), "-f", "simd.pfm"}).exit_code == 0);
  for (const char* type : {"float", "double"}) {
    CAPTURE(type);
    const Arguments flags = {box(), "--reference", type, "-f", "reference.pfm"};
    REQUIRE(render_small(folder, flags).exit_code == 0);
    const ProcessResult result = lanewise(folder, {"compare", "simd.pfm", "reference.pfm", "--json"});
    const nlohmann::json comparison = nlohmann::json::parse(result.out);
    for (const double difference : comparison["relative_difference"]) CHECK(std::fabs(difference) < 0.02);
  }
}

TEST_CASE("command line: overrides change the materials that they name") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const std::string metal = scene("cornell_metal.dae");
  const ZeroedVector<float> plain = picture_of(folder, {metal});
  CHECK(picture_of(folder, {metal, "--metal", "Hg"}) != plain);
  CHECK(picture_of(folder, {metal, "--metal", "Hg"}) == picture_of(folder, {metal, "--metal", "Mercury"}));
  CHECK(picture_of(folder, {metal, "--metal", "Cr"}) != picture_of(folder, {metal, "--metal", "cr-printed"}));
  CHECK(picture_of(folder, {metal, "--alpha", "0.7"}) != plain);
  CHECK(picture_of(folder, {box(), "--ior", "1.2"}) != picture_of(folder, {box()}));
}

TEST_CASE("command line: compare, as a table and as JSON") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  Image a(2, 2), b(2, 2);
  b.rgb.assign(12, 0.5f);
  a.rgb = b.rgb;
  a.pixel(0, 1)[2] = 0.75f;
  write_image(folder.file("a.pfm"), a);
  write_image(folder.file("b.exr"), b);
  const ProcessResult json = lanewise(folder, {"compare", "a.pfm", "b.exr", "--json"});
  CHECK(json.exit_code == 0);
  const nlohmann::json c = nlohmann::json::parse(json.out);
  CHECK(c["width"] == 2);
  CHECK(c["mean_a"] == nlohmann::json({0.5, 0.5, 0.5625}));
  CHECK(c["mean_b"] == nlohmann::json({0.5, 0.5, 0.5}));
  CHECK(c["relative_difference"] == nlohmann::json({0.0, 0.0, 0.125}));
  CHECK(c["mse"].get<double>() == doctest::Approx(0.0625 / 12));
  CHECK(c["mrse"].get<double>() == doctest::Approx(0.0625 / (0.51 * 0.51) / 12));
  CHECK(c["differing"] == 0.25);

  const ProcessResult table = lanewise(folder, {"compare", "a.pfm", "b.exr"});
  CHECK(table.exit_code == 0);
  CHECK(table.out.find("+12.5000 %") != std::string::npos);
  CHECK(table.out.find("differing 25 %") != std::string::npos);

  write_image(folder.file("c.png"), Image(3, 2));
  check_failure(folder, 1, {"compare", "a.pfm", "c.png"}, "differ in size: 2x2 and 3x2");
}

}  // namespace
}  // namespace lanewise
