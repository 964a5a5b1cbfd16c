#pragma once
/// `kind = "pack"` makes packings of a recipe and stores them.

#include "host/case/case.hpp"
#include "host/process/exit_code.hpp"

namespace voussoir::host {

/// Makes the packings, keeps them in the recipe's folder and prints their table.
[[nodiscard]] Outcome run_pack(const Case& input);

}  // namespace voussoir::host
