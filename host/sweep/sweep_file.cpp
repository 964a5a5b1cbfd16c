#include "host/sweep/sweep_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "host/case/load_case.hpp"
#include "host/ensemble/draws.hpp"
#include "host/record/run_lock.hpp"
#include "host/sweep/axes.hpp"
#include "io/case_file.hpp"
#include "io/input_error.hpp"
#include "io/text_file.hpp"

namespace voussoir::host {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> grid_keys{"name", "base", "set", "members", "zip"};
constexpr std::int64_t most_members = 1000;
constexpr std::size_t most_runs = 100'000;
constexpr std::size_t most_sweep_bytes = 4'000'000;

/// Says why a text cannot be the name of a run's folder and, without quotes, a field of summary.csv.
std::string fault_of_name(const std::string& name) {
  constexpr const char* allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
  constexpr std::size_t longest = 200;  // of 255 bytes that the name of a file may have, the rest is for endings
  if (name.empty() || name.front() == '.' || name.find_first_not_of(allowed) != std::string::npos)
    return "must consist of letters, digits and _ . - and must not begin with a dot";
  if (name.size() > longest) return fmt::format("must have at most {} letters, has {}", longest, name.size());
  for (const std::string_view taken : {"summary.csv", "sweep.h5", "outcomes", run_lock_name}) {
    if (name == taken) return "is the name of a file that the sweep itself writes";
  }
  return "";
}

std::string checked_name(const io::Table& table, const std::string& key, std::string name) {
  if (const std::string fault = fault_of_name(name); !fault.empty()) throw table.error(key, fault);
  return name;
}

/// What holds for all runs of a part of the file.
struct Common {
  fs::path base;  ///< empty: each run names its case
  std::vector<std::string> overrides;
};

Common common_of(const io::Table& table, Common above) {
  if (table.has("base")) above.base = table.path("base");
  for (std::string& text : table.texts("set", std::vector<std::string>{})) above.overrides.push_back(std::move(text));
  return above;
}

/// A place on a named axis: the name of a case file, overrides, or both.
AxisPoint named_point(const io::Table& axis, const std::string& name, const fs::path& folder) {
  AxisPoint point{.name = checked_name(axis, name, name), .value = name, .case_file = {}, .overrides = {}};
  for (const std::string& text : axis.text_or_texts(name)) {
    if (text.find('=') != std::string::npos) {
      point.overrides.push_back(text);
    } else if (!text.ends_with(".toml")) {
      throw axis.error(name, fmt::format("\"{}\" is neither table.key=value nor the name of a case file, which ends in "
                                         ".toml",
                                         io::in_one_line(text)));
    } else if (!point.case_file.empty()) {
      throw axis.error(name, "names two cases");
    } else {
      point.case_file = folder / text;
    }
  }
  return point;
}

Axis axis_of(const io::Table& grid, const std::string& name, const fs::path& folder) {
  if (!grid.is_table(name)) {
    const std::vector<std::string> values = grid.values_as_toml(name);
    if (values.empty()) throw grid.error(name, "has no values");
    return axis_of_key(name, values);
  }
  const io::Table table = grid.table(name);
  Axis axis{.name = name, .points = {}};
  for (const std::string& point : table.names()) axis.points.push_back(named_point(table, point, folder));
  if (axis.points.empty()) throw grid.error(name, "has no points");
  return axis;
}

/// The axes of a grid; those that `zip` names together are one group, at the place of the first of them.
std::vector<AxisGroup> groups_of(const io::Table& grid, const fs::path& folder) {
  const std::vector<std::vector<std::string>> zipped = grid.lists_of_texts("zip");
  std::vector<AxisGroup> groups;
  std::map<std::size_t, std::size_t> group_of_zip;
  std::set<std::string> found, headings;
  for (const std::string& name : grid.names()) {
    if (std::find(grid_keys.begin(), grid_keys.end(), name) != grid_keys.end()) continue;
    Axis axis = axis_of(grid, name, folder);
    if (!headings.insert(axis.name).second)
      throw grid.error(name,
                       fmt::format("is a second axis called {}; give one of them a name: [grid.NAME]", axis.name));
    found.insert(name);
    const auto zip = std::find_if(zipped.begin(), zipped.end(), [&name](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), name) != names.end();
    });
    if (zip == zipped.end()) {
      groups.push_back({std::move(axis)});
      continue;
    }
    const auto [known, is_new] = group_of_zip.try_emplace(zip - zipped.begin(), groups.size());
    if (is_new) groups.emplace_back();
    AxisGroup& group = groups[known->second];
    if (!group.empty() && group.front().points.size() != axis.points.size())
      throw grid.error("zip",
                       fmt::format("{} has {} values, and {} has {}: axes that advance together must have as many",
                                   group.front().name, group.front().points.size(), axis.name, axis.points.size()));
    group.push_back(std::move(axis));
  }
  for (const std::vector<std::string>& names : zipped) {
    for (const std::string& name : names) {
      if (!found.contains(name)) throw grid.error("zip", fmt::format("names {}, which is no axis of this grid", name));
    }
  }
  return groups;
}

std::string below(const std::string& folder, const std::string& name) {
  return folder.empty() ? name : folder + "/" + name;
}

/// Adds the runs of one point of a grid: one, or its members.
void add_point(SweepPlan& plan, const io::Table& grid, const PlannedRun& point, std::optional<std::int64_t> members) {
  if (!members) {
    plan.runs.push_back(point);
    return;
  }
  const Case input = [&] {
    try {
      Case loaded = load_case(point.case_file, point.overrides);
      expect_a_draw(loaded);
      return loaded;
    } catch (const io::InputError& fault) {
      throw grid.error("members", fmt::format("of {}: {}", point.name, fault.what()));
    }
  }();
  PlannedEnsemble ensemble{.name = point.name, .case_file = point.case_file, .overrides = point.overrides, .runs = {}};
  for (std::size_t member = 0; member < static_cast<std::size_t>(*members); ++member) {
    PlannedRun run = point;
    run.name = below(point.name, member_name(member));
    run.overrides.push_back(seed_override(input, member));
    run.axes.emplace_back("member", fmt::format("{}", member));
    ensemble.runs.push_back(plan.runs.size());
    plan.runs.push_back(std::move(run));
  }
  plan.ensembles.push_back(std::move(ensemble));
}

void add_grid(SweepPlan& plan, const io::Table& grid, const Common& above) {
  const fs::path folder = plan.file.parent_path();
  const Common common = common_of(grid, above);
  const std::string name = grid.has("name") ? checked_name(grid, "name", grid.text("name")) : "";
  std::optional<std::int64_t> members;
  if (grid.has("members")) members = grid.integer("members", {.at_least = 1, .at_most = most_members});
  for (const GridPoint& point : cross(groups_of(grid, folder))) {
    PlannedRun run{.name = below(name, checked_name(grid, "", point.name)),
                   .case_file = point.case_file.empty() ? common.base : point.case_file,
                   .overrides = common.overrides,
                   .grid = name,
                   .point = {},
                   .axes = point.values,
                   .place = grid.place("")};
    if (run.case_file.empty()) throw grid.error("base", "is missing, and no axis names a case");
    run.point = run.name;
    run.overrides.insert(run.overrides.end(), point.overrides.begin(), point.overrides.end());
    add_point(plan, grid, run, members);
    if (plan.runs.size() > most_runs) throw grid.error("", fmt::format("the sweep has more than {} runs", most_runs));
  }
}

void add_run(SweepPlan& plan, const io::Table& table, const Common& above) {
  const std::string name = checked_name(table, "name", table.text("name"));
  const Common common = common_of(table, above);
  if (common.base.empty()) throw table.error("base", "is missing");
  plan.runs.push_back({.name = name,
                       .case_file = common.base,
                       .overrides = common.overrides,
                       .grid = {},
                       .point = name,
                       .axes = {},
                       .place = table.place("set")});
}

/// Refuses two runs of one folder, and a run in the folder of another. Names that differ in "/" and "__" only count as
/// one, because outcome_path makes one file of them.
void refuse_double_names(const SweepPlan& plan) {
  std::set<std::string> names;
  for (const PlannedRun& run : plan.runs) {
    if (!names.insert(outcome_path({}, run.name).string()).second)
      throw io::InputError(run.place, "name", fmt::format("{} is the name of two runs", run.name));
  }
  for (const PlannedRun& run : plan.runs) {
    for (fs::path folder = fs::path(run.name).parent_path(); !folder.empty(); folder = folder.parent_path()) {
      if (names.contains(outcome_path({}, folder.string()).string()))
        throw io::InputError(run.place, "name",
                             fmt::format("{} lies in the folder of the run {}", run.name, folder.string()));
    }
  }
}

}  // namespace

SweepPlan load_sweep(const fs::path& file) {
  const io::CaseFile text = io::CaseFile::load(file);
  SweepPlan plan{.file = file, .text = io::read_text_file(file, most_sweep_bytes), .runs = {}, .ensembles = {}};
  const io::Table root = text.root();
  const Common common = common_of(root, {});
  for (const io::Table& table : root.tables("run")) add_run(plan, table, common);
  for (const io::Table& grid : root.table_or_tables("grid")) add_grid(plan, grid, common);
  if (plan.runs.empty()) throw root.error("run", "there is no [[run]] and no [grid] in this sweep");
  text.finish();
  refuse_double_names(plan);
  return plan;
}

const PlannedRun& run_named(const SweepPlan& plan, const std::string& name) {
  const auto found = std::find_if(plan.runs.begin(), plan.runs.end(),
                                  [&name](const PlannedRun& run) { return run.name == name; });
  if (found != plan.runs.end()) return *found;
  throw io::InputError("--only", name, fmt::format("is no run of {}; --list prints their names", plan.file.string()));
}

fs::path outcome_path(const fs::path& folder, const std::string& run) {
  std::string name;
  for (const char letter : run) name += letter == '/' ? "__" : std::string(1, letter);
  return folder / "outcomes" / (name + ".json");
}

}  // namespace voussoir::host
