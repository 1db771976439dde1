#include "tools/checkpoint.h"

#include <filesystem>
#include <iostream>
#include <utility>
#include <vector>

#include "core/rounds.h"
#include "core/types.h"
#include "tools/memory_limit.h"

namespace lanewise {
namespace {

constexpr const char* kFirstSample = "first-sample";

// None where some pixels, or light paths, have more than their share of whole samples, or others.
std::vector<SampleRange> ranges_of(const SavedRender& state, const Settings& settings) {
  if (!state.numbers.contains(kWholeSamples)) return {};
  return {{settings.first_sample, settings.first_sample + state.number(kWholeSamples)}};
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
