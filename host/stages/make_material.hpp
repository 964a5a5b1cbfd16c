#pragma once
/// The one place that makes a batch of the material of a case.

#include <memory>
#include <vector>

#include "fem/material_batch.hpp"
#include "fem/mesh.hpp"
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
  std::vector<RegionCase> regions = {};           ///< of a scene; empty: the members above hold for the whole mesh
};

[[nodiscard]] MaterialCase material_case(const Case& input);

/// The material at the points of a mesh, all at the isotropic initial pressure; grains are spread over the ranks where
/// there are several. Each region of the mesh takes the case of its name; a mesh without regions takes the only one.
/// All regions with grains share one pool. `note` receives lines for the log about slow steps. Throws
/// std::invalid_argument where a region of the mesh has no case.
[[nodiscard]] std::unique_ptr<fem::MaterialBatch> make_material(const MaterialCase& material, const fem::Mesh& mesh,
                                                                const PackingNote& note = {});

}  // namespace voussoir::host
