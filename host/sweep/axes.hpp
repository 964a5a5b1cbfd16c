#pragma once
/// The axes of a sweep and the points of the grid that they span. Pure functions, which know no files.

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace voussoir::host {

/// One place on an axis.
struct AxisPoint {
  std::string name;                         ///< its part of the name of a run, "cover_ratio_2"
  std::string value;                        ///< as the tables of the sweep say it, "2"
  std::filesystem::path case_file = {};     ///< the case of the runs at this point; empty: the grid's own
  std::vector<std::string> overrides = {};  ///< "ground.cover_ratio=2"
};

struct Axis {
  std::string name;  ///< heading of its column, "cover_ratio"
  std::vector<AxisPoint> points;
};

/// Axes that advance together; all have as many points. An axis that is crossed with all others is alone.
using AxisGroup = std::vector<Axis>;

struct GridPoint {
  std::string name;                                         ///< the names of its places, joined by "-"
  std::vector<std::pair<std::string, std::string>> values;  ///< name of the axis and value, in the order of the axes
  std::filesystem::path case_file = {};                     ///< empty: the grid's own
  std::vector<std::string> overrides;
};

/// All combinations of the groups' points; the last group changes fastest. Of two places that name a case the later one
/// holds (the reader of sweeps refuses them). No groups: one point without a name.
[[nodiscard]] std::vector<GridPoint> cross(const std::vector<AxisGroup>& groups);

/// The axis of a key of the case and its values (as TOML), named after the last part of the key.
[[nodiscard]] Axis axis_of_key(const std::string& key, const std::vector<std::string>& values);

/// A value as part of the name of a folder: quotes and blanks are dropped, "%" becomes "pct", and every other letter
/// that a name must not have becomes "_".
[[nodiscard]] std::string name_of_value(std::string_view value_as_toml);

}  // namespace voussoir::host
