// -s and --time: every pixel gets the same number of samples, or its share of them, in rounds over the whole picture.
#pragma once

#include <cstdint>

#include "core/exposure.h"
#include "core/render_control.h"
#include "core/settings.h"

namespace lanewise {

// Number in a SavedRender, where every pixel has its share of so many samples and no more, and light paths have as many passes: how
// many.
constexpr const char* kWholeSamples = "whole-samples";

// Where time is given: how many samples of each pixel the next round draws, of `most` in all. done: so far, of each pixel;
// fits: how many more there is time for, at the rate of the last round. Doubles, as sequences of low discrepancy have it, and
// leaves a tenth of the time to set the rate right by; the last, single sample is for the clock to cut.
uint32_t timed_round(uint64_t done, uint64_t most, double fits);

Exposure expose_in_rounds(const Settings& settings, uint32_t workers, const Draw& draw, const RenderControl& control,
                          LightPathDraw* light, uint32_t side);

}  // namespace lanewise
