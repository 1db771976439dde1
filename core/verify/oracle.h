// What a kernel must make of a path, by its twin in double precision, and how far a result is from that.
#pragma once

#include <string>
#include <vector>

#include "core/verify/fields.h"
#include "core/verify/kernel_case.h"

namespace lanewise::verify {

struct Expected {
  FieldValues value;  // the twin's
  FieldValues slack;  // what they change by when the inputs move by one ulp each
};

// The errors of many results of one kernel.
struct FieldErrors {
  FieldBound bound;
  double max = 0;  // in the bound's unit; NaN counts as infinite
  double sum = 0;
};
struct Tally {
  std::vector<FieldErrors> fields;
  ChoiceBound choice;
  uint64_t paths = 0;
  uint64_t moved = 0;  // made another choice, as the twin does beside; not in the errors
  uint64_t failed = 0;
  uint64_t changed = 0;       // of the failed: those in which a field changed its bits that has no bound
  std::string first_failure;  // of the first that failed: field, values, and the path

  void add(const Tally& other);
  bool choices_within_bound() const;
};

class Oracle {
 public:
  Oracle(const Plan& plan, const KernelCase& kernel);

  Expected expect(const Path<float>& before) const;
  Tally tally() const;  // of nothing yet
  // Compares what the kernel made of `before` with what is expected.
  void compare(const Path<float>& before, const Expected& expected, const Path<float>& got, Tally& tally) const;

 private:
  // A field of the path, or a vector of three.
  struct Group {
    size_t first, count;
    bool vector;
  };
  struct Measured {
    FieldBound bound;
    Group group;
  };
  struct Move {
    size_t field;
    double ulp;
  };

  static Group find_group(const std::string& name);
  std::vector<Move> moves(const FieldValues& before) const;
  template <class T>
  FieldValues measured_values(const Path<T>& p) const;
  FieldValues twin(const FieldValues& before, const Step& step) const;
  FieldValues slack(const FieldValues& before, const FieldValues& value, const Step& step) const;
  double reach(const FieldValues& before) const;
  double error(const Measured& m, double reach, const Expected& expected, const FieldValues& got, double extra) const;
  // The first field without a bound whose bits differ, or null.
  const char* changed(const FieldValues& before, const FieldValues& got) const;
  bool moved(const FieldValues& before, const Step& step, const Expected& expected, const FieldValues& got) const;

  const Plan& plan_;
  const KernelCase& kernel_;
  double plan_reach_;
  std::vector<Measured> measured_;
  std::vector<Group> inputs_;
};

}  // namespace lanewise::verify
