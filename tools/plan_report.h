// What `lanewise plan` tells.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/explain.h"

namespace lanewise {

// A list of {topic, subject, choice, reason, figures {name: number}}; bytes are bytes, shares are in [0, 1].
nlohmann::ordered_json decisions_json(const std::vector<Decision>& decisions);

// For the terminal: a table for each topic, of at most 118 columns unless names are very long.
std::string decisions_table(const std::vector<Decision>& decisions);

}  // namespace lanewise
