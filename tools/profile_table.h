// A profile for the terminal, at most 118 columns wide.
#pragma once

#include <string>

#include "tools/profile_report.h"

namespace lanewise {

// What was measured and how: some lines that the table and the page begin with.
std::string profile_summary(const ProfileReport& report);

// The summary, the stages over all bounces, the bounces over all stages, ns per path of each stage at each bounce, and how it
// scales over threads.
std::string profile_table(const ProfileReport& report);

}  // namespace lanewise
