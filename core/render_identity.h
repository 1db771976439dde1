// What a picture's samples hang on: two renders that agree in it draw the same bits for the same sample.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/scene.h"
#include "core/settings.h"

namespace lanewise {

// Flags (without dashes) and values, in a fixed order; the scene as a hash of all that the plan is made of. Not in it: threads,
// wave, times, file names, and, where every pixel gets the same number of samples, how many.
// arithmetic: see arithmetic_of().
using RenderIdentity = std::vector<std::pair<std::string, std::string>>;
RenderIdentity render_identity(const Scene& scene, const Settings& settings, const std::string& arithmetic);

// Whether all pixels have the same number of samples, where it is not their noise that says how many.
bool all_have_the_same(const RenderIdentity& identity);

// The instruction sets whose kernels give the same bits have the same name here.
std::string arithmetic_of(const std::string& isa);

// What of `other` is not as in `expected`, for a message: "max-depth is 7, not 5". Empty: nothing.
std::string difference(const RenderIdentity& expected, const RenderIdentity& other);

}  // namespace lanewise
