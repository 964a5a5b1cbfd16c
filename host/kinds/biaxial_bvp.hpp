#pragma once
/// The case kind "biaxial_bvp": a drained biaxial test as a boundary-value problem, with an RVE at every Gauss point of
/// a rectangle of elements.
///
/// The platens are smooth: the base is held vertically with its left corner fixed; in each increment the top moves down
/// by `strain_step` times the first height and is free sideways. A constant pressure acts on both sides. The
/// formulation is updated Lagrangian: the pressure follows the deformed sides. It is integrated, like the internal
/// forces, on the coordinates at the start of each increment, or of each substep where an increment is relaxed. The
/// specimen has no imperfection; the mirror image at every second point (packing.mirrored) breaks its symmetry, or
/// rounding without it.

#include <array>

#include "fem/increment.hpp"
#include "fem/mesh_state.hpp"
#include "host/case/case.hpp"
#include "host/record/columns.hpp"
#include "host/record/folder.hpp"
#include "host/scene/scene.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// Starts the specimen in options.folder, or goes on with it.
[[nodiscard]] RunStatus run_biaxial_bvp(const Case& input, const RunOptions& options);

/// The specimen as a scene: smooth platens, whose top moves down by the first height at a load parameter of 1.
[[nodiscard]] Scene specimen_scene(const BiaxialBvpCase& test);

/// The specimen as a whole; compression is positive, strains are logarithmic.
struct SpecimenState {
  double axial_strain = 0;       ///< -ln(height / first height) [-]
  double volumetric_strain = 0;  ///< -ln(area / first area), contraction positive [-]
  double axial_force = 0;        ///< force of the top platen on the specimen [N/m]
  double axial_stress = 0;       ///< axial_force over the width of the top on which the force was integrated [Pa]
  double p = 0;                  ///< mean stress of the area's average stress, eq. (7) [Pa]
  double q = 0;                  ///< deviatoric stress of the same average, eq. (8) [Pa]
  double q_over_p = 0;           ///< 0 where p is [-]
};
[[nodiscard]] SpecimenState specimen_state(const fem::Mesh& mesh, const fem::Increment& increment,
                                           const fem::MeshState& state);

inline constexpr auto specimen_columns = std::to_array<Column<SpecimenState>>({
    {"axial_strain", "-", &SpecimenState::axial_strain},
    {"volumetric_strain", "-", &SpecimenState::volumetric_strain},
    {"axial_force", "N/m", &SpecimenState::axial_force},
    {"axial_stress", "Pa", &SpecimenState::axial_stress},
    {"p", "Pa", &SpecimenState::p},
    {"q", "Pa", &SpecimenState::q},
    {"q_over_p", "-", &SpecimenState::q_over_p},
});

}  // namespace voussoir::host
