/// The reduction of an ensemble against closed forms: Student's t, bands, the trough's curve, increments and tables of
/// members that differ.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "host/ensemble/bands.hpp"
#include "host/ensemble/csv.hpp"
#include "host/ensemble/reduction.hpp"
#include "host/ensemble/student.hpp"
#include "host/ensemble/trough_fit.hpp"

namespace voussoir::host {
namespace {

TEST(StudentTest, OneAndTwoDegreesHaveClosedForms) {
  for (const double confidence : {0.1, 0.5, 0.9, 0.95, 0.999}) {
    // The quantiles of a Cauchy distribution, and of t with two degrees of freedom.
    EXPECT_NEAR(student_two_sided(confidence, 1), std::tan(0.5 * std::numbers::pi * confidence),
                1e-11 * std::tan(0.5 * std::numbers::pi * confidence));
    EXPECT_NEAR(student_two_sided(confidence, 2), confidence * std::sqrt(2 / (1 - confidence * confidence)),
                1e-11 * student_two_sided(confidence, 2));
  }
}

TEST(StudentTest, TableValuesOfTheQuantile) {
  // t_0.975 and t_0.995, to all digits that tables print.
  EXPECT_NEAR(student_two_sided(0.95, 1), 12.7062, 5e-5);
  EXPECT_NEAR(student_two_sided(0.95, 2), 4.3027, 5e-5);
  EXPECT_NEAR(student_two_sided(0.95, 3), 3.1824, 5e-5);
  EXPECT_NEAR(student_two_sided(0.95, 4), 2.7764, 5e-5);
  EXPECT_NEAR(student_two_sided(0.95, 15), 2.1314, 5e-5);
  EXPECT_NEAR(student_two_sided(0.95, 30), 2.0423, 5e-5);
  EXPECT_NEAR(student_two_sided(0.95, 63), 1.9983, 5e-5);
  EXPECT_NEAR(student_two_sided(0.99, 7), 3.4995, 5e-5);
  EXPECT_NEAR(student_two_sided(0.95, 1000), 1.9623, 5e-5);
}

TEST(StudentTest, WrongArgumentsAreRefused) {
  EXPECT_THROW(static_cast<void>(student_two_sided(0.95, 0)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(student_two_sided(1.0, 3)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(student_two_sided(0.0, 3)), std::invalid_argument);
}

TEST(BandsTest, AKnownSample) {
  // 2, 4, 4, 4, 5, 5, 7, 9: mean 5, sum of squares 32, t_0.975 = 2.364624 for 7 degrees of freedom.
  std::vector<std::vector<double>> members;
  for (const double value : {2., 4., 4., 4., 5., 5., 7., 9.}) members.push_back({value, 3.0});
  const io::Bands found = bands_of(members, band_rule(8), "x", "m", {2});
  const double deviation = std::sqrt(32.0 / 7);
  EXPECT_NEAR(found.mean[0], 5, 1e-14);
  EXPECT_NEAR(found.deviation[0], deviation, 1e-14);
  EXPECT_NEAR(found.mean_half_width[0], 2.364624 * deviation / std::sqrt(8.0), 1e-6);
  EXPECT_NEAR(found.prediction_half_width[0], 2.364624 * deviation * std::sqrt(9.0 / 8), 1e-6);
  EXPECT_EQ(found.mean[1], 3.0);
  EXPECT_EQ(found.prediction_half_width[1], 0.0);
  EXPECT_EQ(found.members.size(), 16U);
}

TEST(BandsTest, ASmallScatterBesideALargeMeanKeepsItsDigits) {
  const io::Bands found = bands_of({{1e9 + 4}, {1e9 + 7}, {1e9 + 13}, {1e9 + 16}}, band_rule(4), "x", "-", {1});
  EXPECT_NEAR(found.deviation[0], std::sqrt(30.0), 1e-7);
}

TEST(BandsTest, WhatIsNotANumberStaysSo) {
  const io::Bands found = bands_of({{NAN, 1}, {1, 2}, {2, 3}}, band_rule(3), "x", "-", {2});
  EXPECT_TRUE(std::isnan(found.mean[0]) && std::isnan(found.prediction_half_width[0]));
  EXPECT_EQ(found.mean[1], 2);
}

TEST(BandsTest, OneMemberHasNoBands) {
  EXPECT_THROW(static_cast<void>(band_rule(1)), std::invalid_argument);
  BandSums sums(2);
  EXPECT_THROW(sums.add(std::vector<double>{1.0}), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(sums.bands(band_rule(2), "x", "-", {2})), std::invalid_argument);
}

TEST(TroughFitTest, KnownTroughsAreFoundOnUnevenPlaces) {
  std::vector<double> x;
  for (int k = 0; k < 40; ++k) x.push_back(35 * std::pow(k / 39.0, 1.7));
  struct Trough {
    double largest, inflection, alpha;
  };
  for (const Trough& wanted : {Trough{0.3, 6, 0.5}, Trough{0.05, 9, 0.2}, Trough{1.2, 2.5, 3}, Trough{-0.01, 5, 1}}) {
    std::vector<double> settlement;
    for (const double place : x)
      settlement.push_back(modified_gauss(place, wanted.largest, wanted.inflection, wanted.alpha));
    const TroughFit found = fit_trough(x, settlement);
    EXPECT_NEAR(found.largest, wanted.largest, 1e-3 * std::abs(wanted.largest));
    EXPECT_NEAR(found.inflection, wanted.inflection, 1e-3 * wanted.inflection);
    EXPECT_NEAR(found.alpha, wanted.alpha, 1e-3 * wanted.alpha);
    EXPECT_LT(found.misfit, 1e-5);
    EXPECT_TRUE(found.good());
  }
}

TEST(TroughFitTest, AHalfIsTheGaussCurveAndAPlugIsTold) {
  EXPECT_NEAR(modified_gauss(3.0, 0.2, 6.0, 0.5), 0.2 * std::exp(-9.0 / 72), 1e-15);
  std::vector<double> x, plug, flat(20, 0.0);
  for (int k = 0; k < 80; ++k)
    x.push_back(35 * k / 79.0), plug.push_back((k < 6 ? 0.5 : 0) + 0.1 * std::exp(-x[k] / 10));
  EXPECT_FALSE(fit_trough(x, plug).good());
  EXPECT_EQ(fit_trough(std::span(x).first(20), flat).largest, 0);
}

/// A member with three increments; its result `q` is `offset` + the load.
MemberResults member(double offset) {
  MemberResults made{.folder = "member"};
  for (int k = 1; k <= 3; ++k) {
    io::IncrementInfo info{.index = k, .stage = "volume_loss", .stage_index = k, .load_parameter = 0.1 * k};
    info.converged = k != 2 || offset > 0;
    info.wall_s = 7;
    info.extra["q"] = {offset + info.load_parameter, "Pa"};
    info.extra["slowest_point"] = {3, "-"};
    if (k == 3) info.extra["late"] = {offset, "-"};
    made.increments.push_back(info);
  }
  made.settlement.resize(3);
  made.good_trough.resize(3, false);
  return made;
}

const io::Bands* find(const std::vector<io::Bands>& all, const std::string& name) {
  for (const io::Bands& bands : all) {
    if (bands.name == name) return &bands;
  }
  return nullptr;
}

TEST(ReductionTest, IncrementsThatAllMembersHaveAreReduced) {
  std::vector<MemberResults> members{member(0), member(1), member(2)};
  members[1].increments.erase(members[1].increments.begin());  // its first file has vanished
  members[1].settlement.pop_back();
  io::EnsembleData data;
  reduce_curves(members, band_rule(3), data);
  ASSERT_EQ(data.increments.size(), 2U);
  EXPECT_EQ(data.increments[0].stage_index, 2);
  EXPECT_EQ(data.increments[0].converged, 2);
  EXPECT_EQ(data.increments[1].converged, 3);
  const io::Bands* q = find(data.curves, "q");
  ASSERT_NE(q, nullptr);
  EXPECT_EQ(q->unit, "Pa");
  EXPECT_NEAR(q->mean[0], 1.2, 1e-15);
  EXPECT_NEAR(q->deviation[1], 1, 1e-15);
  EXPECT_EQ(q->members.size(), 6U);
  const io::Bands* late = find(data.curves, "late");
  ASSERT_NE(late, nullptr);
  EXPECT_TRUE(std::isnan(late->mean[0]));
  EXPECT_NEAR(late->mean[1], 1, 1e-15);
  for (const char* left_out : {"wall_s", "slowest_point", "converged", "index", "load_parameter"})
    EXPECT_EQ(find(data.curves, left_out), nullptr) << left_out;
  const std::string csv = curves_csv(data);
  EXPECT_NE(csv.find(",q_mean,q_deviation,q_mean_half_width,q_prediction_half_width"), std::string::npos);
  EXPECT_NE(csv.find("\nvolume_loss,0.2,2,"), std::string::npos);
}

TEST(ReductionTest, TheStandardErrorIsThatOfTheLastValue) {
  const std::vector<MemberResults> members{member(0), member(1), member(2)};
  // The last values are 0.3, 1.3, 2.3: deviation 1, mean 1.3.
  EXPECT_NEAR(relative_error(members, "q"), 1 / std::sqrt(3.0) / 1.3, 1e-14);
  EXPECT_THROW(static_cast<void>(relative_error(members, "none")), std::runtime_error);
  const std::vector<MemberResults> around_zero{member(-1.3), member(0.7)};
  EXPECT_FALSE(relative_error(around_zero, "q") < 1);
}

TEST(ReductionTest, K0IsReducedAtStressesThatAllMembersHave) {
  std::vector<MemberResults> members{member(0), member(0)};
  members[0].tables["k0"] = {{"ratio", "-", {1.0, 0.5, 0.5}}, {"vertical_stress", "Pa", {1e3, 1e4, 1e5}}};
  members[1].tables["k0"] = {{"ratio", "-", {1.0, 0.3, 0.3, 0.3}}, {"vertical_stress", "Pa", {1e3, 5e3, 2e4, 4e5}}};
  for (MemberResults& m : members) m.tables["row"] = {{"a", "m", {2.0}}};
  members[0].tables["alone"] = {{"a", "m", {2.0}}};
  io::EnsembleData data;
  reduce_curves(members, band_rule(2), data);
  const io::Bands *stress = find(data.tables["k0"], "vertical_stress"), *ratio = find(data.tables["k0"], "ratio");
  ASSERT_TRUE(stress != nullptr && ratio != nullptr);
  EXPECT_NEAR(stress->mean.front(), 1e3, 1e-9);
  EXPECT_NEAR(stress->mean.back(), 1e5, 1e-6);
  EXPECT_NEAR(ratio->mean.front(), 1.0, 1e-12);
  EXPECT_NEAR(ratio->mean.back(), 0.4, 1e-12);
  EXPECT_NEAR(ratio->deviation.back(), 0.2 / std::sqrt(2.0), 1e-12);
  EXPECT_TRUE(data.tables.contains("row"));
  EXPECT_FALSE(data.tables.contains("alone"));
}

TEST(ReductionTest, ARunIsAtItsEndWhereItsLastIncrementIsTheLastPlanned) {
  Case input;
  input.volume_loss.increments = 3;
  std::vector<io::IncrementInfo> increments = member(0).increments;
  EXPECT_TRUE(is_at_end(input, increments));
  increments.pop_back();
  EXPECT_FALSE(is_at_end(input, increments));
  increments.back() = {.stage = "gravity", .stage_index = 3};
  EXPECT_FALSE(is_at_end(input, increments));
  EXPECT_FALSE(is_at_end(input, {}));
  input.kind = CaseKind::pack;
  EXPECT_FALSE(is_at_end(input, member(0).increments));
  input.kind = CaseKind::column;
  EXPECT_TRUE(is_at_end(input, {{.stage = "column", .load_parameter = 1}}));
  EXPECT_FALSE(is_at_end(input, {{.stage = "column", .load_parameter = 0.9}}));
  input.kind = CaseKind::scene;
  input.scene.stages.resize(2);
  input.scene.stages.back().name = "lowering";
  EXPECT_TRUE(is_at_end(input, {{.stage = "lowering", .load_parameter = 1}}));
  EXPECT_FALSE(is_at_end(input, {{.stage = "lowering", .load_parameter = 0.5}}));
  EXPECT_FALSE(is_at_end(input, {{.stage = "gravity", .load_parameter = 1}}));
}

}  // namespace
}  // namespace voussoir::host
