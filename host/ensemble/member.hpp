#pragma once
/// What an ensemble needs of one finished member, but for its fields: the increments with their columns, the columns
/// that are made of fields, the surface trough, the tables.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/case/case.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {

/// The columns that an ensemble makes of the fields of a tunnel's volume loss, in addition to those of the members'
/// own table. docs/reference/files.md describes them.
inline constexpr std::array<const char*, 5> trough_columns{"trough_settlement", "trough_inflection", "trough_alpha",
                                                           "trough_width", "trough_misfit"};
inline constexpr std::array<const char*, 2> reaction_columns{"ground_reaction", "least_ground_reaction"};

struct MemberResults {
  std::filesystem::path folder = {};
  io::MeshData mesh = {};
  /// With the further columns among `extra`.
  std::vector<io::IncrementInfo> increments = {};
  io::Tables tables = {};
  std::vector<double> surface_x = {};  ///< of the surface's nodes, ascending [m]; empty: there is no trough
  std::vector<std::vector<double>> settlement = {};  ///< (increment)(node) of the surface [m]; empty before the volume
                                                     ///< loss
  std::vector<bool> good_trough = {};                ///< (increment) TroughFit::good
};

/// True where the last of a run's increments is the last that its case plans: the run has gone the whole way, even
/// where some of its increments did not converge.
[[nodiscard]] bool is_at_end(const Case& input, const std::vector<io::IncrementInfo>& increments);

/// Reads a member's folder. Throws std::runtime_error where a file is missing or damaged.
[[nodiscard]] MemberResults read_member(const std::filesystem::path& folder);

/// The value of a column in an increment; nothing where the increment has no such column.
[[nodiscard]] std::optional<double> value_of(const io::IncrementInfo& increment, const std::string& column);

/// The columns of an increment that are results of the study. Numbers of increments and points, what the rows are
/// told apart by, yes or no, and what was measured of the machine (times, memory) are none.
[[nodiscard]] io::Quantities results_of(const io::IncrementInfo& increment);

}  // namespace voussoir::host
