// What the ranks beside rank 0 do in a render by several: see core/remote_ranks.h.
#pragma once

#include <functional>

#include "core/messenger.h"
#include "core/plan.h"
#include "core/profiler.h"
#include "core/render_identity.h"

namespace lanewise {

struct RankJob {
  Plan plan;
  RenderIdentity identity;  // what it must share with rank 0
};

// Loads, says so, and draws what rank 0 asks for, on as many threads as the plan's settings say, until it ends this. What goes wrong
// is rank 0's to tell.
void serve_rank(Messenger& messenger, const std::function<RankJob()>& load, ProfileDetail detail = {});

}  // namespace lanewise
