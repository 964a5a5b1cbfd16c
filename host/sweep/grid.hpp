#pragma once
/// A [grid] table of a sweep file: its axes, which of them advance together, and the points that they span.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "host/sweep/axes.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {

inline constexpr std::size_t most_runs_of_a_sweep = 100'000;

/// What a name of a run or of a grid may be, besides those of files that a sweep writes itself.
inline const io::TextRule run_name_rule{
    .pattern = "[A-Za-z0-9_-][A-Za-z0-9_.-]{0,199}",
    .fault = "must consist of letters, digits and _ . - (at most 200) and must not begin with a dot"};

/// The name, where it can be that of a run's folder and, without quotes, a field of summary.csv. Throws io::InputError
/// at the key's place where it cannot.
[[nodiscard]] std::string checked_name(const io::Table& table, const std::string& key, std::string name);

/// The points of a grid. Names of cases are relative to `folder`. Throws io::InputError for axes that cannot be: two of
/// one name, two that name cases, different lengths of axes that advance together, none at all.
[[nodiscard]] std::vector<GridPoint> points_of(const io::Table& grid, const std::filesystem::path& folder);

}  // namespace voussoir::host
