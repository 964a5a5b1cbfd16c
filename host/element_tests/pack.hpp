#pragma once
/// `kind = "pack"` makes packings of a recipe and stores them.

#include "host/case/case.hpp"

namespace voussoir::host {

/// Makes the packings, keeps them in the recipe's folder and prints their table. Returns an exit code.
[[nodiscard]] int run_pack(const Case& input);

}  // namespace voussoir::host
