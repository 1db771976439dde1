// What changed from one profile to another.
#pragma once

#include <string>

#include "tools/profile_report.h"

namespace lanewise {

// A table of ns per path of each stage, the old and the new, with marks where the change is beyond the noise. It is where both
// hold: by the rank test, runs of the same speed would differ so in fewer than 1 of 100 comparisons (which takes five runs of
// each); and the medians differ by more than 3%, or 10% for a stage with less than 1% of the time, since between two processes
// more differs than between runs of one, such as where memory lies. On a busy machine others use its caches, too: 3% more for
// every 10% of the waves that were not calm. First come the lines that say what else is different: scene, flags, processor.
std::string compare_profiles(const std::string& old_path, const ProfileReport& old_report, const ProfileReport& report);

}  // namespace lanewise
