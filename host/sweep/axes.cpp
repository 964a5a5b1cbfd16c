#include "host/sweep/axes.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstddef>

namespace voussoir::host {
namespace {

/// The point with one further place for each axis of a group.
GridPoint with_group(GridPoint point, const AxisGroup& group, std::size_t place) {
  for (const Axis& axis : group) {
    const AxisPoint& chosen = axis.points[place];
    point.name += (point.name.empty() ? "" : "-") + chosen.name;
    point.values.emplace_back(axis.name, chosen.value);
    if (!chosen.case_file.empty()) point.case_file = chosen.case_file;
    point.overrides.insert(point.overrides.end(), chosen.overrides.begin(), chosen.overrides.end());
  }
  return point;
}

/// A text without its quotes, all else as it stands.
std::string without_quotes(std::string_view value) {
  if (value.size() < 2 || value.front() != '"') return std::string(value);
  return std::string(value.substr(1, value.size() - 2));
}

}  // namespace

std::vector<GridPoint> cross(const std::vector<AxisGroup>& groups) {
  std::vector<GridPoint> points(1);
  for (const AxisGroup& group : groups) {
    std::vector<GridPoint> further;
    for (const GridPoint& point : points) {
      for (std::size_t place = 0; place < group.front().points.size(); ++place)
        further.push_back(with_group(point, group, place));
    }
    points = std::move(further);
  }
  return points;
}

Axis axis_of_key(const std::string& key, const std::vector<std::string>& values) {
  Axis axis{.name = key.substr(key.rfind('.') + 1), .points = {}};
  for (const std::string& value : values) {
    axis.points.push_back({.name = fmt::format("{}_{}", axis.name, name_of_value(value)),
                           .value = without_quotes(value),
                           .case_file = {},
                           .overrides = {fmt::format("{}={}", key, value)}});
  }
  return axis;
}

std::string name_of_value(std::string_view value_as_toml) {
  constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
  std::string name;
  for (const char letter : value_as_toml) {
    if (letter == '"' || letter == ' ' || letter == '[' || letter == ']') continue;
    if (letter == '%') {
      name += "pct";
    } else {
      name += allowed.find(letter) == std::string_view::npos ? '_' : letter;
    }
  }
  return name;
}

}  // namespace voussoir::host
