#pragma once
/// Stage "volume_loss": eccentric volume loss of the tunnel, eqs. (17)-(19), from V_l = 0 on.

#include <array>

#include "host/record/columns.hpp"
#include "host/scene/k0_table.hpp"
#include "host/stages/ground_run.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// Goes on from the V_l that the ground has reached. Unless `resumed`, the stage is started first: the opening is fixed
/// in its place, and the state at V_l = 0 is compared with the state at rest and recorded.
[[nodiscard]] RunStatus lose_volume(GroundRun& run, const GroundCase& soil, const VolumeLossCase& loss,
                                    const K0Table& k0, bool resumed);

/// The effect of the tunnel on the ground.
struct TunnelReport {
  double crown_settlement = 0;    ///< [m]
  double surface_settlement = 0;  ///< largest settlement of the surface [m]
  double area_loss = 0;           ///< area that the opening has lost, over its original area [-]
};
[[nodiscard]] TunnelReport tunnel_report(const Ground& ground);

inline constexpr auto tunnel_columns = std::to_array<Column<TunnelReport>>({
    {"crown_settlement", "m", &TunnelReport::crown_settlement},
    {"surface_settlement", "m", &TunnelReport::surface_settlement},
    {"area_loss", "-", &TunnelReport::area_loss},
});

}  // namespace voussoir::host
