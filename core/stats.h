// What render and render_reference share beside the picture.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "core/profile.h"
#include "core/render.h"
#include "core/schedule.h"

namespace lanewise {

// The threads that settings.threads asks for, or all that the machine has.
uint32_t thread_count(const Settings& settings);

// profiles: of each thread.
// resumed: what the render went on with, or null.
RenderResult make_result(Exposure exposure, const std::vector<Profile>& profiles, const SavedRender* resumed,
                         std::chrono::duration<double> elapsed);

// The control, with what it saves told of the invalid samples: count() of this run, and those from before. It must outlast that.
RenderControl count_invalid(const RenderControl& control, std::function<uint64_t()> count);

}  // namespace lanewise
