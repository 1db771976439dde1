// What render and render_reference share beside the picture.
#pragma once

#include "core/profile.h"
#include "core/render.h"

namespace lanewise {

RenderStats make_stats(const Profile& profile);

// The threads to use: those asked for or all the machine has, but no more than there are items of work.
uint32_t thread_count(const Settings& settings, size_t items);

}  // namespace lanewise
