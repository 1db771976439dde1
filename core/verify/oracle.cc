#include "core/verify/oracle.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "core/verify/ulp.h"

namespace lanewise::verify {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMovesTried = 400;

double length(const double* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// The largest coordinate of anything in the plan.
double reach_of(const Plan& plan) {
  double reach = 0;
  const auto add = [&](const float* v, size_t n) {
    for (size_t i = 0; i < n; ++i) reach = std::max(reach, double{std::abs(v[i])});
  };
  for (const FlatTriangle& t : plan.flat_triangles) add(t.v[0], 9);
  for (const FlatQuad& q : plan.flat_quads) add(&q.distance, 1);
  for (uint32_t i = plan.triangles; i < plan.triangles + plan.spheres && !plan.prim_shape.empty(); ++i) {
    const float* sphere = &plan.prim_shape[size_t{4} * i];
    for (int a = 0; a < 3; ++a) reach = std::max(reach, double{std::abs(sphere[a])} + sphere[3]);
  }
  for (const Bvh* tree : {&plan.triangle_tree, &plan.sphere_tree}) {
    if (!tree->nodes.empty()) add(tree->bounds.lo, 6);
  }
  return reach;
}

double change(double a, double b) {
  const double difference = std::abs(a - b);
  return std::isfinite(difference) ? difference : kInfinity;
}

}  // namespace

// In a handful of paths one or two say nothing about a share.
bool Tally::choices_within_bound() const {
  return static_cast<double>(moved) <= choice.max_share * static_cast<double>(paths) + 2;
}

void Tally::add(const Tally& other) {
  for (size_t f = 0; f < fields.size(); ++f) {
    fields[f].max = std::max(fields[f].max, other.fields[f].max);
    fields[f].sum += other.fields[f].sum;
  }
  paths += other.paths;
  moved += other.moved;
  failed += other.failed;
  changed += other.changed;
  if (first_failure.empty()) first_failure = other.first_failure;
}

Oracle::Group Oracle::find_group(const std::string& name) {
  for (size_t i = 0; i < kFieldCount; ++i) {
    if (name == kFields[i].name) return {i, 1, false};
    if (name + "_x" == kFields[i].name) return {i, 3, true};
    if (name + "_r" == kFields[i].name) return {i, 3, false};
  }
  throw std::logic_error("no field " + name);
}

Oracle::Oracle(const Plan& plan, const KernelCase& kernel) : plan_(plan), kernel_(kernel), plan_reach_(reach_of(plan)) {
  for (const FieldBound& bound : kernel.bounds.fields) {
    if (bound.field) measured_.push_back({bound, find_group(bound.field)});
  }
  std::istringstream inputs(kernel.inputs);
  for (std::string name; inputs >> name;) inputs_.push_back(find_group(name));
}

Tally Oracle::tally() const {
  Tally tally;
  tally.choice = kernel_.bounds.choice;
  for (const Measured& m : measured_) tally.fields.push_back({m.bound, 0, 0});
  return tally;
}

FieldValues Oracle::twin(const FieldValues& before, const Step& step) const {
  Path<double> p = path_of<double>(before, step);
  kernel_.twin(plan_, p);
  return measured_values(p);
}

template <class T>
FieldValues Oracle::measured_values(const Path<T>& p) const {
  FieldValues values = values_of(p);
  for (const Measured& m : measured_) {
    double& value = values[m.group.first];
    if (m.bound.unit == Unit::kInverseInputUlp && value != 0) value = 1 / value;
  }
  return values;
}

double Oracle::reach(const FieldValues& before) const {
  static const size_t o = find_group("o").first;
  return std::max({plan_reach_, std::abs(before[o]), std::abs(before[o + 1]), std::abs(before[o + 2])});
}

std::vector<Oracle::Move> Oracle::moves(const FieldValues& before) const {
  static const size_t o = find_group("o").first;
  std::vector<Move> result;
  for (const Group& g : inputs_) {
    for (size_t i = g.first; i < g.first + g.count; ++i) {
      if (!g.vector && before[i] == 0) continue;
      const double size = g.first == o ? reach(before) : length(&before[g.first]);
      result.push_back({i, g.vector ? kVectorUlp * size : ulp(before[i])});
    }
  }
  return result;
}

// Each input moves up and down, and the larger change counts; but one that a step of half the size does not lessen comes from
// an edge that was crossed, and then the other side tells how the value hangs on the input.
FieldValues Oracle::slack(const FieldValues& before, const FieldValues& value, const Step& step) const {
  FieldValues slack{};
  for (const Move& move : moves(before)) {
    const auto beside = [&](double ulps) {
      FieldValues inputs = before;
      inputs[move.field] += ulps * move.ulp;
      return twin(inputs, step);
    };
    const FieldValues up = beside(1), down = beside(-1);
    for (const Measured& m : measured_) {
      for (size_t i = m.group.first; i < m.group.first + m.group.count; ++i) {
        if (!kFields[i].is_float) continue;
        const double rise = change(up[i], value[i]), fall = change(down[i], value[i]);
        double most = std::max(rise, fall);
        if (most > 4 * std::min(rise, fall)) {
          const double half = change(beside(rise > fall ? 0.5 : -0.5)[i], value[i]);
          if (half > 0.8 * most) most = std::min(rise, fall);
        }
        if (most < kInfinity) slack[i] += most;
      }
    }
  }
  return slack;
}

Expected Oracle::expect(const Path<float>& before) const {
  const FieldValues values = values_of(before);
  Expected expected{twin(values, before.step), {}};
  const auto hangs = [](const Measured& m) { return m.bound.unit >= Unit::kInputUlp; };
  if (std::any_of(measured_.begin(), measured_.end(), hangs)) {
    expected.slack = slack(values, expected.value, before.step);
  }
  return expected;
}

// In the bound's unit, the error beyond `extra` times the slack.
double Oracle::error(const Measured& m, double reach, const Expected& expected, const FieldValues& got,
                     double extra) const {
  const Group& g = m.group;
  const auto in_units = [&](double off, double ulp, double slack) {
    if (off <= m.bound.negligible) return 0.0;
    const double unit = m.bound.unit == Unit::kReachUlp   ? kVectorUlp * reach
                        : m.bound.unit >= Unit::kInputUlp ? ulp + slack
                                                          : ulp;
    const double error = std::max(off - extra * slack, 0.0) / unit;
    return std::isnan(error) ? kInfinity : error;
  };
  const double* want = &expected.value[g.first];
  const double* have = &got[g.first];
  if (g.vector && m.bound.unit != Unit::kExact) {
    const double off[3] = {have[0] - want[0], have[1] - want[1], have[2] - want[2]};
    return in_units(length(off), kVectorUlp * length(want), length(&expected.slack[g.first]));
  }
  double worst = 0;
  for (size_t i = 0; i < g.count; ++i) {
    const bool to_float = m.bound.unit == Unit::kExact && kFields[g.first + i].is_float && extra == 0;
    const double target = to_float ? double{static_cast<float>(want[i])} : want[i];
    const double off = have[i] == target ? 0 : std::abs(have[i] - target);
    worst = std::max(worst, in_units(off, ulp(target), expected.slack[g.first + i]));
  }
  return worst;
}

// Whether the twin, for inputs moved by no more than the margin, makes what the kernel made, and jumps in between.
bool Oracle::moved(const FieldValues& before, const Step& step, const Expected& expected,
                   const FieldValues& got) const {
  const double margin = kernel_.bounds.choice.margin;
  const char* decisive = kernel_.bounds.choice.decisive;
  if (margin == 0) return false;
  const std::vector<Move> all = moves(before);
  std::mt19937 rng(12345);
  std::uniform_real_distribution<double> side(-margin, margin);
  for (int attempt = 0; attempt < kMovesTried; ++attempt) {
    FieldValues beside = before;
    for (const Move& move : all) beside[move.field] += side(rng) * move.ulp;
    Expected there{twin(beside, step), {}};
    there.slack = slack(beside, there.value, step);
    const auto agree = [&](const Measured& m) {
      return (decisive && std::strcmp(m.bound.field, decisive) != 0) ||
             error(m, reach(before), there, got, margin) <= std::max(m.bound.max, 1.0);
    };
    if (std::all_of(measured_.begin(), measured_.end(), agree)) {
      // It must be a choice, not more of the same error: the twin jumps on the way, further than its slack explains.
      bool jumps = false;
      for (const Measured& m : measured_) {
        for (size_t i = m.group.first; i < m.group.first + m.group.count; ++i) {
          const double explained = 2 * margin * std::max(expected.slack[i], there.slack[i]) + ulp(expected.value[i]);
          jumps |= !(std::abs(there.value[i] - expected.value[i]) <= explained);
          jumps |= !m.group.vector && (there.value[i] == 0) != (expected.value[i] == 0);
        }
      }
      if (jumps) return true;
    }
  }
  return false;
}

const char* Oracle::changed(const FieldValues& before, const FieldValues& got) const {
  for (size_t i = 0; i < kFieldCount; ++i) {
    if (std::bit_cast<uint64_t>(before[i]) == std::bit_cast<uint64_t>(got[i])) continue;
    const auto has = [i](const Measured& m) { return i >= m.group.first && i < m.group.first + m.group.count; };
    if (std::none_of(measured_.begin(), measured_.end(), has)) return kFields[i].name;
  }
  return nullptr;
}

void Oracle::compare(const Path<float>& before, const Expected& expected, const Path<float>& got, Tally& tally) const {
  const FieldValues in = values_of(before), out = measured_values(got);
  const double reach = this->reach(in);
  double errors[KernelBounds::kMost];
  bool within = true;
  for (size_t f = 0; f < measured_.size(); ++f) {
    errors[f] = error(measured_[f], reach, expected, out, 0);
    within &= errors[f] <= measured_[f].bound.max;
  }
  ++tally.paths;
  if (const char* field = changed(in, values_of(got))) {
    ++tally.changed;
    if (tally.failed++ == 0) tally.first_failure = std::string(field) + " changed, and has no bound";
    return;
  }
  if (!within && moved(in, before.step, expected, out)) {
    ++tally.moved;
    return;
  }
  for (size_t f = 0; f < measured_.size(); ++f) {
    tally.fields[f].max = std::max(tally.fields[f].max, errors[f]);
    tally.fields[f].sum += errors[f];
  }
  if (within) return;
  if (tally.failed++ > 0) return;
  std::ostringstream text;
  text.precision(9);
  for (size_t f = 0; f < measured_.size(); ++f) {
    const Measured& m = measured_[f];
    if (errors[f] <= m.bound.max) continue;
    text << m.bound.field << " is off by " << errors[f] << ":";
    for (size_t i = m.group.first; i < m.group.first + m.group.count; ++i) {
      text << " " << kFields[i].name << " " << out[i] << ", the twin's " << expected.value[i] << ";";
    }
  }
  text << " of";
  for (size_t i = 0; i < kFieldCount; ++i) text << " " << kFields[i].name << " " << in[i];
  tally.first_failure = text.str();
}

}  // namespace lanewise::verify
