// What a render has drawn so far: all that it takes to go on with it, and to come to the same bits as if it had never stopped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "core/film.h"
#include "core/sample_shares.h"
#include "core/settings.h"
#include "core/types.h"

namespace lanewise {

// Values of the pixels of a window, cut into words of 32 bits: what an OpenEXR file can hold.
class SavedRender {
 public:
  struct Channel {
    std::string name;
    std::vector<uint32_t> words;  // a pixel each, rows from the top
    bool operator==(const Channel&) const = default;
  };

  Window area;  // of the picture
  std::vector<Channel> channels;
  double seconds = 0;                       // spent drawing
  std::map<std::string, uint64_t> numbers;  // of the whole
  uint64_t invalid_samples = 0;             // NaN, infinite or negative; black in the sums
  std::string path;                         // the file that it was read from, for errors

  // Throws UsageError, naming the file, if a condition does not hold that a render needs to go on with this.
  void check(bool holds, const std::string& otherwise) const;
  // It has these pixels.
  void check_area(const Window& expected) const;

  // value(i): of pixel i of the picture (y width + x), of a type of whole words; kept as name.0, name.1, ... lowest first.
  template <class F>
  void put(const std::string& name, uint32_t width, const F& value) {
    put_at(area, name, width, value);
  }

  // set(i, value) for every pixel. Throws Error, naming the file, if the channels are not there.
  template <class T, class F>
  void get(const std::string& name, uint32_t width, const F& set) const {
    get_at<T>(area, name, width, set);
  }

  // Sums and numbers of samples, of a picture that wide; where there are no samples, sums are taken for nothing whatever they are.
  void put_film(const std::string& name, uint32_t width, const Film& film) { put_film_at(area, name, width, film); }
  void get_film(const std::string& name, uint32_t width, Film& film) const { get_film_at(area, name, width, film); }
  bool has(const std::string& name) const;
  bool has_film(const std::string& name) const { return has(name + ".samples"); }
  // The film "picture" of a render with these settings, of as many samples of each pixel at most as they ask for.
  void get_picture(const Settings& settings, const SampleShares& shares, Film& film) const;

  // The same of the window alone.
  void put_own_film(const std::string& name, const Film& film) { put_film_at(own(), name, area.width, film); }
  Film own_film(const std::string& name) const;

  // Throws Error if it is not there.
  uint64_t number(const std::string& name) const;

 private:
  template <class T>
  static constexpr size_t words() {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(uint32_t) == 0);
    return sizeof(T) / sizeof(uint32_t);
  }

  Window own() const { return {0, 0, area.width, area.height}; }

  // place: where the area lies in arrays with rows of that width.
  template <class F>
  void put_at(const Window& place, const std::string& name, uint32_t width, const F& value) {
    using T = std::remove_cvref_t<decltype(value(size_t{0}))>;
    const size_t first = channels.size();
    for (size_t k = 0; k < words<T>(); ++k) {
      channels.push_back({name + "." + std::to_string(k), {}});
      channels.back().words.reserve(size_t{area.width} * area.height);
    }
    for_each_pixel(place, width, [&](size_t i, size_t) {
      uint32_t parts[words<T>()];
      const T whole = value(i);
      std::memcpy(parts, &whole, sizeof whole);
      for (size_t k = 0; k < words<T>(); ++k) channels[first + k].words.push_back(parts[k]);
    });
  }

  template <class T, class F>
  void get_at(const Window& place, const std::string& name, uint32_t width, const F& set) const {
    const std::vector<uint32_t>* found[words<T>()];
    for (size_t k = 0; k < words<T>(); ++k) found[k] = &find(name + "." + std::to_string(k));
    for_each_pixel(place, width, [&](size_t i, size_t pixel) {
      uint32_t parts[words<T>()];
      for (size_t k = 0; k < words<T>(); ++k) parts[k] = (*found[k])[pixel];
      T whole;
      std::memcpy(&whole, parts, sizeof whole);
      set(i, whole);
    });
  }

  void put_film_at(const Window& place, const std::string& name, uint32_t width, const Film& film);
  void get_film_at(const Window& place, const std::string& name, uint32_t width, Film& film) const;

  template <class F>
  static void for_each_pixel(const Window& place, uint32_t width, const F& f) {
    size_t pixel = 0;
    for (uint32_t y = place.y; y < place.y + place.height; ++y) {
      for (uint32_t x = place.x; x < place.x + place.width; ++x) f(size_t{y} * width + x, pixel++);
    }
  }
  const std::vector<uint32_t>& find(const std::string& channel) const;
};

}  // namespace lanewise
