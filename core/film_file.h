// Film files: a picture together with the exact sums that it is made of, so that renders can be stopped, resumed and merged.
//
// A film file is an OpenEXR picture: R, G and B are its radiance, for any program to show, and what is more lies in channels of
// 32-bit words beside them: for each of picture.r, .g, .b, .y, .y2 (core/pixel_sums.h) and picture.samples its words, lowest
// first, as picture.r.0 to picture.r.3; and where there are light paths (core/plan_light_paths.h) the same of `light`, whose
// samples are passes; and where pixels have shares of the samples (core/sample_shares.h), `shares`. The header says what the
// samples hang on (identity), which samples they are, and has a checksum over all of this.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/render_identity.h"
#include "core/saved_render.h"

namespace lanewise {

// Samples begin .. end - 1 of every pixel, or its share of them (core/sample_shares.h).
struct SampleRange {
  uint64_t begin = 0, end = 0;
  bool operator==(const SampleRange&) const = default;
};

struct FilmFile {
  RenderIdentity identity;
  uint32_t width = 0, height = 0;   // of the whole picture
  std::vector<SampleRange> ranges;  // in order, with gaps between them; empty: a render that has not come to its end
  std::string scene;                // its file, for people
  SavedRender state;
};

// The bytes of the file. Throws std::exception.
std::string encode_film(const FilmFile& film);

// Throws Error, naming the path, for what is no film file, damaged, or of more than 2^28 pixels; and, if it must be finished, for
// one that is not. Of finished films only what they have of the picture is kept.
FilmFile read_film(const std::string& path, bool finished);

// Adds the samples of another film to the first, both finished. Throws Error, beginning with the path of the other, if it has
// samples that are there already, or another identity.
void merge_film(FilmFile& film, const FilmFile& other, const std::string& path);

// Of the film's pixels.
Image develop(const FilmFile& film);

}  // namespace lanewise
