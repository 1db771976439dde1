#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/types.h"
#include "core/verify/function_study.h"
#include "core/verify/verify.h"
#include "core/isa.h"
#include "tools/commands.h"
#include "tools/flags.h"
#include "tools/progress.h"
#include "tools/text.h"

namespace lanewise {
namespace {

constexpr const char* kFooter =
    "Errors are largest, and in parentheses mean, over paths that are hard on purpose, each counted in its unit:\n"
    "  exact      the twin's value, rounded to float, to the bit\n"
    "  ulp        spacing of floats at the twin's value; of a vector, 2^-23 of its length\n"
    "  reach ulp  2^-23 of the scene's largest coordinate\n"
    "  input ulp  an ulp, and what the twin's value changes by when the inputs move by an ulp\n"
    "  share      of paths with another choice (hit, side, lobe) than the twin's, but one that it makes a few ulps "
    "beside\n"
    "The bounds are in kernels/kernels.h and kernels/functions.h. Exits with 1 if one does not hold.\n\n"
    "Examples:\n"
    "  lanewise verify                              every kernel and function on every instruction set here\n"
    "  lanewise verify --isa avx2 --paths 1000000   one of them, with more paths\n"
    "  lanewise verify --exhaustive > functions.md  every function on every float: minutes";

struct VerifyCommandOptions {
  std::string isa;
  uint32_t paths = 1 << 15;
  uint32_t seed = 0;
  uint32_t threads = 0;
  bool exhaustive = false;
  bool json = false;
};

// One line of the table: a field of a kernel, the share of its choices, or a function.
struct Row {
  std::string kernel, field, unit, target;
  double max = 0, mean = 0, bound = 0;
  bool holds = true;
};

const char* unit_name(Unit unit) {
  switch (unit) {
    case Unit::kExact:
      return "exact";
    case Unit::kUlp:
      return "ulp";
    case Unit::kReachUlp:
      return "reach ulp";
    case Unit::kInputUlp:
      return "input ulp";
    case Unit::kInverseInputUlp:
      return "input ulp of 1/x";
  }
  return "";
}

std::vector<Row> rows_of(const std::vector<verify::KernelResult>& results) {
  std::vector<Row> rows;
  for (const verify::KernelResult& r : results) {
    const verify::Tally& t = r.tally;
    const double compared = static_cast<double>(std::max<uint64_t>(t.paths - t.moved, 1));
    for (const verify::FieldErrors& f : t.fields) {
      rows.push_back({r.name, f.bound.field, unit_name(f.bound.unit), r.target, f.max, f.sum / compared, f.bound.max,
                      f.max <= f.bound.max});
    }
    if (t.changed > 0) {
      const double changed = static_cast<double>(t.changed);
      rows.push_back({r.name, "others", "exact", r.target, changed, changed / compared, 0, false});
    }
    if (t.choice.max_share == 0) continue;
    const double share = static_cast<double>(t.moved) / static_cast<double>(std::max<uint64_t>(t.paths, 1));
    rows.push_back({r.name, "choice", "share", r.target, share, share, t.choice.max_share, t.choices_within_bound()});
  }
  return rows;
}

std::vector<Row> rows_of(const std::vector<verify::FunctionError>& results) {
  std::vector<Row> rows;
  for (const verify::FunctionError& r : results) {
    rows.push_back(
        {r.function->name, "value", "ulp", r.target, r.max_error, r.mean_error, r.function->max_ulp, r.within_bound()});
  }
  return rows;
}

// JSON has no infinity: such an error becomes null.
nlohmann::ordered_json json_of(const Row& row) {
  return {{"kernel", row.kernel},   {"target", row.target}, {"field", row.field}, {"max_error", row.max},
          {"mean_error", row.mean}, {"unit", row.unit},     {"bound", row.bound}};
}

// The rows of all targets side by side; a kernel's name only in its first line.
std::string table(const std::vector<Row>& rows, const std::vector<std::string>& targets) {
  std::string text = print("%-18s %-7s %-17s %8s", "kernel", "field", "unit", "bound");
  for (const std::string& target : targets) text += print("  %18s", target.c_str());
  text += "\n";
  std::string last;
  for (const Row& row : rows) {
    if (row.target != targets[0]) continue;
    text += print("%-18s %-7s %-17s %8.4g", row.kernel == last ? "" : row.kernel.c_str(), row.field.c_str(),
                  row.unit.c_str(), row.bound);
    last = row.kernel;
    for (const std::string& target : targets) {
      for (const Row& other : rows) {
        if (other.target != target || other.kernel != row.kernel || other.field != row.field) continue;
        text += print("  %8.3g (%7.2g)%s", other.max, other.mean, other.holds ? " " : "!");
      }
    }
    text += "\n";
  }
  return text;
}

std::string functions_page(const std::vector<verify::FunctionError>& errors) {
  std::string page =
      "# Elementary functions against double precision, on every float\n\n"
      "Every float of each domain, on every instruction set of the machine. Errors in ulp: spacings of floats at the "
      "exact\n"
      "value. Made by `lanewise verify --exhaustive`; bounds from kernels/functions.h.\n\n"
      "| function | domain | target | inputs | max ulp | mean ulp | worst input | bound |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const verify::FunctionError& e : errors) {
    const FunctionInfo& f = *e.function;
    page += print("| `%s` | [%.9g, %.9g] | %s | %llu | %.3f | %.4f | %.9g (%a) | %g |\n", f.name, f.lo, f.hi,
                  e.target.c_str(), static_cast<unsigned long long>(e.inputs), e.max_error, e.mean_error, e.worst_input,
                  e.worst_input, f.max_ulp);
  }
  return page + "\n";
}

uint32_t threads_of(const VerifyCommandOptions& o) {
  return o.threads > 0 ? o.threads : std::max(1u, std::thread::hardware_concurrency());
}

void run_verify(const VerifyCommandOptions& o) {
  std::vector<std::string> targets = supported_isas();
  if (!o.isa.empty()) {
    choose_isa(o.isa);
    targets = {o.isa};
  }
  ProgressLine line(false);
  const auto show = [&](const Progress& p) {
    std::string text = print("verifying  %3.0f %%", std::floor(100 * p.fraction));
    if (p.fraction > 0.01) text += "  " + clock_time(p.seconds * (1 - p.fraction) / p.fraction) + " left";
    line.show(text);
  };
  std::vector<Row> rows;
  std::string text, why;
  if (!o.exhaustive) {
    const auto results = verify::verify_kernels({targets, o.paths, o.seed, threads_of(o)}, show);
    rows = rows_of(results);
    for (const verify::KernelResult& r : results) {
      if (r.tally.failed > 0) why += std::string(r.name) + " on " + r.target + ": " + r.tally.first_failure + "\n";
    }
  }
  constexpr uint64_t kSampled = 4099;
  const auto functions = verify::study_functions(targets, o.exhaustive ? 1 : kSampled, threads_of(o), show);
  const std::vector<Row> function_rows = rows_of(functions);
  rows.insert(rows.end(), function_rows.begin(), function_rows.end());
  line.clear();

  std::vector<std::string> broken;
  for (const Row& row : rows) {
    if (!row.holds) broken.push_back(row.kernel + " " + row.field + " on " + row.target);
  }
  if (o.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Row& row : rows) list.push_back(json_of(row));
    std::cout << list.dump(2) << "\n";
  } else {
    std::cout << (o.exhaustive ? functions_page(functions) : table(rows, targets)) << why;
    if (broken.empty()) std::cout << "all within bounds\n";
  }
  if (broken.empty()) return;
  std::string names;
  for (const std::string& name : broken) names += (names.empty() ? "" : ", ") + name;
  std::cout.flush();
  throw Error("out of bounds: " + names);
}

}  // namespace

void add_verify_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("verify", "Hold every kernel against its twin in double precision, here");
  command->group("Commands");
  command->footer(kFooter);
  const auto o = std::make_shared<VerifyCommandOptions>();
  command->option_defaults()->take_last();
  const std::vector<std::string> isas = {"scalar", "sse4", "avx2", "avx512"};
  command->add_option("--isa", o->isa, "Only this instruction set")
      ->check(one_of(isas))
      ->type_name(join_names(isas))
      ->default_str("all here");
  command->add_option("--paths", o->paths, "Paths per kernel and instruction set")
      ->check(whole_number(1, 1u << 21))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--seed", o->seed, "Seed of the paths")
      ->check(whole_number(0, 1u << 20))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("-t,--threads", o->threads, "Threads; 0: all that the machine has")
      ->check(whole_number(0, 1024))
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--exhaustive", o->exhaustive, "The functions alone, on every float of their domains (Markdown)");
  command->add_flag("--json", o->json, "Print JSON");
  command->callback([o] { run_verify(*o); });
}

}  // namespace lanewise
