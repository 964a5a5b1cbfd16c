// The measured scatter between draws of packings: interpolation, and what a user reads of it.
#include "host/packing/draw_scatter.hpp"

#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

namespace voussoir::host {
namespace {

TEST(DrawScatter, FallsWithVarietyAndGrainsAndGrowsWithVolumeLoss) {
  double before = 1;
  for (const int variety : {1, 2, 3, 4, 6, 8, 12, 16}) {
    const DrawScatter scatter = draw_scatter(variety, 300, 0.1);
    EXPECT_LE(scatter.settlement, before) << variety;
    EXPECT_GT(scatter.settlement, 0.02) << variety;
    before = scatter.settlement;
  }
  EXPECT_DOUBLE_EQ(draw_scatter(1, 1200, 0.1).settlement, 0.5 * draw_scatter(1, 300, 0.1).settlement);
  EXPECT_LT(draw_scatter(1, 300, 0.01).settlement, draw_scatter(1, 300, 0.1).settlement);
}

TEST(DrawScatter, EachResultScattersLessWithEightPackings) {
  const DrawScatter one = draw_scatter(1, 300, 0.1), eight = draw_scatter(8, 300, 0.1);
  EXPECT_LT(eight.settlement, 0.8 * one.settlement);
  EXPECT_LT(eight.reaction, 0.9 * one.reaction);  // the stress of four points gains least
  EXPECT_LT(eight.k0, 0.8 * one.k0);
  EXPECT_LT(one.k0, one.settlement);
  EXPECT_LT(one.k0, one.reaction);
}

TEST(DrawScatter, IsTheTablesBeyondItsEnds) {
  EXPECT_EQ(draw_scatter(16, 300, 0.1).settlement, draw_scatter(1000, 300, 0.1).settlement);
  EXPECT_EQ(draw_scatter(1, 300, 0.2).settlement, draw_scatter(1, 300, 0.1).settlement);
  EXPECT_EQ(draw_scatter(1, 300, 1e-4).settlement, draw_scatter(1, 300, 0.01).settlement);
}

TEST(DrawScatter, IsLinearBetweenVolumeLosses) {
  const double at_5 = draw_scatter(1, 300, 0.05).settlement, at_10 = draw_scatter(1, 300, 0.1).settlement;
  EXPECT_DOUBLE_EQ(draw_scatter(1, 300, 0.075).settlement, 0.5 * (at_5 + at_10));
}

TEST(DrawScatter, IsSaidWithTheNumbersItHoldsFor) {
  PackingCase packing;
  packing.grains = 300;
  packing.variety = 4;
  const std::string sentence = draw_sentence(packing, 0.1);
  EXPECT_NE(sentence.find("V_l = 10 %"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("variety 4 and 300 grains"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("voussoir ensemble"), std::string::npos) << sentence;
  const DrawScatter scatter = draw_scatter(4, 300, 0.1);
  EXPECT_NE(sentence.find(fmt::format("by about {:.0f} %, the least ground reaction by {:.0f} % and K0 by {:.0f} %",
                                      100 * scatter.settlement, 100 * scatter.reaction, 100 * scatter.k0)),
            std::string::npos)
      << sentence;
  packing.seeds = {1, 2};
  EXPECT_EQ(draw_sentence(packing, 0.1).find("voussoir ensemble"), std::string::npos);
}

}  // namespace
}  // namespace voussoir::host
