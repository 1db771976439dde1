#include "core/film_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <sstream>

#include "core/exr_input.h"
#include "core/exr_slice.h"
#include "core/film.h"
#include "core/fnv.h"
#include "core/types.h"

namespace lanewise {
namespace {

constexpr uint64_t kMaxBytes = kMostPixels * 256;
constexpr size_t kMostNames = 64;                          // of settings; and of channels, twice that
constexpr int64_t kBandPixels = 1 << 16, kChunkRows = 16;  // rows that ZIP packs together
constexpr const char* kFormat = "lanewise film 2";
constexpr const char* kPrefix = "lanewise.";

using Channels = std::vector<const SavedRender::Channel*>;

// By their names, as OpenEXR keeps them.
Channels sorted_channels(const SavedRender& state) {
  Channels channels;
  for (const SavedRender::Channel& c : state.channels) channels.push_back(&c);
  std::ranges::sort(channels, {}, &SavedRender::Channel::name);
  return channels;
}

std::string to_text(const std::vector<SampleRange>& ranges) {
  std::string text;
  for (const SampleRange& r : ranges) text += std::to_string(r.begin) + ":" + std::to_string(r.end) + " ";
  return text;
}

uint64_t number(const std::string& text) {
  if (text.empty() || text.size() > 19 || text.find_first_not_of("0123456789") != std::string::npos)
    throw Error("damaged");
  return std::stoull(text);
}

std::vector<SampleRange> ranges_of(const std::string& text) {
  std::vector<SampleRange> ranges;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const size_t colon = std::min(word.find(':'), word.size() - 1);
    const SampleRange r{number(word.substr(0, colon)), number(word.substr(colon + 1))};
    const bool in_order = ranges.empty() || ranges.back().end < r.begin;
    if (!in_order || r.begin >= r.end || r.end > kMaxSpp) throw Error("damaged");
    ranges.push_back(r);
  }
  return ranges;
}

// Of all that the file says but R, G and B.
std::string checksum(const FilmFile& film) {
  Fnv fnv;
  const Window& area = film.state.area;
  for (const uint32_t n : {film.width, film.height, area.x, area.y, area.width, area.height}) fnv.add(uint64_t{n});
  for (const auto& [name, value] : film.identity) fnv.add(std::string_view(name)), fnv.add(std::string_view(value));
  for (const auto& [name, value] : film.state.numbers) fnv.add(std::string_view(name)), fnv.add(value);
  for (const std::string& text : {film.scene, to_text(film.ranges), std::to_string(film.state.seconds)})
    fnv.add(std::string_view(text));
  fnv.add(film.state.invalid_samples);
  for (const SavedRender::Channel* c : sorted_channels(film.state)) {
    fnv.add(std::string_view(c->name));
    fnv.add(c->words);
  }
  return fnv.hex();
}

uint64_t samples_in(const std::vector<SampleRange>& ranges) {
  uint64_t samples = 0;
  for (const SampleRange& r : ranges) samples += r.end - r.begin;
  return samples;
}

Imf::Slice slice(Imf::PixelType type, const void* first, size_t stride, const Window& area) {
  return exr_slice(type, first, stride, area.x, area.y, area.width);
}

std::string attribute(const Imf::Header& header, const std::string& name) {
  const auto* found = header.findTypedAttribute<Imf::StringAttribute>((kPrefix + name).c_str());
  if (!found) throw Error("no film file of Lanewise");
  return found->value();
}

double seconds(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0 && value < 1e12)) throw Error("damaged");
  return value;
}

FilmFile read(const std::string& path) {
  ExrInput in(path, kMaxBytes);
  const Imf::Header& header = in.header();
  if (attribute(header, "format") != kFormat) throw Error("of another version of Lanewise");
  FilmFile film;
  const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
  const int64_t width = int64_t{data.max.x} - data.min.x + 1, height = int64_t{data.max.y} - data.min.y + 1;
  const int64_t all_x = int64_t{display.max.x} + 1, all_y = int64_t{display.max.y} + 1;
  if (display.min.x != 0 || display.min.y != 0 || width <= 0 || height <= 0 || data.min.x < 0 || data.min.y < 0 ||
      data.max.x >= all_x || data.max.y >= all_y ||
      static_cast<uint64_t>(all_x) > kMostPixels / static_cast<uint64_t>(all_y)) {
    throw Error("absurd size");
  }
  film.width = static_cast<uint32_t>(all_x);
  film.height = static_cast<uint32_t>(all_y);
  film.state.area = {static_cast<uint32_t>(data.min.x), static_cast<uint32_t>(data.min.y), static_cast<uint32_t>(width),
                     static_cast<uint32_t>(height)};
  film.scene = attribute(header, "scene-file");
  film.ranges = ranges_of(attribute(header, "samples"));
  film.state.seconds = seconds(attribute(header, "seconds"));
  film.state.invalid_samples = number(attribute(header, "invalid-samples"));
  std::istringstream names(attribute(header, "identity"));
  for (std::string name; names >> name;) {
    const bool again = std::ranges::any_of(film.identity, [&](const auto& known) { return known.first == name; });
    if (again || film.identity.size() == kMostNames) throw Error("damaged");
    film.identity.emplace_back(name, attribute(header, "is." + name));
  }
  std::istringstream numbers(attribute(header, "numbers"));
  for (std::string name, value; numbers >> name >> value;) film.state.numbers[name] = number(value);

  if (header.hasTileDescription() || header.compression() != Imf::ZIP_COMPRESSION) throw Error("packed as no film is");
  film.state.channels.reserve(2 * kMostNames);
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    if (c.channel().type != Imf::UINT || c.channel().xSampling != 1 || c.channel().ySampling != 1) continue;
    if (film.state.channels.size() == 2 * kMostNames) throw Error("damaged");
    film.state.channels.push_back({c.name(), {}});
  }
  // Some rows at a time, so that a small file that claims to hold a large picture fails before memory is used for it.
  const int64_t band = std::max<int64_t>(1, kBandPixels / width / kChunkRows) * kChunkRows;
  for (int64_t y = 0; y < height; y += band) {
    const int64_t end = std::min(y + band, height);
    Imf::FrameBuffer frame;  // rows that were read may have moved
    for (SavedRender::Channel& c : film.state.channels) {
      c.words.resize(static_cast<size_t>(width * end));
      frame.insert(c.name, slice(Imf::UINT, c.words.data(), sizeof(uint32_t), film.state.area));
    }
    in.file().setFrameBuffer(frame);
    in.file().readPixels(static_cast<int>(data.min.y + y), static_cast<int>(data.min.y + end - 1));
  }
#ifndef LANEWISE_FUZZ  // which has no other way past it
  if (checksum(film) != attribute(header, "checksum")) throw Error("damaged (its checksum is wrong)");
#endif
  return film;
}

// The samples of each pixel of a finished film are as many as its ranges have, or its share of them.
void check_finished(const FilmFile& film) {
  if (film.ranges.empty()) throw Error("it is a checkpoint of a render that is not done");
  const uint64_t samples = samples_in(film.ranges);
  const auto check = [](bool holds) {
    if (!holds) throw Error("damaged (samples are missing)");
  };
  std::optional<SampleShares> shares(0);
  if (!all_have_the_same(film.identity)) {
    shares = SampleShares::saved(0, film.width, film.height, film.state);
    if (!shares) throw Error("damaged (its shares of samples cannot be)");
  }
  film.state.get<uint64_t>("picture.samples", film.width, [&](size_t pixel, uint64_t n) {
    const auto i = static_cast<uint32_t>(pixel);
    for (const SampleRange& r : film.ranges) n -= shares->count(i, r.end) - shares->count(i, r.begin);
    check(n == 0);
  });
  if (!film.state.has_film("light")) return;
  film.state.get<uint64_t>("light.samples", film.width, [&](size_t, uint64_t n) { check(n == samples); });
}

bool is_of_shares(const SavedRender::Channel& channel) {
  return channel.name.starts_with(std::string(SampleShares::kSaved) + ".");
}

std::vector<SavedRender::Channel> shares_of(const SavedRender& state) {
  std::vector<SavedRender::Channel> shares;
  std::ranges::copy_if(state.channels, std::back_inserter(shares), is_of_shares);
  return shares;
}

Film sum_of(Film film, const Film& more) {
  for (size_t i = 0; i < film.sums.size(); ++i) {
    film.sums[i] += more.sums[i];
    film.samples[i] += more.samples[i];
  }
  return film;
}

void add_ranges(std::vector<SampleRange>& ranges, const std::vector<SampleRange>& others) {
  std::vector<SampleRange> all;
  std::ranges::merge(ranges, others, std::back_inserter(all), {}, &SampleRange::begin, &SampleRange::begin);
  std::vector<SampleRange> joined;
  for (const SampleRange& r : all) {
    if (joined.empty() || joined.back().end < r.begin) {
      joined.push_back(r);
    } else if (joined.back().end == r.begin) {
      joined.back().end = r.end;
    } else {
      throw Error("samples " + std::to_string(r.begin) + ":" + std::to_string(std::min(joined.back().end, r.end)) +
                  " are there already");
    }
  }
  ranges = joined;
}

}  // namespace

std::string encode_film(const FilmFile& film) {
  const Window& area = film.state.area;
  const Imath::Box2i all({0, 0}, {static_cast<int>(film.width) - 1, static_cast<int>(film.height) - 1});
  const Imath::V2i corner(static_cast<int>(area.x), static_cast<int>(area.y));
  const Imath::Box2i data(corner,
                          corner + Imath::V2i(static_cast<int>(area.width) - 1, static_cast<int>(area.height) - 1));
  Imf::Header header(all, data);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 1;
  const auto set = [&header](const std::string& name, const std::string& value) {
    header.insert((kPrefix + name).c_str(), Imf::StringAttribute(value));
  };
  set("format", kFormat);
  set("scene-file", film.scene);
  set("samples", to_text(film.ranges));
  set("seconds", std::to_string(film.state.seconds));
  set("invalid-samples", std::to_string(film.state.invalid_samples));
  std::string names, numbers;
  for (const auto& [name, value] : film.identity) {
    names += name + " ";
    set("is." + name, value);
  }
  set("identity", names);
  for (const auto& [name, value] : film.state.numbers) numbers += name + " " + std::to_string(value) + " ";
  set("numbers", numbers);

  const Channels channels = sorted_channels(film.state);
  set("checksum", checksum(film));
  const Image image = develop(film);
  Imf::FrameBuffer frame;
  for (size_t c = 0; c < 3; ++c) {
    const char name[] = {"RGB"[c], 0};
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, slice(Imf::FLOAT, image.rgb.data() + c, 3 * sizeof(float), area));
  }
  for (const SavedRender::Channel* c : channels) {
    header.channels().insert(c->name, Imf::Channel(Imf::UINT));
    frame.insert(c->name, slice(Imf::UINT, c->words.data(), sizeof(uint32_t), area));
  }
  Imf::StdOSStream stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(frame);
    file.writePixels(static_cast<int>(area.height));
  }
  return stream.str();
}

FilmFile read_film(const std::string& path, bool finished) {
  try {
    FilmFile film = read(path);
    if (finished) {
      check_finished(film);
      std::erase_if(film.state.channels, [](const SavedRender::Channel& c) {
        return !c.name.starts_with("picture.") && !c.name.starts_with("light.") && !is_of_shares(c);
      });
    }
    film.state.path = path;
    return film;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    std::string what = e.what();
    throw Error(path + ": cannot read the film: " + what.substr(0, what.find('\n')));
  }
}

void merge_film(FilmFile& film, const FilmFile& other, const std::string& path) {
  try {
    if (const std::string d = difference(film.identity, other.identity); !d.empty()) throw Error(d);
    if (other.state.area != film.state.area) throw Error("it has other pixels");
    add_ranges(film.ranges, other.ranges);
    SavedRender merged;
    merged.area = film.state.area;
    merged.path = film.state.path;
    for (const char* name : {"picture", "light"}) {
      if (name == std::string_view("light") && !film.state.has_film(name) && !other.state.has_film(name)) continue;
      merged.put_own_film(name, sum_of(film.state.own_film(name), other.state.own_film(name)));
    }
    // Those of the first film, which say the same as those of the other.
    std::vector<SavedRender::Channel> shares = shares_of(film.state);
    if (shares != shares_of(other.state)) throw Error("it has other shares of samples");
    std::ranges::move(shares, std::back_inserter(merged.channels));
    merged.seconds = film.state.seconds + other.state.seconds;
    merged.invalid_samples = film.state.invalid_samples + other.state.invalid_samples;
    film.state = std::move(merged);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(path + ": cannot merge: " + e.what());
  }
}

Image develop(const FilmFile& film) {
  const Window all{0, 0, film.state.area.width, film.state.area.height};
  // The two halves of --noise are not brought together: a look at the first must do while it is not done.
  const Film picture = film.state.own_film(film.state.has_film("picture") ? "picture" : "half0");
  if (!film.state.has_film("light")) return develop(picture, all.width, all, nullptr, 1);
  const Film light = film.state.own_film("light");
  return develop(picture, all.width, all, &light, 1);
}

}  // namespace lanewise
