// A profile as a page of charts.
#pragma once

#include <string>

#include "tools/profile_report.h"

namespace lanewise {

// One file that needs no other: charts of time, ns per path, live lanes, queue lengths, bandwidth, rays and scaling, then the
// tables. For windows of 400 pixels and up.
std::string profile_page(const ProfileReport& report);

}  // namespace lanewise
