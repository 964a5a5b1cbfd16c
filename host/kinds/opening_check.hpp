#pragma once
/// The check of the opening at V_l = 0: the reactions of the opening, which is fixed now, are compared with the
/// tractions that held it before.

#include <array>

#include "host/case/case.hpp"
#include "host/record/columns.hpp"
#include "host/scene/k0_table.hpp"
#include "host/stages/ground.hpp"

namespace voussoir::host {

struct OpeningCheck {
  double difference = 0;      ///< |reactions - tractions| over the opening's free directions [N/m]
  double relative = 0;        ///< the same difference over |tractions| [-]
  Eigen::VectorXd reactions;  ///< forces of all supports on the ground, n_dofs [N/m]
};
[[nodiscard]] OpeningCheck check_opening(const Ground& ground, const GroundCase& soil, const K0Table& k0);

/// Table `opening_check` of docs/reference/files.md.
inline constexpr auto opening_columns = std::to_array<Column<OpeningCheck>>({
    {"difference", "N/m", &OpeningCheck::difference},
    {"relative", "-", &OpeningCheck::relative},
});

}  // namespace voussoir::host
