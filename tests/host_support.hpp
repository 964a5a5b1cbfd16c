#pragma once
/// Helpers of the host's tests.

#include "host/packing/recipe.hpp"

namespace voussoir::host {

/// Sixty grains of the default soil, seed 1, at `pressure` [Pa].
inline PackedRve small_packing(double pressure = 1e5) {
  Case input;
  input.packing.grains = 60;
  input.packing.pressure = pressure;
  const std::int64_t seed[] = {1};
  return make_packings(input.soil, input.packing, seed).front();
}

}  // namespace voussoir::host
