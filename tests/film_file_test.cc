#include "core/film_file.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "core/file.h"
#include "core/image_io.h"
#include "core/plan.h"
#include "core/render.h"
#include "core/types.h"
#include "core/verify/test_scene.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

Settings small() {
  Settings settings;
  settings.width = 24, settings.height = 18, settings.threads = 2;
  return settings;
}

FilmFile render_part(Settings settings, uint64_t begin, uint64_t end, uint32_t wave = 4096) {
  settings.first_sample = begin, settings.spp = end - begin, settings.wave = wave;
  const Scene scene = test::test_scene();
  FilmFile film{.identity = render_identity(scene, settings, "any"),
                .width = settings.width,
                .height = settings.height,
                .ranges = {{begin, end}},
                .scene = "a scene",
                .state = {}};
  render(make_plan(scene, settings), {.save = [&](SavedRender&& state) { film.state = std::move(state); }});
  return film;
}

struct Folder : test::TemporaryFolder {
  std::string write(const std::string& name, const FilmFile& film) const {
    write_file(file(name), encode_film(film));
    return file(name);
  }
};

std::string refusal(const std::string& path) {
  try {
    read_film(path, true);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

}  // namespace

TEST_CASE("film file: comes back to the bit, and is a picture to others") {
  const Folder folder;
  Settings settings = small();
  settings.crop = {5, 3, 11, 7};
  const FilmFile film = render_part(settings, 3, 12);
  const std::string path = folder.write("film.exr", film);
  const FilmFile back = read_film(path, true);
  CHECK(back.identity == film.identity);
  CHECK(back.ranges == film.ranges);
  CHECK(back.scene == "a scene");
  CHECK(back.state.area.x == 5);
  CHECK(encode_film(back) == encode_film(film));
  CHECK(read_image(path).rgb == develop(film).rgb);

  settings.spp = 9, settings.first_sample = 3;
  CHECK(read_image(path).rgb == render(make_plan(test::test_scene(), settings)).image.rgb);
}

TEST_CASE("film file: parts merged in any order and grouping are the render in one run, to the bit") {
  const Folder folder;
  constexpr uint64_t kFar = (uint64_t{1} << 32) - 20;  // so that one part reaches over 2^32
  const uint64_t cuts[] = {kFar, kFar + 1, kFar + 9, kFar + 16, kFar + 31, kFar + 33, kFar + 50, kFar + 64};
  const FilmFile whole = render_part(small(), cuts[0], cuts[7]);
  std::vector<std::string> parts;
  for (size_t i = 0; i < 7; ++i) {
    const FilmFile part = render_part(small(), cuts[i], cuts[i + 1], 256 << i % 3);
    parts.push_back(folder.write(std::to_string(i) + ".exr", part));
  }
  std::mt19937 rng(7);
  for (int round = 0; round < 6; ++round) {
    std::shuffle(parts.begin(), parts.end(), rng);
    // Two groups, merged by themselves, then with each other.
    const size_t cut = 1 + rng() % 6;
    FilmFile groups[2];
    for (size_t i = 0; i < 7; ++i) {
      FilmFile part = read_film(parts[i], true);
      if (i == 0 || i == cut) {
        groups[i >= cut] = std::move(part);
      } else {
        merge_film(groups[i >= cut], part, parts[i]);
      }
    }
    merge_film(groups[0], read_film(folder.write("group.exr", groups[1]), true), "group.exr");
    CHECK(groups[0].ranges == whole.ranges);
    FilmFile merged = groups[0];
    merged.state.seconds = whole.state.seconds;
    merged.state.numbers = whole.state.numbers;
    CHECK(encode_film(merged) == encode_film(whole));
  }
}

TEST_CASE("film file: what overlaps or is of another render is refused, and says why") {
  FilmFile film = render_part(small(), 0, 8);
  const auto refuse = [&](const FilmFile& other) {
    try {
      merge_film(film, other, "b.exr");
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(refuse(render_part(small(), 6, 9)) == "b.exr: cannot merge: samples 6:8 are there already");
  Settings other = small();
  other.max_depth = 7;
  CHECK(refuse(render_part(other, 8, 9)) == "b.exr: cannot merge: max-depth is 7, not 5");
  other = small();
  other.seed = 1;
  CHECK(refuse(render_part(other, 8, 9)) == "b.exr: cannot merge: seed is 1, not 0");
  other = small();
  other.direct = Direct::kLight;
  CHECK(refuse(render_part(other, 8, 9)) == "b.exr: cannot merge: direct is another");
  FilmFile changed = render_part(small(), 8, 9);
  Scene scene = test::test_scene();
  scene.materials[0].reflectance.x *= 0.999;
  changed.identity = render_identity(scene, small(), "any");
  CHECK(refuse(changed).find("another scene") != std::string::npos);
  CHECK(refuse(render_part(small(), 8, 9)).empty());
  CHECK(film.ranges == std::vector<SampleRange>{{0, 9}});
}

TEST_CASE("film file: what is damaged, cut off or no film is refused with the file's name") {
  const Folder folder;
  const FilmFile film = render_part(small(), 0, 8);
  const std::string bytes = encode_film(film);
  const std::string path = folder.file("bad.exr");
  std::mt19937 rng(8);
  int harmless = 0;
  for (int i = 0; i < 60; ++i) {
    std::string bad = bytes;
    if (i % 2 == 0) {
      bad.resize(bytes.size() * static_cast<size_t>(i) / 60);
    } else {
      // Behind the header, some of whose texts are nobody's business: there every byte counts.
      const size_t at = bytes.size() / 2 + rng() % (bytes.size() / 2);
      bad[at] = static_cast<char>(bad[at] ^ (1 << rng() % 8));
    }
    test::write_text(path, bad);
    CAPTURE(i);
    const std::string error = refusal(path);
    // A bit of compressed data may say the same in other words: that is no damage.
    const bool same = error.empty() && encode_film(read_film(path, true)) == bytes;
    CHECK((same || error.starts_with(path + ": cannot read the film: ")));
    CHECK((!same || i % 2 == 1));
    harmless += same;
  }
  CHECK(harmless < 6);
  // And these in the header.
  const std::string attribute(
      "lanewise.invalid-samples\0string\0\1\0\0\0"
      "0",
      37);
  std::string more = bytes;
  REQUIRE(more.find(attribute) != std::string::npos);
  more[more.find(attribute) + attribute.size() - 1] = '1';
  test::write_text(path, more);
  CHECK(refusal(path).find("checksum") != std::string::npos);
  FilmFile unfinished = film;
  unfinished.ranges.clear();
  CHECK(refusal(folder.write("checkpoint.exr", unfinished)).find("not done") != std::string::npos);
  FilmFile lacking = film;
  lacking.ranges = {{0, 9}};
  CHECK(refusal(folder.write("lacking.exr", lacking)).find("samples are missing") != std::string::npos);
  write_image(folder.file("picture.exr"), develop(film));
  CHECK(refusal(folder.file("picture.exr")).find("no film file") != std::string::npos);
  CHECK(refusal(folder.file("nowhere.exr")).starts_with(folder.file("nowhere.exr")));
}

}  // namespace lanewise
