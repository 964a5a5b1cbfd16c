#include "host/sweep/sweep_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "host/case/load_case.hpp"
#include "host/ensemble/draws.hpp"
#include "host/sweep/grid.hpp"
#include "io/case_file.hpp"
#include "io/input_error.hpp"
#include "io/text_file.hpp"

namespace voussoir::host {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t most_members = 1000;
constexpr std::size_t longest_file = 230;  ///< of 255 bytes that a file's name may have, the rest is for endings
constexpr std::size_t most_sweep_bytes = 4'000'000;

/// What holds for all runs of a part of the file.
struct Common {
  fs::path base;  ///< empty: each run names its case
  std::vector<std::string> overrides;
};

Common common_of(const io::Table& table, Common above) {
  const auto base = table.optional_path(
      {"base",
       "Case file of the runs, relative to this file. A `base` of a grid or of a run overrides that of the sweep."});
  if (base) above.base = *base;
  const io::Key set{
      "set",
      "Overrides of the case's keys, such as `[\"engine.preset=fast\"]`, as `--set` gives them; those of a "
      "grid or a run are added to those of the sweep."};
  for (std::string& text : table.texts(set, std::vector<std::string>{})) above.overrides.push_back(std::move(text));
  return above;
}

/// What a [grid] says beside its axes.
struct GridHead {
  Common common;
  std::string name;
  std::optional<std::int64_t> members;
};

GridHead read_grid(const io::Table& grid, const Common& above) {
  GridHead head{.common = common_of(grid, above), .name = {}, .members = {}};
  const io::Key name{"name", "Name of the grid, which is a folder around those of its runs."};
  if (const auto given = grid.optional_text(name, run_name_rule)) head.name = checked_name(grid, "name", *given);
  head.members = grid.optional_integer(
      {"members",
       "Number of runs at each point of the grid, with different draws of the packings, which are reduced to means and "
       "bands. Without the key, one run is made with the seeds of the case."},
      {.at_least = 1, .at_most = most_members});
  return head;
}

/// What a [[run]] says: its name, and what it shares with no other.
struct RunHead {
  std::string name;
  Common common;
};

RunHead read_run(const io::Table& table, const Common& above) {
  const io::Key name{"name", "Name of the run, which is its folder below that of the sweep."};
  RunHead head{.name = checked_name(table, "name", table.text(name, {}, run_name_rule)), .common = {}};
  head.common = common_of(table, above);
  return head;
}

std::vector<io::Table> runs_in(const io::Table& root) {
  return root.tables({"run", "A run by its name, beside the runs of grids."});
}

std::vector<io::Table> grids_in(const io::Table& root) {
  return root.table_or_tables(
      {"grid",
       "A grid of runs: all combinations of the values of its axes. A file with one grid writes `[grid]`; a file with "
       "several writes `[[grid]]` for each, with a `name` in it."});
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
  const auto [common, name, members] = read_grid(grid, above);
  for (const GridPoint& point : points_of(grid, folder)) {
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
    if (plan.runs.size() > most_runs_of_a_sweep)
      throw grid.error("", fmt::format("the sweep has more than {} runs", most_runs_of_a_sweep));
  }
}

void add_run(SweepPlan& plan, const io::Table& table, const Common& above) {
  const auto [name, common] = read_run(table, above);
  if (common.base.empty()) throw table.error("base", "is missing");
  plan.runs.push_back({.name = name,
                       .case_file = common.base,
                       .overrides = common.overrides,
                       .grid = {},
                       .point = name,
                       .axes = {},
                       .place = table.place("set")});
}

void add_runs(SweepPlan& plan, const io::Table& root) {
  const Common common = common_of(root, {});
  for (const io::Table& table : runs_in(root)) add_run(plan, table, common);
  for (const io::Table& grid : grids_in(root)) add_grid(plan, grid, common);
  if (plan.runs.empty()) throw root.error("run", "there is no [[run]] and no [grid] in this sweep");
}

/// A sweep in which every key has been read.
io::CaseFile known_sweep() {
  io::CaseFile file = io::CaseFile::of_text(
      "[[run]]\nname = \"a\"\n[[grid]]\n\"ground.height\" = [1]\n[grid.soil]\ndense = \"a=1\"\n", "keys of sweeps");
  const Common common = common_of(file.root(), {});
  for (const io::Table& run : runs_in(file.root())) static_cast<void>(read_run(run, common));
  for (const io::Table& grid : grids_in(file.root())) {
    static_cast<void>(read_grid(grid, common));
    static_cast<void>(points_of(grid, {}));
  }
  return file;
}

/// Refuses two runs of one folder, and a run in the folder of another. Names that differ in "/" and "__" only count as
/// one, because outcome_path makes one file of them. This file must have a name that the file system takes.
void refuse_names(const SweepPlan& plan) {
  std::map<std::string, std::string> names;
  for (const PlannedRun& run : plan.runs) {
    const std::string file = outcome_path({}, run.name).filename().string();
    if (file.size() > longest_file)
      throw io::InputError(run.place, "name", fmt::format("{} is too long for the name of a file", run.name));
    const auto [known, is_new] = names.try_emplace(file, run.name);
    if (is_new) continue;
    const std::string like = known->second == run.name ? "" : " (\"__\" stands for \"/\": " + known->second + ")";
    throw io::InputError(run.place, "name", fmt::format("{} is the name of two runs{}", run.name, like));
  }
  for (const PlannedRun& run : plan.runs) {
    for (fs::path folder = fs::path(run.name).parent_path(); !folder.empty(); folder = folder.parent_path()) {
      if (names.contains(outcome_path({}, folder.string()).filename().string()))
        throw io::InputError(run.place, "name",
                             fmt::format("{} lies in the folder of the run {}", run.name, folder.string()));
    }
  }
}

}  // namespace

SweepPlan load_sweep(const fs::path& file) {
  const io::CaseFile text = io::CaseFile::load(file);
  SweepPlan plan{.file = file, .text = io::read_text_file(file, most_sweep_bytes), .runs = {}, .ensembles = {}};
  try {
    add_runs(plan, text.root());
  } catch (const io::InputError&) {
    text.finish_as(known_sweep());  // a misspelt key is often why a value is missing
    throw;
  }
  text.finish();
  refuse_names(plan);
  return plan;
}

io::KeyList keys_of_sweep() {
  const io::CaseFile file = known_sweep();
  return {file.keys(), file.tables()};
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
