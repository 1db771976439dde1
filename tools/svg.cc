#include "tools/svg.h"

#include <algorithm>
#include <cmath>

#include "tools/text.h"

namespace lanewise {
namespace {

constexpr double kWidth = 380, kLabels = 112, kRight = 14, kRow = 22, kAxis = 38, kTop = 6;
constexpr const char* kInk = "#333";

std::string text_at(double x, double y, const char* anchor, const std::string& text) {
  return print("<text x='%.1f' y='%.1f' text-anchor='%s'>%s</text>", x, y, anchor, escape(text).c_str());
}

std::string line(double x0, double y0, double x1, double y1, const char* colour) {
  return print("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='%s'/>", x0, y0, x1, y1, colour);
}

std::string hint(const std::string& text) { return text.empty() ? "" : "<title>" + escape(text) + "</title>"; }

// A tenth, fifth or half of a power of ten, or the like, so that some four of it cover the range.
double tick_step(double max) {
  const double rough = std::max(max, 1e-12) / 4, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double step : {1.0, 2.0, 2.5, 5.0}) {
    if (step * power >= rough * 0.999) return step * power;
  }
  return 10 * power;
}

// From values to a stretch of the picture.
class Scale {
 public:
  Scale(const Axis& axis, double from, double to) : logarithmic_(axis.logarithmic), from_(from), to_(to) {
    if (logarithmic_) {
      const double decades = std::max(1.0, std::ceil(std::log10(std::max(axis.max, 1.0)) - 1e-9));
      max_ = decades;
      for (double d = 0; d <= decades; ++d) ticks_.push_back(std::pow(10, d));
    } else {
      const double step = std::max(tick_step(axis.max), axis.whole ? 1.0 : 0.0);
      const double steps = std::max(1.0, std::ceil(axis.max / step - 1e-9));
      max_ = steps * step;
      for (double i = 0; i <= steps; ++i) ticks_.push_back(i * step);
    }
  }

  double operator()(double value) const {
    const double v = logarithmic_ ? std::log10(std::max(value, 1.0)) : value;
    return from_ + (to_ - from_) * v / max_;
  }
  const std::vector<double>& ticks() const { return ticks_; }

 private:
  bool logarithmic_;
  double from_, to_, max_ = 1;
  std::vector<double> ticks_;
};

std::string begin(double height, const std::string& name) {
  return print("<svg viewBox='0 0 %.0f %.0f' role='img' aria-label='%s'>\n", kWidth, height, escape(name).c_str());
}

std::string x_axis(const Scale& x, const Axis& axis, double left, double bottom) {
  std::string svg;
  for (const double tick : x.ticks()) {
    svg += line(x(tick), kTop, x(tick), bottom, "#e4e4e4") + text_at(x(tick), bottom + 14, "middle", short_count(tick));
  }
  return svg + text_at((left + kWidth - kRight) / 2, bottom + 31, "middle", axis.title) + "\n";
}

std::string box(const Scale& x, const ChartRow& row, double y) {
  const std::vector<double>& b = row.box;
  const double middle = y + kRow / 2;
  return "<g>" + hint(row.box_hint) + line(x(b[0]), middle, x(b[4]), middle, "#888") +
         line(x(b[0]), middle - 4, x(b[0]), middle + 4, "#888") +
         line(x(b[4]), middle - 4, x(b[4]), middle + 4, "#888") +
         print("<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' fill='#9ecae1' stroke='#3182bd'/>", x(b[1]), y + 5,
               std::max(1.0, x(b[3]) - x(b[1])), kRow - 10) +
         print("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#08306b' stroke-width='2.5'/></g>\n", x(b[2]),
               y + 4, x(b[2]), y + kRow - 4);
}

}  // namespace

std::string escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string row_chart(const Axis& axis, const std::vector<ChartRow>& rows) {
  const double bottom = kTop + kRow * static_cast<double>(rows.size());
  const Scale x(axis, kLabels, kWidth - kRight);
  std::string svg = begin(bottom + kAxis, axis.title) + x_axis(x, axis, kLabels, bottom);
  double y = kTop;
  for (const ChartRow& row : rows) {
    svg += text_at(kLabels - 9, y + 15, "end", row.name);
    double from = 0;
    for (const Bar& bar : row.bars) {
      svg += print("<rect x='%.2f' y='%.1f' width='%.2f' height='%.1f' fill='%s'>", x(from), y + 4,
                   std::max(0.0, x(from + bar.length) - x(from)), kRow - 8, bar.colour.c_str()) +
             hint(bar.hint) + "</rect>";
      from += bar.length;
    }
    for (const Bar& dot : row.dots) {
      svg += print("<circle cx='%.1f' cy='%.1f' r='4.5' fill='%s' stroke='#fff' stroke-width='0.8'>", x(dot.length),
                   y + kRow / 2, dot.colour.c_str()) +
             hint(dot.hint) + "</circle>";
    }
    if (row.box.size() == 5) svg += box(x, row, y);
    svg += "\n";
    y += kRow;
  }
  return svg + line(kLabels, kTop, kLabels, bottom, kInk) + "</svg>\n";
}

std::string line_chart(const Axis& x_axis_of, const Axis& y_axis_of,
                       const std::vector<std::pair<double, double>>& points,
                       const std::vector<std::pair<double, double>>& ideal) {
  constexpr double kLeft = 46, kBottom = 216;
  const Scale x(x_axis_of, kLeft, kWidth - kRight), y(y_axis_of, kBottom, kTop + 6);
  std::string svg = begin(kBottom + kAxis, y_axis_of.title) + x_axis(x, x_axis_of, kLeft, kBottom);
  for (const double tick : y.ticks()) {
    svg += line(kLeft, y(tick), kWidth - kRight, y(tick), "#e4e4e4") +
           text_at(kLeft - 5, y(tick) + 4, "end", short_count(tick));
  }
  svg += print("<text transform='translate(12 %.0f) rotate(-90)' text-anchor='middle'>%s</text>\n", kBottom / 2,
               escape(y_axis_of.title).c_str());
  const auto path = [&](const std::vector<std::pair<double, double>>& line_points, const char* style) {
    std::string d;
    for (const auto& [px, py] : line_points) d += print("%s%.1f %.1f", d.empty() ? "M" : "L", x(px), y(py));
    return print("<path d='%s' fill='none' %s/>\n", d.c_str(), style);
  };
  svg += path(ideal, "stroke='#999' stroke-dasharray='4 4'") + path(points, "stroke='#3182bd' stroke-width='2'");
  for (const auto& [px, py] : points) {
    svg += print("<circle cx='%.1f' cy='%.1f' r='4.5' fill='#3182bd'>", x(px), y(py)) +
           hint(print("%g: %.3g", px, py)) + "</circle>";
  }
  return svg + line(kLeft, kTop, kLeft, kBottom, kInk) + line(kLeft, kBottom, kWidth - kRight, kBottom, kInk) +
         "</svg>\n";
}

}  // namespace lanewise
