#include "tests/stability/curve.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

namespace lanewise::test {
namespace {

double worst(const std::vector<CurvePoint>& points, double CurvePoint::*error) {
  double result = 0;
  for (const CurvePoint& p : points) take_worst(result, p.*error);
  return result;
}

}  // namespace

double Curve::worst_naive() const { return worst(points, &CurvePoint::naive); }
double Curve::worst_ours() const { return worst(points, &CurvePoint::ours); }

void take_worst(double& worst, double error) {
  if (!(error <= worst)) worst = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

std::vector<double> log_spaced(double first, double last, int n) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(first * std::pow(last / first, i / (n - 1.0)));
  return values;
}

void record(const Curve& curve) {
  const char* path = std::getenv("LANEWISE_STABILITY_CURVES");
  if (!path) return;
  nlohmann::ordered_json json = {{"name", curve.name},     {"title", curve.title},
                                 {"naive", curve.naive},   {"ours", curve.ours},
                                 {"x_axis", curve.x_axis}, {"y_axis", curve.y_axis},
                                 {"log_x", curve.log_x},   {"points", nlohmann::ordered_json::array()}};
  // JSON has no infinity: null stands for it, and for NaN.
  for (const CurvePoint& p : curve.points) json["points"].push_back({p.x, p.naive, p.ours});
  std::ofstream(path, std::ios::app) << json.dump() << "\n";
}

}  // namespace lanewise::test
