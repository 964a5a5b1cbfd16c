#pragma once
/// The one place where a case's material becomes a batch.

#include <cstddef>
#include <memory>

#include "fem/material_batch.hpp"
#include "host/case/case.hpp"
#include "host/packing/packings.hpp"

namespace voussoir::host {

/// Of a case what its material is made from.
struct MaterialCase {
  MaterialKind kind = MaterialKind::grains;
  SoilCase soil;
  PackingCase packing;  ///< its `pressure` is the isotropic initial pressure of either material
  EngineCase engine;
  ElasticCase elastic;
  TangentChoice tangent;                          ///< of the RVEs
  double tangent_strain = 1.0e-6;                 ///< of a loading tangent, the strain it is the secant of [-]
  kernels::MicrostructureRequest microstructure;  ///< of the contact network, what the batch's fields() shall hold
};

[[nodiscard]] MaterialCase material_case(const Case& input);

/// A batch of `n_points` points of the material, all at its isotropic initial pressure; grains are spread over the
/// ranks where there are several. `note` is told what is done where that takes time.
[[nodiscard]] std::unique_ptr<fem::MaterialBatch> make_material(const MaterialCase& material, std::size_t n_points,
                                                                const PackingNote& note = {});

}  // namespace voussoir::host
