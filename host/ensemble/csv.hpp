#pragma once
/// The tables of an ensemble as text: curves.csv and members.csv (docs/reference/files.md).

#include <string>
#include <vector>

#include "host/ensemble/member.hpp"
#include "io/ensemble_file.hpp"

namespace voussoir::host {

/// One line for each increment: for each column mean, deviation and the half widths of both bands; a field is empty
/// where a member has no value.
[[nodiscard]] std::string curves_csv(const io::EnsembleData& data);

/// One line for each member: its seed, how it ended, and the results of its last increment, which are empty for a
/// member that is not reduced. `reduced` are the reduced members in their order.
[[nodiscard]] std::string members_csv(const std::vector<io::EnsembleMember>& members,
                                      const std::vector<MemberResults>& reduced);

}  // namespace voussoir::host
