#include "core/saved_render.h"

#include <algorithm>

namespace lanewise {
namespace {

// A member of the pixels' sums.
template <auto kMember>
auto sum_of(const Film& film) {
  return [&film](size_t i) { return film.samples[i] > 0 ? (film.sums[i].*kMember).units() : Uint128{0}; };
}

template <auto kMember>
auto set_sum(Film& film) {
  using Sum = std::remove_reference_t<decltype(film.sums[0].*kMember)>;
  return [&film](size_t i, Uint128 units) { film.sums[i].*kMember = Sum(units); };
}

}  // namespace

void SavedRender::put_film(const std::string& name, uint32_t width, const Film& film) {
  put(name + ".samples", width, [&](size_t i) { return film.samples[i]; });
  put(name + ".r", width, sum_of<&PixelSums::r>(film));
  put(name + ".g", width, sum_of<&PixelSums::g>(film));
  put(name + ".b", width, sum_of<&PixelSums::b>(film));
  put(name + ".y", width, sum_of<&PixelSums::y>(film));
  put(name + ".y2", width, sum_of<&PixelSums::y2>(film));
}

void SavedRender::get_film(const std::string& name, uint32_t width, Film& film) const {
  get<uint64_t>(name + ".samples", width, [&](size_t i, uint64_t samples) { film.samples[i] = samples; });
  get<Uint128>(name + ".r", width, set_sum<&PixelSums::r>(film));
  get<Uint128>(name + ".g", width, set_sum<&PixelSums::g>(film));
  get<Uint128>(name + ".b", width, set_sum<&PixelSums::b>(film));
  get<Uint128>(name + ".y", width, set_sum<&PixelSums::y>(film));
  get<Uint128>(name + ".y2", width, set_sum<&PixelSums::y2>(film));
}

bool SavedRender::has_film(const std::string& name) const {
  return std::ranges::any_of(channels, [&](const Channel& c) { return c.name == name + ".samples.0"; });
}

uint64_t SavedRender::number(const std::string& name) const {
  const auto found = numbers.find(name);
  if (found == numbers.end()) throw Error("no number " + name);
  return found->second;
}

const std::vector<uint32_t>& SavedRender::find(const std::string& channel) const {
  for (const Channel& c : channels) {
    if (c.name == channel && c.words.size() == size_t{area.width} * area.height) return c.words;
  }
  throw Error("no channel " + channel);
}

}  // namespace lanewise
