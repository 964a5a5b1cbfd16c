#pragma once
/// The tables of the grains: [soil], [packing]. All readers throw io::InputError.

#include <array>
#include <string_view>

#include "host/case/case.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {

/// Keys that a grading curve replaces.
inline constexpr io::Key size_minimum_key{
    "size_minimum", "Smallest grain diameter of grains whose diameters are uniformly distributed by number."};
inline constexpr io::Key size_maximum_key{"size_maximum",
                                          "Largest grain diameter of grains whose diameters are uniformly distributed "
                                          "by number, at most 40 times the smallest."};

[[nodiscard]] SoilCase read_soil(const io::Table& table);
/// @param on_a_mesh true for kinds with a mesh, where `variety` counts
[[nodiscard]] PackingCase read_packing(const io::Table& table, bool on_a_mesh);

/// The packings of a region of a scene. What is not a region's own is that of `common`, which [packing] says.
[[nodiscard]] PackingCase read_region_packing(const io::Table& table, const PackingCase& common);

/// The keys of [packing] that are no region's own.
inline constexpr std::array<std::string_view, 5> common_packing_keys{"pressure", "mirrored", "folder", "seed", "seeds"};

/// Throws where `file` is a stored state, from which only a probe can start.
void check_no_state(const io::Table& table, const PackingCase& packing);

/// Throws where `variety` asks for more packings than the recipe's candidates, seeds or files are.
void check_variety(const io::Table& table, const PackingCase& packing);

}  // namespace voussoir::host
