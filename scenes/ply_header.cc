#include "scenes/ply_header.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <set>
#include <sstream>
#include <vector>

#include "core/types.h"
#include "scenes/quoted.h"

namespace lanewise {
namespace {

constexpr size_t kMaxHeader = 1 << 16;

uint64_t bytes_of(const std::string& type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "int" || type == "uint" || type == "float" || type == "int32" || type == "uint32" || type == "float32") {
    return 4;
  }
  return type == "double" || type == "float64" ? 8 : 0;
}

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
    return "ply\n" + clean_ + "end_header\n" + text_.substr(at_);
  }

 private:
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
      binary_ = words_[1] == "binary_little_endian" || words_[1] == "binary_big_endian";
    } else if (keyword == "element" && words_.size() == 3) {
      finish_element();
      element_ = words_[1];
      const std::string& count = words_[2];
      const auto [rest, error] = std::from_chars(count.data(), count.data() + count.size(), count_);
      if (error != std::errc() || rest != count.data() + count.size()) fail_line();
    } else if (keyword == "property" && words_.size() == 3 && bytes_of(words_[1]) > 0) {
      if (element_ == "vertex") coordinates_.insert(words_[2]);
      least_ += ascii_ ? 2 : bytes_of(words_[1]);  // a digit and what ends it
    } else if (keyword == "property" && words_.size() == 5 && words_[1] == "list" && bytes_of(words_[2]) > 0 &&
               bytes_of(words_[3]) > 0) {
      least_ += ascii_ ? 2 : bytes_of(words_[2]);  // its length
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
    count_ = least_ = 0;
  }

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
  bool ascii_ = false, binary_ = false;
  std::string element_;
  uint64_t count_ = 0;
  uint64_t least_ = 0;   // bytes that one of the element takes
  uint64_t needed_ = 0;  // by the elements before
  std::set<std::string> coordinates_;
};

}  // namespace

std::string checked_ply(const std::string& path, const std::string& text) { return Header(path, text).rewrite(); }

}  // namespace lanewise
