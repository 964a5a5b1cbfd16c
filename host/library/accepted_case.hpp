#pragma once
/// Cases of which the library makes packings and RVEs, and the options of their pools.

#include "host/case/case.hpp"
#include "host/material/rve_pool.hpp"
#include "host/packing/packings.hpp"

namespace voussoir::library {

/// The case with the pressure of its packings, which is packing.pressure except for a probe.
/// @throws std::logic_error where there is no Session; io::InputError for a case that the library does not take, and
/// for what the program refuses before it makes packings or RVEs of a case
[[nodiscard]] host::Case accepted(host::Case input);

/// The options of the pool of a case's RVEs: [engine], the tangent and `output.microstructure`.
[[nodiscard]] host::PoolOptions options_of(const host::Case& input);

/// The packings of `n` RVEs of a case, made, found or read, and spread over the RVEs.
/// @throws std::invalid_argument for n = 0, io::InputError where the case wants more packings than RVEs
[[nodiscard]] host::PackingMix mix_of(const host::Case& input, std::size_t n, const host::PackingNote& note);

}  // namespace voussoir::library
