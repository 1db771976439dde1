#include "core/verify/exact_functions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lanewise::verify {
namespace {

// Reduced to an eighth of a turn, exactly: near its zeros the sine of a rounded 2 pi u means nothing.
double sin2pi(double u) {
  const double quarter = std::round(4 * u), x = (u - quarter / 4) * 2 * std::numbers::pi;
  switch (static_cast<int>(quarter) & 3) {
    case 0:
      return std::sin(x);
    case 1:
      return std::cos(x);
    case 2:
      return -std::sin(x);
    default:
      return -std::cos(x);
  }
}

double cos2pi(double u) { return sin2pi(u < 0.75 ? u + 0.25 : u - 0.75); }

double atan_turns(double x) { return std::atan(x) / (2 * std::numbers::pi); }

double exp_or_0(double x) { return x < -87.3365f ? 0 : std::exp(x); }

// The square of a float is exact.
double erfcx(double x) { return std::exp(x * x) * std::erfc(x); }

// Halley's method, with erf near the center and erfc in the tails, where each keeps its digits.
double erf_inv_centered(double u) {
  const double x = std::abs(2 * u - 1), tail = 2 * std::min(u, 1 - u);
  // Winitzki's approximation (A handy approximation for the error function, 2008), good to 2e-3: two steps leave nothing.
  constexpr double kA = 0.147;
  const double log = std::log(tail * (2 - tail)), half = 2 / (std::numbers::pi * kA) + log / 2;
  double y = std::sqrt(std::max(std::sqrt(half * half - log / kA) - half, 0.0));
  for (int step = 0; step < 3; ++step) {
    const double excess = x < 0.5 ? std::erf(y) - x : tail - std::erfc(y);
    const double newton = excess * std::exp(y * y) * std::sqrt(std::numbers::pi) / 2;
    y -= newton / (1 + y * newton);
  }
  return u < 0.5 ? -y : y;
}

}  // namespace

ExactFunction exact_function(Function f) {
  switch (f) {
    case Function::kSin2Pi:
      return sin2pi;
    case Function::kCos2Pi:
      return cos2pi;
    case Function::kAtanTurns:
      return atan_turns;
    case Function::kExp:
      return exp_or_0;
    case Function::kLog:
      return std::log;
    case Function::kErfcx:
      return erfcx;
    case Function::kErfInvCentered:
      return erf_inv_centered;
  }
  return nullptr;
}

double fresnel_equations(double c, std::complex<double> index) {
  const std::complex<double> cos_t = std::sqrt(1.0 - (1 - c * c) / (index * index));
  const std::complex<double> rs = (c - index * cos_t) / (c + index * cos_t);
  const std::complex<double> rp = (index * c - cos_t) / (index * c + cos_t);
  return (std::norm(rs) + std::norm(rp)) / 2;
}

}  // namespace lanewise::verify
