// What render and render_reference share beside the picture.
#pragma once

#include <chrono>

#include "core/profile.h"
#include "core/render.h"
#include "core/schedule.h"

namespace lanewise {

// The threads that settings.threads asks for, or all that the machine has.
uint32_t thread_count(const Settings& settings);

// profiles: of each thread.
RenderResult make_result(Exposure exposure, const std::vector<Profile>& profiles,
                         std::chrono::duration<double> elapsed);

}  // namespace lanewise
