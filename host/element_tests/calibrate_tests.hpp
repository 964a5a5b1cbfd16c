#pragma once
/// Biaxial tests of many parameter sets as one batch, and what a calibration reads from them.

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
  int tests = 0, valid = 0;              ///< tests that ran, and those of them that held (strength.hpp)
  std::size_t seeds = 0;                 ///< packings at each pressure
  std::vector<std::int64_t> held_seeds;  ///< seeds all of whose tests held; the tests of other seeds are left out
  Observation mean{};  ///< over the held seeds; of each: common angles of the pressures, mean dilatancy and peak strain
  Observation deviation{};          ///< standard deviation over them; 0 with fewer than two
  std::vector<double> contraction;  ///< largest eps_v, mean over them, by pressure [-]
  std::vector<BiaxialCurve> curves;
  std::vector<Strength> strengths;  ///< of each curve
  std::string fault;                ///< why the set has no tests; empty if it has some

  /// At least two thirds of the seeds held. In wide gradings a single small grain that is crushed between large ones
  /// ends a test (`overlap_limit`), mostly past the peak; few sets would be left if one lost test refused its set.
  [[nodiscard]] bool usable() const { return !held_seeds.empty() && 3 * held_seeds.size() >= 2 * seeds; }
  /// The largest contraction grows with the pressure.
  [[nodiscard]] bool contraction_grows() const;
};

/// Fills in the held seeds of a set from its tests (curves and strengths, in any order), and the means if enough seeds
/// held.
void summarise(SetTests& tests, const std::vector<std::int64_t>& seeds, const std::vector<double>& pressures);

/// What all sets have in common.
struct TestProgram {
  SoilCase soil;        ///< in which a set replaces its parameters
  PackingCase packing;  ///< of each set; its pressure is each of the tests' in turn
  EngineCase engine;
  BiaxialCase biaxial;
};

/// Packings of each set at the pressures of the tests (kept in the recipe's folder), then all tests side by side. A set
/// whose packings do not come to rest says so.
[[nodiscard]] std::vector<SetTests> test_sets(const TestProgram& program, std::span<const ParameterSet> sets,
                                              const PackingNote& note);

}  // namespace voussoir::host
