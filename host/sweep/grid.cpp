#include "host/sweep/grid.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <map>
#include <regex>
#include <set>
#include <string_view>

#include "host/record/run_lock.hpp"
#include "io/input_error.hpp"
#include "io/text_file.hpp"

namespace voussoir::host {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> grid_keys{"name", "base", "set", "members", "zip"};
/// Files and folders that a sweep writes beside its runs, and an ensemble beside its members.
constexpr std::array<std::string_view, 8> taken_names{"summary.csv", "sweep.h5",    "outcomes", run_lock_name,
                                                      "ensemble.h5", "members.csv", "fields",   "curves.csv"};
/// Columns of summary.csv that every sweep has.
constexpr std::array<std::string_view, 8> fixed_columns{"name",           "status",     "exit_code",      "stage",
                                                        "load_parameter", "iterations", "particle_steps", "wall_s"};

constexpr auto contains = [](const auto& list, const auto& one) {
  return std::find(list.begin(), list.end(), one) != list.end();
};

/// Says why a text cannot be the name of a run's folder and, without quotes, a field of summary.csv.
std::string fault_of_name(const std::string& name) {
  constexpr std::size_t longest = 1000;  // of a text that std::regex, which calls itself for each letter, is given
  static const std::regex allowed(run_name_rule.pattern);
  if (name.size() > longest || !std::regex_match(name, allowed)) return run_name_rule.fault;
  return contains(taken_names, name) ? "is the name of a file that the sweep itself writes" : "";
}

/// What the file says of a place on a named axis. An axis of a key without its quotes ends here, because TOML takes
/// ground.cover_ratio = [2, 3] for a table [grid.ground].
std::vector<std::string> texts_of_place(const io::Table& axis, const std::string& name) {
  try {
    return axis.text_or_texts({"POINT",
                               "A point of the axis, under the name that it gives to folders: an override "
                               "`\"table.key=value\"`, the name of a case file that stands in place of `base`, or an "
                               "array of these."},
                              name);
  } catch (const io::InputError&) {
    throw axis.error(name,
                     "must be an override, the name of a case file, or an array of these; an axis of a key of the "
                     "case has this key in quotes, as in \"ground.cover_ratio\" = [2, 3]");
  }
}

/// A place on a named axis: the name of a case file, overrides, or both.
AxisPoint named_point(const io::Table& axis, const std::string& name, const fs::path& folder) {
  AxisPoint point{.name = checked_name(axis, name, name), .value = name, .case_file = {}, .overrides = {}};
  for (const std::string& text : texts_of_place(axis, name)) {
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
    const std::vector<std::string> values = grid.values_as_toml(
        {"\"TABLE.KEY\"",
         "An axis: a key of the case in quotes, such as "
         "`\"ground.cover_ratio\" = [2, 3, 4]`, and its values."},
        name);
    if (values.empty()) throw grid.error(name, "has no values");
    return axis_of_key(name, values);
  }
  const io::Table table = grid.named_table(
      {"NAME",
       "An axis whose points have names, for what is more than the value of one key: "
       "`NAME` heads its column in the tables of the results."},
      name);
  Axis axis{.name = name, .points = {}};
  for (const std::string& point : table.names()) axis.points.push_back(named_point(table, point, folder));
  if (axis.points.empty()) throw grid.error(name, "has no points");
  return axis;
}

/// Refuses the heading of an axis that the tables of the sweep could not hold, or hold twice.
void expect_heading(const io::Table& grid, const std::string& key, const Axis& axis, std::set<std::string>& headings) {
  const std::string fault = fault_of_name(axis.name);
  if (!fault.empty()) throw grid.error(key, fmt::format("its name {}", fault));
  if (contains(fixed_columns, axis.name) || (axis.name == "member" && grid.has("members")))
    throw grid.error(key, fmt::format("{} is a column that the sweep itself writes; give the axis another name: "
                                      "[grid.NAME]",
                                      axis.name));
  if (!headings.insert(axis.name).second)
    throw grid.error(key, fmt::format("is a second axis called {}; give one of them a name: [grid.NAME]", axis.name));
}

/// The lists of `zip`, each a group of axes. An axis is in one of them at the most.
std::vector<std::vector<std::string>> zips_of(const io::Table& grid) {
  const std::vector<std::string> axes = grid.names();
  std::vector<std::vector<std::string>> zips = grid.lists_of_texts(
      {"zip",
       "Groups of axes that advance together, such as `[[\"ground.cover_ratio\", \"ground.height\"]]`; the axes of a "
       "group have equally many values. All other axes are crossed, each value with each."});
  std::set<std::string> found;
  for (const std::vector<std::string>& names : zips) {
    for (const std::string& name : names) {
      if (!contains(axes, name) || contains(grid_keys, name))
        throw grid.error("zip", fmt::format("names {}, which is no axis of this grid", io::in_one_line(name)));
      if (!found.insert(name).second) throw grid.error("zip", fmt::format("names {} twice", name));
    }
  }
  return zips;
}

/// A case of one axis would silently take the place of another one's.
void expect_one_axis_of_cases(const io::Table& grid, const std::vector<AxisGroup>& groups) {
  std::string known;
  for (const AxisGroup& group : groups) {
    for (const Axis& axis : group) {
      const bool any = std::any_of(axis.points.begin(), axis.points.end(),
                                   [](const AxisPoint& point) { return !point.case_file.empty(); });
      if (!any) continue;
      if (!known.empty()) throw grid.error(axis.name, fmt::format("names cases, and so does the axis {}", known));
      known = axis.name;
    }
  }
}

/// The axes of a grid; those that `zip` names together are one group, at the place of the first of them.
std::vector<AxisGroup> groups_of(const io::Table& grid, const fs::path& folder) {
  const std::vector<std::vector<std::string>> zips = zips_of(grid);
  std::vector<AxisGroup> groups;
  std::map<std::size_t, std::size_t> group_of_zip;
  std::set<std::string> headings;
  for (const std::string& name : grid.names()) {
    if (contains(grid_keys, name)) continue;
    Axis axis = axis_of(grid, name, folder);
    expect_heading(grid, name, axis, headings);
    const auto zip = std::find_if(zips.begin(), zips.end(),
                                  [&name](const auto& names) { return contains(names, name); });
    if (zip == zips.end()) {
      groups.push_back({std::move(axis)});
      continue;
    }
    const auto [known, is_new] = group_of_zip.try_emplace(zip - zips.begin(), groups.size());
    if (is_new) groups.emplace_back();
    AxisGroup& group = groups[known->second];
    if (!group.empty() && group.front().points.size() != axis.points.size())
      throw grid.error("zip",
                       fmt::format("{} has {} values, and {} has {}: axes that advance together must have as many",
                                   group.front().name, group.front().points.size(), axis.name, axis.points.size()));
    group.push_back(std::move(axis));
  }
  expect_one_axis_of_cases(grid, groups);
  return groups;
}

}  // namespace

std::string checked_name(const io::Table& table, const std::string& key, std::string name) {
  if (const std::string fault = fault_of_name(name); !fault.empty()) throw table.error(key, fault);
  return name;
}

std::vector<GridPoint> points_of(const io::Table& grid, const fs::path& folder) {
  const std::vector<AxisGroup> groups = groups_of(grid, folder);
  if (groups.empty())
    throw grid.error("", "has no axis, such as \"ground.cover_ratio\" = [2, 3]; a case alone is a [[run]]");
  std::size_t count = 1;  // before the points are made: twelve axes of ten values would not fit the memory
  for (const AxisGroup& group : groups) {
    count *= group.front().points.size();
    if (count > most_runs_of_a_sweep)
      throw grid.error("", fmt::format("has more than {} points", most_runs_of_a_sweep));
  }
  return cross(groups);
}

}  // namespace voussoir::host
