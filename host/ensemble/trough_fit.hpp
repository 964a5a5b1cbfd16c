#pragma once
/// The modified Gauss curve of settlement troughs (Vorster et al.), eqs. (20), (21) of the paper, and its fit: the same
/// curve, range and search as python/voussoir/figures/trough_fit.py, which a test compares.

#include <span>

namespace voussoir::host {

/// The range of alpha that is searched. With alpha = 0.5 the curve is the Gauss curve; a trough that is more pointed
/// than any curve leaves alpha at the lower end.
inline constexpr double least_alpha = 0.02, largest_alpha = 20.0;

struct TroughFit {
  double largest = 0;     ///< S_max [m]
  double inflection = 0;  ///< i, the distance of the inflection from the axis [m]
  double alpha = 0;       ///< [-]
  double misfit = 0;      ///< root mean square of the residual over |S_max| [-]

  /// True where the trough has the shape of the curve: alpha is within its range and the misfit below 3 %.
  [[nodiscard]] bool good() const;
};

/// The settlement of eq. (20) at the distance x [m] from the axis, in the unit of `largest`.
[[nodiscard]] double modified_gauss(double x, double largest, double inflection, double alpha);

/// Least squares weighted by length. `x` [m] ascends and has at least two places. S_max is linear and solved for;
/// (ln i, ln alpha) are found on a grid that is refined around its best point, which needs no first guess and does not
/// end in a local minimum.
[[nodiscard]] TroughFit fit_trough(std::span<const double> x, std::span<const double> settlement);

}  // namespace voussoir::host
