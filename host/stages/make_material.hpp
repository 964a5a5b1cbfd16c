#pragma once
/// The one place that makes a batch of the material of a case.

#include <cstddef>
#include <memory>

#include "fem/material_batch.hpp"
#include "host/case/case.hpp"
#include "host/packing/packings.hpp"

namespace voussoir::host {

/// The parts of a case from which its material is made.
struct MaterialCase {
  MaterialKind kind = MaterialKind::grains;
  SoilCase soil;
  PackingCase packing;  ///< its `pressure` is the isotropic initial pressure of either material
  EngineCase engine;
  ElasticCase elastic;
  TangentChoice tangent;                          ///< tangent of the RVEs
  double tangent_strain = 1.0e-6;                 ///< the strain whose secants make a loading tangent [-]
  kernels::MicrostructureRequest microstructure;  ///< quantities of the contact network in the batch's fields()
};

[[nodiscard]] MaterialCase material_case(const Case& input);

/// A batch of `n_points` points of the material, all at its isotropic initial pressure; grains are spread over the
/// ranks where there are several. `note` receives lines for the log about slow steps.
[[nodiscard]] std::unique_ptr<fem::MaterialBatch> make_material(const MaterialCase& material, std::size_t n_points,
                                                                const PackingNote& note = {});

}  // namespace voussoir::host
