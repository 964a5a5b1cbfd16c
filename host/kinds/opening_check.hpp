#pragma once
/// The check of the opening at V_l = 0: the reactions of the opening, which is fixed now, are compared with the
/// tractions that held it before.

#include <array>

#include "host/record/columns.hpp"
#include "host/scene/scene.hpp"

namespace voussoir::host {

struct OpeningCheck {
  double difference = 0;  ///< |reactions - tractions| over the opening's free directions [N/m]
  double relative = 0;    ///< the same difference over |tractions| [-]
};
/// @param before the stage in which the opening was held by tractions
/// @param reactions forces of all supports on the ground when the opening has been fixed, n_dofs [N/m]
/// @param tractions nodal forces of the tractions that held it, n_dofs [N/m]
[[nodiscard]] OpeningCheck check_opening(const fem::Mesh& mesh, const StagePlan& before,
                                         const Eigen::VectorXd& reactions, const Eigen::VectorXd& tractions);

/// Table `opening_check` of docs/reference/files.md.
inline constexpr auto opening_columns = std::to_array<Column<OpeningCheck>>({
    {"difference", "N/m", &OpeningCheck::difference},
    {"relative", "-", &OpeningCheck::relative},
});

}  // namespace voussoir::host
