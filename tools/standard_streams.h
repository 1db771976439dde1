// Standard input, output and error, as whoever has started the program left them: closed, full, or read by nobody any more.
#pragma once

#include <cstddef>
#include <streambuf>
#include <vector>

namespace lanewise {

// Whichever of them is closed becomes /dev/null. Otherwise the next file that is opened, a picture or a lock, would take its
// number, and messages would be written into it. To be called first of all.
void open_standard_streams();

// While it lives, standard output is written to by it: std::cout alone does not tell why a write has failed.
class StandardOutput : public std::streambuf {
 public:
  StandardOutput();
  ~StandardOutput() override;
  StandardOutput(const StandardOutput&) = delete;
  StandardOutput& operator=(const StandardOutput&) = delete;

  // When all is said. Throws Error if some of it could not be written; BrokenPipe if nobody reads it any more.
  void finish();

 protected:
  int_type overflow(int_type c) override;
  int sync() override;

 private:
  std::vector<char> buffer_;
  std::streambuf* before_;
  int error_ = 0;  // of the first write that failed
};

}  // namespace lanewise
