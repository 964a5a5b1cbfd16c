// All sets of lanes that the program holds and the processor takes give the same bits in every number. The choice
// between them.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/isa/choose_lanes.hpp"
#include "tests/engine_support.hpp"
#include "tests/same_answers.hpp"
#include "tests/throws.hpp"

namespace voussoir::kernels {
namespace {

/// Sets VOUSSOIR_ISA as long as it lives; afterwards the choice is made anew.
class Variable {
 public:
  explicit Variable(const char* value) : before_(std::getenv(name) == nullptr ? "" : std::getenv(name)) {
    setenv(name, value, 1);
  }
  ~Variable() {
    setenv(name, before_.c_str(), 1);
    choose_lanes({});
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  static constexpr const char* name = "VOUSSOIR_ISA";
  std::string before_;
};

std::vector<const LaneSet*> takeable_sets() {
  std::vector<const LaneSet*> sets;
  for (const LaneSet* set : compiled_lanes()) {
    if (why_not(set->isa).empty()) sets.push_back(set);
  }
  return sets;
}

struct Answers {
  RveBatch batch;
  std::vector<RveReport> reports;
  std::vector<std::vector<ServoSample>> traces;
};

class InstructionSets : public testing::TestWithParam<Precision> {
 protected:
  static void SetUpTestSuite() { dense = reference::consolidated_packing(40, 2, 1e5, 0.0, reference::Material{}); }
  static inline reference::Rve dense;

  /// Runs the same with each set and compares what it answers with the first set's answer.
  static void expect_same_bits(const std::function<Answers()>& answer) {
    const auto sets = takeable_sets();
    if (sets.size() < 2) GTEST_SKIP() << "the program holds one set, or the processor takes no other";
    choose_lanes(sets.front()->isa);
    const Answers expected = answer();
    for (const LaneSet* set : sets) {
      SCOPED_TRACE(name_of(set->isa));
      choose_lanes(set->isa);
      const Answers got = answer();
      for (std::size_t k = 0; k < expected.batch.size(); ++k) {
        expect_same_report(got.reports[k], expected.reports[k], k);
        for (int c = 0; c < 3; ++c) EXPECT_EQ(got.reports[k].tangent_skew[c], expected.reports[k].tangent_skew[c]);
        expect_same_state(got.batch.trial, expected.batch.trial, k, expected.batch.packing(k).radii.size());
      }
      ASSERT_EQ(got.traces.size(), expected.traces.size());
      for (std::size_t k = 0; k < expected.traces.size(); ++k) expect_same_trace(got.traces[k], expected.traces[k]);
    }
    choose_lanes({});
  }

 private:
  static void expect_same_trace(const std::vector<ServoSample>& a, const std::vector<ServoSample>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t s = 0; s < a.size(); ++s) {
      EXPECT_EQ(a[s].step, b[s].step);
      EXPECT_EQ(a[s].strain_x, b[s].strain_x);
      EXPECT_EQ(a[s].stress_xx, b[s].stress_xx);
      EXPECT_EQ(a[s].stress_xy, b[s].stress_xy);
      EXPECT_EQ(a[s].unbalanced, b[s].unbalanced);
      EXPECT_EQ(a[s].microstructure.coordination, b[s].microstructure.coordination);
      EXPECT_EQ(a[s].microstructure.fabric_anisotropy, b[s].microstructure.fabric_anisotropy);
    }
  }
};

/// More RVEs than one group of the widest lanes holds, with different motions; one is pulled open, one is lost.
std::vector<StrainRequest> motions(std::size_t n) {
  std::vector<StrainRequest> requests(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double e = 2e-3 * std::cos(1.0 * static_cast<double>(k));
    requests[k] = {
        .f_rel = {1 + e, 5 * e, -e, 1 - 2 * e}, .strain_steps = 60 + 7 * static_cast<int>(k), .hold_cap = 200};
  }
  requests[3].f_rel = {1.2, 0, 0, 1.2};
  requests[4].f_rel = {0.5, 0, 0, 0.5};
  return requests;
}

TEST_P(InstructionSets, GiveTheSameBitsForGivenMotions) {
  // Static tangents take most of the time of scalar lanes.
  const auto tangents = GetParam() == Precision::float32 ? std::vector{TangentKind::elastic, TangentKind::loading}
                                                         : std::vector{TangentKind::contact, TangentKind::static_};
  for (const TangentKind tangent : tangents) {
    SCOPED_TRACE(name_of(tangent));
    expect_same_bits([&] {
      Answers a{clones(dense, 19), std::vector<RveReport>(19), {}};
      EngineSettings settings{.precision = GetParam(), .tangent = tangent};
      settings.skin = 0.01;  // lists are renewed on the way
      advance(a.batch, std::span<const StrainRequest>(motions(19)), settings, a.reports);
      return a;
    });
  }
}

TEST_P(InstructionSets, GiveTheSameBitsForControlledStresses) {
  expect_same_bits([&] {
    Answers a{clones(dense, 5), std::vector<RveReport>(5), std::vector<std::vector<ServoSample>>(5)};
    std::vector<ServoRequest> requests(5);
    for (std::size_t k = 0; k < 5; ++k) {
      requests[k].x.target = -1e5 - 1e4 * static_cast<double>(k);
      requests[k].y = {.stress_controlled = false, .target = -2e-5};
      requests[k].end_strain_y = 0.005;
      requests[k].max_steps = 800;
      requests[k].trace = &a.traces[k];
      requests[k].microstructure = {.fabric = true, .coordination = true};
    }
    advance(a.batch, std::span<const ServoRequest>(requests), {.precision = GetParam()}, a.reports);
    return a;
  });
}

/// Each RVE with a packing of its own runs in a group of one lane.
TEST_P(InstructionSets, GiveTheSameBitsForUnlikePackings) {
  expect_same_bits([&] {
    Answers a{make_batch({packing_of(dense), packing_of(dense)}, {0, 1}), std::vector<RveReport>(2), {}};
    for (std::size_t k = 0; k < 2; ++k) fill(a.batch.committed, k, dense);
    advance(a.batch, std::span<const StrainRequest>(motions(5)).subspan(0, 2), {.precision = GetParam()}, a.reports);
    return a;
  });
}

INSTANTIATE_TEST_SUITE_P(Precisions, InstructionSets, testing::Values(Precision::float32, Precision::float64),
                         [](const auto& tested) { return tested.param == Precision::float32 ? "float" : "double"; });

TEST(LaneChoice, IsTheLargestSetThatTheProcessorTakes) {
  const Variable automatic("auto");
  const LaneChoice& choice = choose_lanes({});
  EXPECT_EQ(choice.lanes, takeable_sets().back());
  EXPECT_LE(choice.lanes->isa, processor_set());
}

TEST(LaneChoice, TheVariableComesBeforeTheProcessorAndAWishBeforeTheVariable) {
  const auto sets = takeable_sets();
  const Variable first(name_of(sets.front()->isa));
  EXPECT_EQ(choose_lanes({}).lanes, sets.front());
  EXPECT_NE(chosen_lanes().reason.find("VOUSSOIR_ISA"), std::string::npos);
  EXPECT_EQ(choose_lanes(sets.back()->isa).lanes, sets.back());
  EXPECT_NE(chosen_lanes().reason.find("engine.isa"), std::string::npos);
}

TEST(LaneChoice, RefusesAVariableThatNamesNoSet) {
  const Variable wrong("avx9");
  expect_throws<UnusableLanes>([] { choose_lanes({}); },
                               "the environment variable VOUSSOIR_ISA is \"avx9\"; it can be auto, scalar, v3 or v4");
}

TEST(LaneChoice, EverySetIsTakeableOrSaysWhyNot) {
  for (const InstructionSet isa : {InstructionSet::scalar, InstructionSet::v3, InstructionSet::v4}) {
    EXPECT_EQ(find_instruction_set(name_of(isa)), isa);
    if (why_not(isa).empty()) {
      EXPECT_EQ(choose_lanes(isa).lanes->isa, isa);
      EXPECT_GE(choose_lanes(isa).lanes->floats, choose_lanes(isa).lanes->doubles);
    } else {
      EXPECT_THROW(choose_lanes(isa), UnusableLanes);
    }
  }
  choose_lanes({});
}

}  // namespace
}  // namespace voussoir::kernels
