#pragma once
/// One RVE as a packing file of io (docs/reference/files.md), with the histories of its contacts. An RVE that is read
/// back has the same state, bit for bit.

#include <optional>
#include <string>

#include "host/packing/packed_rve.hpp"
#include "io/packing_file.hpp"

namespace voussoir::host {

/// @param soil the soil that the RVE was made of; the file keeps its keys, with which a reader compares its own
[[nodiscard]] io::Packing stored_packing(const PackedRve& rve, const SoilCase& soil, const std::string& recipe,
                                         const std::string& fingerprint);

/// Grains and cell of a packing of any code, without contacts. The grains get the materials of `soil`.
[[nodiscard]] PackedRve grains_from(const io::Packing& file, const SoilCase& soil);

/// Says why the file is no complete packing of this program and its contact law, as the second half of a sentence: a
/// number that is missing or impossible, contacts out of order, histories of another law. Empty where it is complete.
[[nodiscard]] std::string fault_of_state(const io::Packing& file);

/// The RVE of a stored packing, whose grains get the materials of `soil`. Nothing where fault_of_state finds a fault.
[[nodiscard]] std::optional<PackedRve> restored_packing(const io::Packing& file, const SoilCase& soil);

}  // namespace voussoir::host
