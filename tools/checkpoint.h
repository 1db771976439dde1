// --checkpoint and --resume: a render's film on disk, and the one that it goes on from.
#pragma once

#include <optional>
#include <string>

#include "core/file.h"
#include "core/film_file.h"
#include "tools/render_options.h"

namespace lanewise {

// The film file of what a render has drawn.
FilmFile film_file(const RenderOptions& options, const RenderIdentity& identity, SavedRender&& state);

class Checkpoint {
 public:
  // Takes the lock on the file, and reads what there is to resume. Throws Error or UsageError if another render has it, if it
  // is there and must not be overwritten, or if it cannot be read.
  explicit Checkpoint(const RenderOptions& options);

  // What to go on from; null: from the beginning. Throws UsageError if it is of another render.
  const SavedRender* resumed(const RenderIdentity& identity) const;

  // If it cannot be written, the render is to go on: warns once in a row of failures.
  void write(const FilmFile& film);
  // The last attempt's failure; empty: there was none.
  const std::string& failure() const { return failure_; }

 private:
  const RenderOptions& options_;
  FileLock lock_;
  std::optional<FilmFile> before_;
  std::string failure_;
};

}  // namespace lanewise
