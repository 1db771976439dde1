#include "tools/checkpoint.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <utility>

#include "core/rounds.h"
#include "core/types.h"
#include "tools/memory_limit.h"

namespace lanewise {
namespace {

constexpr const char* kFirstSample = "first-sample";

// The least and the most samples that a pixel has.
std::pair<uint64_t, uint64_t> samples_of(const SavedRender& state, const Settings& settings) {
  uint64_t least = kMaxSpp, most = 0;
  state.get<uint64_t>("picture.samples", settings.width, [&](size_t, uint64_t samples) {
    least = std::min(least, samples);
    most = std::max(most, samples);
  });
  return {least, most};
}

// The samples that every pixel has, or its share of them; none if some have more than others, if light paths have more, or if they are
// in two halves.
std::vector<SampleRange> ranges_of(const SavedRender& state, const Settings& settings) {
  if (settings.adaptive_batch > 0 || !state.has_film("picture")) return {};
  if (state.numbers.contains(kWholeSamples)) {
    return {{settings.first_sample, settings.first_sample + state.number(kWholeSamples)}};
  }
  const auto [least, most] = samples_of(state, settings);
  if (least != most || most == 0) return {};
  bool even = true;
  if (state.has_film("light")) {
    state.get<uint64_t>("light.samples", settings.width,
                        [&, all = most](size_t, uint64_t n) { even = even && n == all; });
  }
  if (!even) return {};
  return {{settings.first_sample, settings.first_sample + most}};
}

}  // namespace

FilmFile film_file(const RenderOptions& o, const RenderIdentity& identity, SavedRender&& state) {
  state.numbers[kFirstSample] = o.settings.first_sample;
  FilmFile film{.identity = identity,
                .width = o.settings.width,
                .height = o.settings.height,
                .ranges = ranges_of(state, o.settings),
                .scene = o.scene,
                .state = {}};
  film.state = std::move(state);
  return film;
}

Checkpoint::Checkpoint(const RenderOptions& o) : options_(o), lock_(o.checkpoint) {
  if (!std::filesystem::exists(o.checkpoint)) return;
  if (!o.resume) throw UsageError(o.checkpoint + ": is there already: --resume goes on from it; or remove it");
  before_ = read_film(o.checkpoint, false);
}

const SavedRender* Checkpoint::resumed(const RenderIdentity& identity) const {
  if (!before_) return nullptr;
  const auto refuse = [&](const std::string& why) {
    throw UsageError(options_.checkpoint + ": cannot resume: " + why);
  };
  if (const std::string d = difference(identity, before_->identity); !d.empty()) refuse(d);
  const Settings& settings = options_.settings;
  const SavedRender& state = before_->state;
  if (state.numbers.contains(kFirstSample) && state.number(kFirstSample) != settings.first_sample) {
    refuse("it begins with sample " + std::to_string(state.number(kFirstSample)));
  }
  return &state;
}

void Checkpoint::write(const FilmFile& film) {
  const bool failed_before = !failure_.empty();
  failure_.clear();
  try {
    write_file(options_.checkpoint, encode_film(film));
  } catch (const std::exception& e) {
    failure_ = is_of_memory(e) ? options_.checkpoint + ": cannot write: " + memory_complaint() : e.what();
  }
  if (!failure_.empty() && !failed_before) std::cerr << "lanewise: warning: " << failure_ << "; rendering goes on\n";
}

}  // namespace lanewise
