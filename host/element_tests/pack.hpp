#pragma once
/// `kind = "pack"`: packings of a recipe, made and stored.

#include "host/case/case.hpp"

namespace voussoir::host {

/// Makes the packings, keeps them in the recipe's folder and prints their table. Returns an exit code.
[[nodiscard]] int run_pack(const Case& input);

}  // namespace voussoir::host
