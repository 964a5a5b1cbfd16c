#pragma once
/// The tables of the kinds without a mesh: [biaxial], [probe], [calibrate]. All readers throw io::InputError.

#include "host/case/case.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {

[[nodiscard]] BiaxialCase read_biaxial(const io::Table& table);
[[nodiscard]] ProbeCase read_probe(const io::Table& table);

/// @param soil the soil whose parameters are searched
[[nodiscard]] CalibrateCase read_calibrate(const io::Table& table, const SoilCase& soil);

}  // namespace voussoir::host
