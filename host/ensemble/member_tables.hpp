#pragma once
/// The reduction of the tables of run.h5 that belong to no increment.

#include <map>
#include <span>
#include <string>
#include <vector>

#include "host/ensemble/bands.hpp"
#include "host/ensemble/member.hpp"

namespace voussoir::host {

/// Bands of the tables that all members have, row by row where these tables have equal lengths. K0 (table `k0`), whose
/// knots differ from member to member, is taken at stresses that all members have reached. The histories of the Gauss
/// points repeat the fields and are left out.
[[nodiscard]] std::map<std::string, std::vector<io::Bands>> reduce_tables(std::span<const MemberResults> members,
                                                                          const BandRule& rule);

}  // namespace voussoir::host
