#pragma once
/// Biaxial tests of many parameter sets as one batch, and what a calibration reads from them.

#include <span>
#include <string>
#include <vector>

#include "host/biaxial.hpp"
#include "host/calibration.hpp"

namespace voussoir::host {

/// The tests of one parameter set: every seed at every pressure.
struct SetTests {
  ParameterSet set{};
  int tests = 0, valid = 0;  ///< run, and held as they should (biaxial.hpp)
  Observation mean{};        ///< over the seeds; of each: common angles of the pressures, mean dilatancy and peak strain
  Observation deviation{};   ///< standard deviation over the seeds; 0 with fewer than two
  std::vector<double> contraction;  ///< largest eps_v, mean over the seeds, by pressure [-]
  std::vector<BiaxialCurve> curves;
  std::vector<Strength> strengths;  ///< of each curve
  std::string fault;                ///< why there are no tests; empty: there are

  /// All its tests count. One that is lost would bias the mean of the rest.
  [[nodiscard]] bool usable() const { return tests > 0 && valid == tests; }
  /// The largest contraction grows with the pressure.
  [[nodiscard]] bool contraction_grows() const;
};

/// Packings of each set at the pressures of input.biaxial (kept in input.packing.folder), then all tests side by side. A set
/// whose packings do not come to rest says so.
[[nodiscard]] std::vector<SetTests> test_sets(const Case& input, std::span<const ParameterSet> sets, const PackingNote& note);

/// Tests that one set needs.
[[nodiscard]] std::size_t tests_of_a_set(const Case& input);

/// `kind = "calibrate"`: grid, refinements, confirmation; tables `search`, `fit`, `tests` and `sensitivity` of run.h5, a summary
/// to standard output. Returns an exit code.
[[nodiscard]] int run_calibrate(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
