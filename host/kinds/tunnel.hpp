#pragma once
/// The case kind "tunnel": a tunnel that loses volume, in the stages column, gravity and volume loss.

#include <array>

#include "host/case/case.hpp"
#include "host/packing/draw_scatter.hpp"
#include "host/record/columns.hpp"
#include "host/record/folder.hpp"
#include "host/stages/ground.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// Table `draw_scatter` of docs/reference/files.md.
inline constexpr auto draw_scatter_columns = std::to_array<Column<DrawScatter>>({
    {"settlement", "-", &DrawScatter::settlement},
    {"reaction", "-", &DrawScatter::reaction},
    {"k0", "-", &DrawScatter::k0},
});

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

/// Starts the tunnel of the case in options.folder, or goes on with it. The column has its results in the folder
/// `column` there.
[[nodiscard]] RunStatus run_tunnel(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
