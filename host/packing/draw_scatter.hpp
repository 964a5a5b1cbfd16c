#pragma once
/// How much the draw of the packings moves a tunnel's results: a measured table (docs/validation/trust.md), so that
/// nobody reads one run as exact.

#include <string>

#include "host/case/case.hpp"

namespace voussoir::host {

/// Standard deviations over the mean, between runs that differ in their seeds alone [-].
struct DrawScatter {
  double settlement = 0;  ///< of the surface, at the volume loss asked for
  double reaction = 0;    ///< least ground reaction
  double k0 = 0;          ///< K0 at the tunnel's axis
};

/// Interpolated in the table, which holds for RVEs of 300 grains and volume losses up to 10 %. For other grains the
/// scatter is taken to go as their number to the power -1/2; volume losses below 1 % count as 1 %, those above 10 % as
/// 10 %.
/// @param variety packings at the points of the mesh (PackingCase::variety)
/// @param grains of one RVE
/// @param volume_loss [-]
[[nodiscard]] DrawScatter draw_scatter(int variety, int grains, double volume_loss);

/// A sentence about a single tunnel, which names the soil of the measurements, for its log and for `check`.
[[nodiscard]] std::string draw_sentence(const PackingCase& packing, double volume_loss);

}  // namespace voussoir::host
