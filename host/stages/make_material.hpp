#pragma once
/// The one place where a case's material becomes a batch.

#include <cstddef>
#include <memory>

#include "fem/material_batch.hpp"
#include "host/case/case.hpp"
#include "host/packing/packings.hpp"

namespace voussoir::host {

/// A batch of `n_points` points of the case's material, all at the case's isotropic initial pressure
/// (packing.pressure). `note` is told what is done where that takes time.
[[nodiscard]] std::unique_ptr<fem::MaterialBatch> make_material(const Case& input, std::size_t n_points,
                                                                const PackingNote& note = {});

}  // namespace voussoir::host
