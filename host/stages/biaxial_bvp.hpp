#pragma once
/// The case kind "biaxial_bvp": a drained biaxial test as a boundary-value problem, with an RVE at every Gauss point of
/// a rectangle of elements.
///
/// Smooth platens: the base is held vertically with its left corner fixed, the top moves down by `strain_step` of the
/// first height an increment and is free sideways. A constant pressure acts on both sides. Updated Lagrangian: the
/// pressure follows the deformed sides, integrated on the coordinates at the start of each increment (of each substep
/// of a relaxed one), the same on which the internal forces are. No imperfection is put in; what breaks the symmetry is
/// the mirror image at every second point (packing.mirrored) or, without it, rounding.

#include <array>

#include "fem/increment.hpp"
#include "fem/mesh_state.hpp"
#include "host/case/case.hpp"
#include "host/record/columns.hpp"
#include "host/record/folder.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// Runs, or goes on with, the specimen in options.folder.
[[nodiscard]] RunStatus run_biaxial_bvp(const Case& input, const RunOptions& options);

/// Smooth platens, the top's displacement increment [m] given.
[[nodiscard]] fem::Constraints platen_constraints(const fem::Mesh& mesh, double top_increment);

/// The specimen as a whole; compression positive, logarithmic strains.
struct SpecimenState {
  double axial_strain = 0;       ///< -ln(height / first height) [-]
  double volumetric_strain = 0;  ///< -ln(area / first area), contraction positive [-]
  double axial_force = 0;        ///< of the top platen on the specimen [N/m]
  double axial_stress = 0;       ///< axial_force over the top's width on which it was integrated [Pa]
  double p = 0;                  ///< of the stress averaged over the area, eq. (7) [Pa]
  double q = 0;                  ///< of the same, eq. (8) [Pa]
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
