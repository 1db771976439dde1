// Charts as SVG, 380 units wide: drawn for columns of about that many pixels.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace lanewise {

// For text in HTML, SVG and their attributes.
std::string escape(const std::string& text);

struct Axis {
  std::string title;  // with the unit
  double max = 0;     // the axis ends at a round number above it; a logarithmic one begins at 1
  bool logarithmic = false;
  bool whole = false;  // counts something: no ticks between whole numbers
};

struct Bar {
  double length = 0;
  std::string colour;
  std::string hint;  // shown where the mouse rests
};

// What one row of a chart shows, all on the same axis: bars end to end, dots, and the five numbers of a box (least, quartiles,
// most).
struct ChartRow {
  std::string name;
  std::vector<Bar> bars{};
  std::vector<Bar> dots{};
  std::vector<double> box{};
  std::string box_hint{};
};

std::string row_chart(const Axis& axis, const std::vector<ChartRow>& rows);

// Points joined by a line, and a dashed line of what would be ideal.
std::string line_chart(const Axis& x, const Axis& y, const std::vector<std::pair<double, double>>& points,
                       const std::vector<std::pair<double, double>>& ideal);

}  // namespace lanewise
