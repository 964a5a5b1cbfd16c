#pragma once
/// The reduction of an ensemble: its finished members become means and bands.

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/ensemble/bands.hpp"
#include "host/ensemble/member.hpp"
#include "io/ensemble_file.hpp"

namespace voussoir::host {

/// The increments that all members have, by stage, number within the stage and load parameter. Increments that were
/// cut end at the same loads, so that members differ only where files have vanished.
[[nodiscard]] std::vector<io::EnsembleIncrement> common_increments(std::span<const MemberResults> members);

/// The place of an increment that all members have among those of a member.
[[nodiscard]] std::size_t place_of(const MemberResults& member, const io::EnsembleIncrement& row);

/// Reduces everything but the fields: sets all parts of the result that begin with `reduced` (io/ensemble_file.hpp),
/// and the mesh. Needs at least two members.
void reduce_curves(std::span<const MemberResults> members, const BandRule& rule, io::EnsembleData& result);

/// Reduces the fields, increment by increment, and writes each to fields/NNNN.h5 in the ensemble's folder. Each
/// member's file is read once, so that the fields of one file and their sums are in memory at a time. `before_each` is
/// called before each increment; where it returns false, the reduction ends and returns false.
[[nodiscard]] bool reduce_fields(std::span<const MemberResults> members, const BandRule& rule,
                                 const std::vector<io::EnsembleIncrement>& increments,
                                 const std::filesystem::path& folder, const std::function<bool()>& before_each);

/// The standard error of a column in the last increment that all members have, over the absolute value of its mean [-];
/// infinite where the mean is 0. Throws std::runtime_error where a member has no such column there.
[[nodiscard]] double relative_error(std::span<const MemberResults> members, const std::string& column);

}  // namespace voussoir::host
