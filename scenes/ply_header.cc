#include "scenes/ply_header.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/types.h"
#include "scenes/quoted.h"

namespace lanewise {
namespace {

constexpr size_t kMaxHeader = 1 << 16;
constexpr const char* kSpace = " \t";

uint64_t bytes_of(const std::string& type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "int" || type == "uint" || type == "float" || type == "int32" || type == "uint32" || type == "float32") {
    return 4;
  }
  return type == "double" || type == "float64" ? 8 : 0;
}

// Whether a list's length may be of that type.
bool is_whole(const std::string& type) { return bytes_of(type) > 0 && type[0] != 'f' && type[0] != 'd'; }

class Header {
 public:
  Header(const std::string& path, const std::string& text) : path_(path), text_(text) {}

  std::string rewrite() {
    if (!next_line() || words_ != Words{"ply"}) fail("not a PLY file: it does not begin with a line ply");
    while (true) {
      if (!next_line()) fail("not a PLY file: its header has no line end_header");
      if (words_ == Words{"end_header"}) break;
      read_line();
    }
    finish_element();
    if (!ascii_ && !binary_) fail("its header names no format that is known");
    if (!coordinates_.contains("x") || !coordinates_.contains("y") || !coordinates_.contains("z")) {
      fail("its vertices have no x, y and z");
    }
    // The last number of an ascii file may end with it.
    if (needed_ > text_.size() - at_ + 1) fail("is truncated: its header asks for more than the file holds");
    if (ascii_) {
      check_ascii_lists();
    } else {
      check_binary_lists();
    }
    return "ply\n" + clean_ + "end_header\n" + text_.substr(at_);
  }

 private:
  struct Property {
    uint64_t bytes;        // of the value, or of each in a list
    uint64_t count_bytes;  // of a list's length; 0: no list
  };
  struct Element {
    uint64_t count;
    std::vector<Property> properties;
    bool has_lists() const {
      return std::ranges::any_of(properties, [](const Property& p) { return p.count_bytes > 0; });
    }
  };

  using Words = std::vector<std::string>;

  // False at the end of what may be a header.
  bool next_line() {
    const size_t end = text_.find('\n', at_);
    if (end == std::string::npos || end > kMaxHeader) return false;
    std::istringstream line(text_.substr(at_, end - at_));
    words_ = Words(std::istream_iterator<std::string>(line), {});
    at_ = end + 1;
    return true;
  }

  void read_line() {
    const std::string keyword = words_.empty() ? "" : words_[0];
    if (keyword == "comment" || keyword == "obj_info") return;
    if (keyword == "format" && words_.size() == 3) {
      ascii_ = words_[1] == "ascii";
      little_ = words_[1] == "binary_little_endian";
      binary_ = little_ || words_[1] == "binary_big_endian";
    } else if (keyword == "element" && words_.size() == 3) {
      finish_element();
      element_ = words_[1];
      // Of an element that it does not know, Assimp takes the name for the count.
      if (std::isdigit(static_cast<unsigned char>(element_[0]))) fail_line();
      // Assimp has room for the first, and writes the second into it.
      if (!names_.insert(element_ == "tristrips" ? "face" : element_).second) {
        fail("its element " + lanewise::quoted(element_) + " is there twice");
      }
      const std::string& count = words_[2];
      const auto [rest, error] = std::from_chars(count.data(), count.data() + count.size(), count_);
      if (error != std::errc() || rest != count.data() + count.size()) fail_line();
    } else if (keyword == "property" && words_.size() == 3 && bytes_of(words_[1]) > 0) {
      if (element_ == "vertex") coordinates_.insert(words_[2]);
      least_ += ascii_ ? 2 : bytes_of(words_[1]);  // a digit and what ends it
      properties_.push_back({bytes_of(words_[1]), 0});
    } else if (keyword == "property" && words_.size() == 5 && words_[1] == "list" && is_whole(words_[2]) &&
               bytes_of(words_[3]) > 0) {
      least_ += ascii_ ? 2 : bytes_of(words_[2]);  // its length
      properties_.push_back({bytes_of(words_[3]), bytes_of(words_[2])});
    } else {
      fail_line();
    }
    for (const std::string& word : words_) {
      if (std::ranges::any_of(word, [](unsigned char c) { return c > '~'; })) fail_line();
      clean_ += word + (&word == &words_.back() ? "\n" : " ");
    }
  }

  // Whoever reads the file allocates at once what the header asks for, and trusts that every element takes room.
  void finish_element() {
    if (count_ > 0 && least_ == 0) fail("its element " + lanewise::quoted(element_) + " has no properties");
    if (count_ > text_.size()) fail("is truncated: its header asks for more than the file holds");
    needed_ += count_ * least_;
    elements_.push_back({count_, std::move(properties_)});
    properties_.clear();
    count_ = least_ = 0;
  }

  // A list's length is allocated as it is read, too.
  void check_binary_lists() const {
    uint64_t at = at_;
    for (const Element& element : elements_) {
      if (!element.has_lists()) {
        for (const Property& property : element.properties) at += element.count * property.bytes;
        continue;
      }
      for (uint64_t i = 0; i < element.count; ++i) {
        for (const Property& property : element.properties) {
          if (property.count_bytes > text_.size() - std::min<uint64_t>(at, text_.size())) fail_list();
          uint64_t length = 1;
          if (property.count_bytes > 0) length = number_at(at, property.count_bytes);
          at += property.count_bytes + length * property.bytes;
        }
        if (at > text_.size()) fail_list();
      }
    }
  }

  uint64_t number_at(uint64_t at, uint64_t bytes) const {
    uint64_t value = 0;
    for (uint64_t i = 0; i < bytes; ++i) {
      value = value << 8 | static_cast<uint8_t>(text_[at + (little_ ? bytes - 1 - i : i)]);
    }
    return value;
  }

  // An element a line. What Assimp takes for the end of one, and others do not, is refused, and so are the empty lines that it
  // skips.
  void check_ascii_lists() const {
    size_t at = at_;
    for (const Element& element : elements_) {
      for (uint64_t i = 0; i < element.count; ++i) {
        const size_t end = std::min(text_.find('\n', at), text_.size());
        std::string_view line = std::string_view(text_).substr(at, end - at);
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (line.find_first_of(std::string_view("\0\f\r", 3)) != std::string_view::npos ||
            line.find_first_not_of(kSpace) == std::string_view::npos) {
          fail("a line of it is not that of an element");
        }
        if (element.has_lists()) check_line(element, line);
        at = std::min(end + 1, text_.size());
      }
    }
  }

  void check_line(const Element& element, std::string_view line) const {
    for (const Property& property : element.properties) {
      uint64_t values = 1;
      if (property.count_bytes > 0) {
        line.remove_prefix(std::min(line.find_first_not_of(kSpace), line.size()));
        const auto [rest, error] = std::from_chars(line.data(), line.data() + line.size(), values);
        if (error != std::errc() || values > line.size()) fail_list();
        line.remove_prefix(static_cast<size_t>(rest - line.data()));
      }
      for (; values > 0; --values) {
        line.remove_prefix(std::min(line.find_first_not_of(kSpace), line.size()));
        if (line.empty()) fail_list();
        line.remove_prefix(std::min(line.find_first_of(kSpace), line.size()));
      }
    }
  }

  [[noreturn]] void fail_list() const { fail("is truncated: a list of it is shorter than the file says"); }

  [[noreturn]] void fail_line() const {
    std::string line;
    for (const std::string& word : words_) line += (line.empty() ? "" : " ") + word;
    fail("its header has the line " + lanewise::quoted(line));
  }
  [[noreturn]] void fail(const std::string& message) const { throw Error(path_ + ": " + message); }

  const std::string& path_;
  const std::string& text_;
  size_t at_ = 0;      // where the next line begins
  Words words_;        // of the line
  std::string clean_;  // the lines that matter
  bool ascii_ = false, binary_ = false, little_ = false;
  std::string element_;
  uint64_t count_ = 0;
  std::vector<Property> properties_;  // of the element
  std::vector<Element> elements_;     // that are complete
  uint64_t least_ = 0;                // bytes that one of the element takes
  uint64_t needed_ = 0;               // by the elements before
  std::set<std::string> coordinates_, names_;
};

}  // namespace

std::string checked_ply(const std::string& path, const std::string& text) { return Header(path, text).rewrite(); }

}  // namespace lanewise
