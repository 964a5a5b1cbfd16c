// The measured scatter between draws of packings: interpolation, and what a user reads of it.
#include "host/packing/draw_scatter.hpp"

#include <gtest/gtest.h>

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
}

}  // namespace
}  // namespace voussoir::host
