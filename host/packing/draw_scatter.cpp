#include "host/packing/draw_scatter.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace voussoir::host {

namespace {

constexpr double measured_grains = 300;

/// A row of the table in docs/validation/trust.md.
struct Row {
  double variety;
  std::array<double, 3> settlement;  ///< at the volume losses below [-]
  double reaction, k0;
};
constexpr std::array losses{0.01, 0.05, 0.10};
constexpr std::array rows{Row{1, {0.014, 0.071, 0.114}, 0.136, 0.054}, Row{2, {0.011, 0.050, 0.102}, 0.131, 0.038},
                          Row{4, {0.008, 0.046, 0.088}, 0.130, 0.024}, Row{8, {0.007, 0.044, 0.065}, 0.109, 0.015},
                          Row{16, {0.006, 0.033, 0.052}, 0.146, 0.014}};

double between(double a, double b, double share) { return a + share * (b - a); }

/// Linear between the volume losses of the table, constant beyond its ends.
double at_loss(const std::array<double, 3>& values, double loss) {
  if (loss >= losses.back()) return values.back();
  std::size_t k = 0;
  while (loss > losses[k]) ++k;
  if (k == 0) return values.front();
  return between(values[k - 1], values[k], (loss - losses[k - 1]) / (losses[k] - losses[k - 1]));
}

}  // namespace

DrawScatter draw_scatter(int variety, int grains, double volume_loss) {
  std::size_t k = 1;
  while (k + 1 < rows.size() && variety > rows[k].variety) ++k;
  const Row &low = rows[k - 1], &high = rows[k];
  const double share = std::clamp(std::log(variety / low.variety) / std::log(high.variety / low.variety), 0.0, 1.0);
  const double scale = std::sqrt(measured_grains / grains);
  return {
      .settlement = scale * between(at_loss(low.settlement, volume_loss), at_loss(high.settlement, volume_loss), share),
      .reaction = scale * between(low.reaction, high.reaction, share),
      .k0 = scale * between(low.k0, high.k0, share)};
}

std::string draw_sentence(const PackingCase& packing, double volume_loss) {
  const DrawScatter scatter = draw_scatter(packing.variety, packing.grains, volume_loss);
  const bool draws = packing.files.empty() && packing.seeds.empty();  // an ensemble has nothing to draw otherwise
  return fmt::format(
      "which packings are drawn moves the surface's settlement at V_l = {:.3g} % by about {:.0f} %, the least ground "
      "reaction by {:.0f} % and K0 by {:.0f} % (standard deviations in dense sand at variety {} and {} "
      "grains, docs/validation/trust.md){}",
      100 * volume_loss, 100 * scatter.settlement, 100 * scatter.reaction, 100 * scatter.k0, packing.variety,
      packing.grains, draws ? "; `voussoir ensemble` measures them for this case" : "");
}

}  // namespace voussoir::host
