#include "perf/studied_functions.h"

#include <cmath>
#include <numbers>

#include "core/verify/exact_functions.h"
#include "kernels/functions.h"
#include "kernels/reference/fresnel.h"
#include "kernels/reference/microfacet.h"
#include "perf/vector_variants.h"

namespace lanewise {
namespace {

using std::numbers::pi_v;

// f: a generic lambda of one floating-point number.
template <class T, class F>
ArrayFunction one_by_one(F f) {
  return [f](const float* x, float* y, size_t n) {
    for (size_t i = 0; i < n; ++i) y[i] = static_cast<float>(f(T{x[i]}));
  };
}

ArrayFunction vectors_of(Function f) {
  return [f](const float* x, float* y, size_t n) { apply_function(f, x, y, n); };
}
ArrayFunction vectors_of(VectorVariant f) {
  return [f](const float* x, float* y, size_t n) { apply_variant(f, x, y, n); };
}

FunctionVariant highway(VectorVariant f) { return {"Highway", vectors_of(f), {}, {}}; }

// The scalar twins' way.
template <class F>
FunctionVariant twin(F f) {
  return {"twin", {}, one_by_one<float>(f), one_by_one<double>(f)};
}
template <class F>
FunctionVariant with_twin(const std::string& name, VectorVariant vectors, F f) {
  return {name, vectors_of(vectors), one_by_one<float>(f), one_by_one<double>(f)};
}

// A function of kernels/functions.h, timed on [lo, hi).
StudiedFunction elementary(Function f, const std::string& name, const std::string& inputs, float lo, float hi,
                           std::vector<FunctionVariant> others) {
  const FunctionInfo& info = kFunctions[static_cast<size_t>(f)];
  others.insert(others.begin(), {"Lanewise", vectors_of(f), {}, {}});
  // Below -87.3365 ours is 0 where others are subnormal.
  const float least = f == Function::kExp ? info.hard : info.lo;
  return {name, {inputs, least, info.hi, info.hard, lo, hi}, verify::exact_function(f), std::move(others)};
}

template <Fresnel model>
FunctionVariant glass(const std::string& name, VectorVariant vectors, float n_i, float n_t) {
  return with_twin(name, vectors, [=]<class T>(T c) {
    return reference::fresnel_dielectric<T>(model, c, T{opaque(n_i)}, T{opaque(n_t)}).reflectance;
  });
}

template <Fresnel model>
FunctionVariant gold(const std::string& name, VectorVariant vectors) {
  return with_twin(name, vectors, []<class T>(T c) {
    return reference::fresnel_conductor<T>(model, c, T{opaque(kGoldEta)}, T{opaque(kGoldK)});
  });
}

double exact_beckmann(double sine) {
  const double tan2 = sine * sine / ((1 - sine) * (1 + sine)), alpha2 = double{kPolished} * double{kPolished};
  return std::exp(-tan2 / alpha2) * (1 + tan2) * (1 + tan2) / (pi_v<double> * alpha2);
}

using V = VectorVariant;

std::vector<StudiedFunction> elementary_functions() {
  const auto exp = [](auto x) { return std::exp(x); };
  const auto log = [](auto x) { return std::log(x); };
  const auto sin = [](auto x) { return std::sin(x); };
  const auto cos = [](auto x) { return std::cos(x); };
  const auto sin_2pi = []<class T>(T u) { return std::sin(2 * pi_v<T> * u); };
  const auto cos_2pi = []<class T>(T u) { return std::cos(2 * pi_v<T> * u); };
  const auto erfcx = [](auto x) { return std::exp(x * x) * std::erfc(x); };
  const auto erf_inv = []<class T>(T u) { return reference::visible_slope(reference::SlopeView<T>(1, 0, 1), u); };
  constexpr float kPi = pi_v<float>;
  return {
      elementary(Function::kExp, "exp x", "x", -20, 0, {highway(V::kHighwayExp), twin(exp)}),
      elementary(Function::kLog, "ln x", "x", 0x1p-24f, 1, {highway(V::kHighwayLog), twin(log)}),
      elementary(Function::kSin2Pi, "sin 2πu", "u", 0, 1, {highway(V::kHighwaySin2Pi), twin(sin_2pi)}),
      elementary(Function::kCos2Pi, "cos 2πu", "u", 0, 1, {highway(V::kHighwayCos2Pi), twin(cos_2pi)}),
      {"sin x", {"x", 0, 2 * kPi, kPi, 0, 2 * kPi}, sin, {highway(V::kHighwaySin), twin(sin)}},
      {"cos x", {"x", 0, 2 * kPi, kPi / 2, 0, 2 * kPi}, cos, {highway(V::kHighwayCos), twin(cos)}},
      elementary(Function::kErfcx, "exp(x²) erfc x", "x", 0, 3, {twin(erfcx)}),
      elementary(Function::kErfInvCentered, "erf⁻¹(2u − 1)", "u", 0x1p-24f, 1, {twin(erf_inv)}),
  };
}

std::vector<StudiedFunction> shading_functions() {
  const auto into_glass = [](double c) { return verify::fresnel_equations(c, kGlass); };
  const auto out_of_glass = [](double c) { return verify::fresnel_equations(c, 1 / double{kGlass}); };
  const auto on_gold = [](double c) { return verify::fresnel_equations(c, {kGoldEta, kGoldK}); };
  const auto beckmann = []<class T>(T s) {
    const T z = std::sqrt(1 - s * s);
    return reference::beckmann_d<T>(s * s / (z * z), T{opaque(kPolished)});
  };
  const auto naive_beckmann = []<class T>(T s) {
    const T z = std::sqrt(1 - s * s);
    return reference::beckmann_d<T>((1 - z * z) / (z * z), T{opaque(kPolished)});
  };
  // Total reflection begins at a cosine of 0.7454, about which one ulp of the cosine decides.
  constexpr float kRefracted = 0.7464f, kFourAlpha = 4 * kPolished;
  return {
      {"Fresnel, into glass",
       {"cosine", 0, 1, 0, 0, 1},
       into_glass,
       {glass<Fresnel::kExact>("exact", V::kIntoGlassExact, 1, kGlass),
        glass<Fresnel::kSchlick>("Schlick", V::kIntoGlassSchlick, 1, kGlass),
        glass<Fresnel::kCourse>("course", V::kIntoGlassCourse, 1, kGlass)}},
      {"Fresnel, out of glass",
       {"cosine, from 0.001 above that of total reflection", kRefracted, 1, kRefracted, 0, 1},
       out_of_glass,
       {glass<Fresnel::kExact>("exact", V::kOutOfGlassExact, kGlass, 1),
        glass<Fresnel::kSchlick>("Schlick", V::kOutOfGlassSchlick, kGlass, 1),
        glass<Fresnel::kCourse>("course", V::kOutOfGlassCourse, kGlass, 1)}},
      {"Fresnel, gold",
       {"cosine", 0, 1, 0, 0, 1},
       on_gold,
       {gold<Fresnel::kExact>("exact", V::kGoldExact), gold<Fresnel::kSchlick>("Schlick", V::kGoldSchlick),
        gold<Fresnel::kCourse>("course", V::kGoldCourse)}},
      {"Beckmann's D, α = 0.01",
       {"sine of the half vector's angle", 0, kFourAlpha, 0, 0, kFourAlpha},
       exact_beckmann,
       {with_twin("tan² of its parts", V::kBeckmannStable, beckmann),
        with_twin("tan² of its cosine", V::kBeckmannNaive, naive_beckmann)}},
  };
}

}  // namespace

std::vector<StudiedFunction> studied_functions() {
  std::vector<StudiedFunction> all = elementary_functions();
  for (StudiedFunction& f : shading_functions()) all.push_back(std::move(f));
  return all;
}

}  // namespace lanewise
