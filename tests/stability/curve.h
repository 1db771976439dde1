// What a stability test measures: how far the naive form and ours are off, against the parameter that breaks the naive one.
// The test checks the numbers; the stability page (perf/stability_page.py) draws the same ones.
#pragma once

#include <string>
#include <vector>

namespace lanewise::test {

struct CurvePoint {
  double x;
  double naive;  // error of the form that fails, >= 0
  double ours;   // error of the form that the renderer uses, >= 0
};

struct Curve {
  std::string name;    // of the failure mode, fit for a file name: "beckmann-tan2"
  std::string title;   // what goes wrong, in a line
  std::string naive;   // the form that fails, for the legend
  std::string ours;    // the form in use, for the legend
  std::string x_axis;  // quantity (unit)
  std::string y_axis;  // quantity of both errors (unit)
  bool log_x = true;
  std::vector<CurvePoint> points = {};

  double worst_naive() const;  // NaN counts as infinite, here and below
  double worst_ours() const;
};

// Raises the worst error so far; NaN counts as infinite.
void take_worst(double& worst, double error);

// n values from first to last, evenly spaced on a log axis.
std::vector<double> log_spaced(double first, double last, int n);

// Hands the curve to the stability page: appends it as a line of JSON to the file that $LANEWISE_STABILITY_CURVES names, if
// it names one.
void record(const Curve& curve);

}  // namespace lanewise::test
