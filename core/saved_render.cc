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

void SavedRender::put_film_at(const Window& place, const std::string& name, uint32_t width, const Film& film) {
  put_at(place, name + ".samples", width, [&](size_t i) { return film.samples[i]; });
  put_at(place, name + ".r", width, sum_of<&PixelSums::r>(film));
  put_at(place, name + ".g", width, sum_of<&PixelSums::g>(film));
  put_at(place, name + ".b", width, sum_of<&PixelSums::b>(film));
  put_at(place, name + ".y", width, sum_of<&PixelSums::y>(film));
  put_at(place, name + ".y2", width, sum_of<&PixelSums::y2>(film));
}

void SavedRender::get_film_at(const Window& place, const std::string& name, uint32_t width, Film& film) const {
  get_at<uint64_t>(place, name + ".samples", width, [&](size_t i, uint64_t samples) { film.samples[i] = samples; });
  get_at<Uint128>(place, name + ".r", width, set_sum<&PixelSums::r>(film));
  get_at<Uint128>(place, name + ".g", width, set_sum<&PixelSums::g>(film));
  get_at<Uint128>(place, name + ".b", width, set_sum<&PixelSums::b>(film));
  get_at<Uint128>(place, name + ".y", width, set_sum<&PixelSums::y>(film));
  get_at<Uint128>(place, name + ".y2", width, set_sum<&PixelSums::y2>(film));
}

Film SavedRender::own_film(const std::string& name) const {
  Film film(size_t{area.width} * area.height);
  get_film_at(own(), name, area.width, film);
  return film;
}

bool SavedRender::has(const std::string& name) const {
  return std::ranges::any_of(channels, [&](const Channel& c) { return c.name == name + ".0"; });
}

void SavedRender::get_picture(const Settings& settings, const SampleShares& shares, Film& film) const {
  check_area(settings.window());
  get_film("picture", settings.width, film);
  bool more = false, can_be = true;
  get<uint64_t>("picture.samples", settings.width, [&](size_t i, uint64_t n) {
    const auto pixel = static_cast<uint32_t>(i);
    more |= n > shares.count(pixel, settings.spp);
    const bool is_first = n == 1 && settings.first_sample == 0;
    can_be &= more || is_first || shares.count(pixel, shares.samples_for(pixel, n)) == n;
  });
  check(!more, "it has more samples than are asked for");
  check(can_be, "damaged: its pixels have not their shares of samples");
}

void SavedRender::check(bool holds, const std::string& otherwise) const {
  if (!holds) throw UsageError(path + ": cannot resume: " + otherwise);
}

void SavedRender::check_area(const Window& expected) const { check(area == expected, "it has other pixels"); }

uint64_t SavedRender::number(const std::string& name) const {
  const auto found = numbers.find(name);
  if (found == numbers.end()) throw Error(path + ": damaged: no number " + name);
  return found->second;
}

const std::vector<uint32_t>& SavedRender::find(const std::string& channel) const {
  for (const Channel& c : channels) {
    if (c.name == channel && c.words.size() == size_t{area.width} * area.height) return c.words;
  }
  throw Error(path + ": damaged: no channel " + channel);
}

}  // namespace lanewise
