// The scene that a command line names, as its flags change it.
#pragma once

#include "core/scene.h"
#include "tools/render_options.h"

namespace lanewise {

// Loads it and applies the flags of materials, normals and camera. Throws Error for files that cannot be used, UsageError for a
// flag that has nothing to change.
Scene load_chosen_scene(const RenderOptions& options);

}  // namespace lanewise
