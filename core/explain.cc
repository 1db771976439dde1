#include "core/explain.h"

#include <cstdio>

#include "core/explain_topics.h"

namespace lanewise {

std::vector<Decision> explain(const Plan& plan) {
  std::vector<Decision> decisions;
  explain_stages(plan, decisions);
  explain_light(plan, decisions);
  explain_state(plan, decisions);
  explain_geometry(plan, decisions);
  explain_memory(plan, decisions);
  return decisions;
}

std::string one_line(const Decision& d) {
  std::string text = d.topic + ": " + d.subject + ": " + d.choice;
  for (const Figure& figure : d.figures) {
    char value[48];
    std::snprintf(value, sizeof value, "%.10g", figure.value);
    text += std::string(&figure == d.figures.data() ? " (" : ", ") + figure.name + " " + value;
  }
  if (!d.figures.empty()) text += ")";
  return text + (d.reason.empty() ? "" : "; " + d.reason);
}

}  // namespace lanewise
