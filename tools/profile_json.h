// Profiles as files.
#pragma once

#include <string>

#include "tools/profile_report.h"

namespace lanewise {

// Everything in the report, and for other readers what follows from it: shares, ns per path, live lanes, bytes, rates.
// Seconds of wall clock or, of stages, of thread time; bytes and rays per second are those of one thread.
std::string profile_json(const ProfileReport& report);

// The report in such a file. Throws Error, naming the file, for any other.
ProfileReport read_profile(const std::string& path);

}  // namespace lanewise
