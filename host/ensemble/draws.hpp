#pragma once
/// The draws of an ensemble's members: which seeds each has, and which cases have something to draw.

#include <cstddef>
#include <cstdint>
#include <string>

#include "host/case/case.hpp"

namespace voussoir::host {

/// The first seed of a member. It draws seeds that no other member draws.
[[nodiscard]] std::int64_t seed_of(const Case& input, std::size_t member);

/// "member_003", the folder of a member below its ensemble's.
[[nodiscard]] std::string member_name(std::size_t member);

/// The override that gives a member its seed.
[[nodiscard]] std::string seed_override(const Case& input, std::size_t member);

/// Throws io::InputError where all members of the case would be the same run.
void expect_a_draw(const Case& input);

}  // namespace voussoir::host
