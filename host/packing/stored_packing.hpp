#pragma once
/// One RVE as a packing file of io (FORMAT.md), with its contacts' histories: read back, it is the same state bit for
/// bit.

#include <optional>
#include <string>

#include "host/packing/packed_rve.hpp"
#include "io/packing_file.hpp"

namespace voussoir::host {

[[nodiscard]] io::Packing stored_packing(const PackedRve& rve, const std::string& recipe,
                                         const std::string& fingerprint);

/// Grains and cell of a packing of any code, the grains made of `soil`; no contacts.
[[nodiscard]] PackedRve grains_from(const io::Packing& file, const SoilCase& soil);

/// The RVE of a stored packing, its grains made of `soil`; nothing where numbers are missing, impossible or of another
/// law.
[[nodiscard]] std::optional<PackedRve> restored_packing(const io::Packing& file, const SoilCase& soil);

}  // namespace voussoir::host
