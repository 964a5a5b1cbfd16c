#pragma once
/// Biaxial tests of many parameter sets as one batch, and the values that a calibration reads from them.

#include <span>
#include <string>
#include <vector>

#include "host/element_tests/biaxial.hpp"
#include "host/element_tests/calibration.hpp"
#include "host/element_tests/strength.hpp"
#include "host/packing/packings.hpp"

namespace voussoir::host {

/// The tests of one parameter set: every seed at every pressure.
struct SetTests {
  ParameterSet set{};
  int tests = 0, valid = 0;              ///< number of tests that ran, and of those that held (strength.hpp)
  std::size_t seeds = 0;                 ///< packings at each pressure
  std::vector<std::int64_t> held_seeds;  ///< seeds all of whose tests held; the tests of other seeds are left out
  Observation mean{};  ///< mean over the held seeds of their common angles of all pressures, mean dilatancy and peak
                       ///< strain
  Observation deviation{};          ///< standard deviation over the held seeds; 0 with fewer than two
  std::vector<double> contraction;  ///< largest eps_v, mean over the held seeds, by pressure [-]
  std::vector<BiaxialCurve> curves;
  std::vector<Strength> strengths;  ///< of each curve
  std::string fault;                ///< why the set has no tests; empty if it has some

  /// True where at least two thirds of the seeds held. In wide gradings a single small grain that is crushed between
  /// large ones ends a test (`overlap_limit`), mostly past the peak. Few sets would remain if one such test made its
  /// set unusable.
  [[nodiscard]] bool usable() const { return !held_seeds.empty() && 3 * held_seeds.size() >= 2 * seeds; }
  /// True where the largest contraction grows with the pressure.
  [[nodiscard]] bool contraction_grows() const;
};

/// Fills in the held seeds of a set from its tests (curves and strengths, in any order), and the means if enough seeds
/// held.
void summarise(SetTests& tests, const std::vector<std::int64_t>& seeds, const std::vector<double>& pressures);

/// The part of the tests that is the same for all sets.
struct TestProgram {
  SoilCase soil;        ///< the soil whose parameters a set replaces
  PackingCase packing;  ///< the recipe of each set; its pressure is replaced by the pressure of each test
  EngineCase engine;
  BiaxialCase biaxial;
};

/// Makes the packings of each set at the pressures of the tests, or finds them in the recipe's folder, then runs all
/// tests side by side. A set whose packings do not come to rest has no tests and says why (`fault`).
[[nodiscard]] std::vector<SetTests> test_sets(const TestProgram& program, std::span<const ParameterSet> sets,
                                              const PackingNote& note);

}  // namespace voussoir::host
