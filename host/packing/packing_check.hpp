#pragma once
/// Faults of a packing that are known before a run: a file of grains that cannot be this soil's packing, and a recipe
/// whose cell is too narrow for its grains, or that has too few grains for its grading.

#include "host/case/case.hpp"
#include "io/packing_file.hpp"

namespace voussoir::host {

/// Throws std::runtime_error with a sentence about a packing read from a file: too many grains, sizes that are far from
/// those of the soil (another unit of length), a cell that is too narrow or that belongs to other grains, grains that
/// lie too deep in one another. @param skin of the neighbour lists, over the mean diameter [-]
void check_grains(const io::Packing& file, const SoilCase& soil, double skin);

/// Reads the recipe's files whole, as the run does, and checks them. Throws std::runtime_error. Does nothing where the
/// recipe has no file.
void check_packing_files(const SoilCase& soil, const PackingCase& recipe, double skin);

/// Throws std::runtime_error where packings of so many grains of this soil are no use: their cell is narrower than two
/// contact distances of the largest grains, or the coarsest fifth of the soil has less than one grain.
void check_recipe(const SoilCase& soil, int grains, double skin);

/// The number of grains that a packing needs, so that the coarsest part of the soil, a share of its area [-], has one
/// grain on average.
[[nodiscard]] int least_grains(const SoilCase& soil, double coarsest);

/// A sentence that says that packings of so many grains lack the coarsest tenth of the grading; empty where they do
/// not.
[[nodiscard]] std::string missing_coarse_grains(const SoilCase& soil, int grains);

}  // namespace voussoir::host
