// Which pixels get how many samples: -s and --time the same for all or their shares of so many, -a batches until a pixel has
// converged, --noise what the noise demands. Both renderers draw their samples through it, and differ only in how they draw.
#pragma once

#include <cstdint>

#include "core/exposure.h"
#include "core/render_control.h"
#include "core/settings.h"

namespace lanewise {

// workers: how many threads may draw at a time. light: null if there are no light paths. side: of the squares of pixels that hang
// together.
Exposure expose(const Settings& settings, uint32_t workers, const Draw& draw, const RenderControl& control = {},
                LightPathDraw* light = nullptr, uint32_t side = 1);

}  // namespace lanewise
