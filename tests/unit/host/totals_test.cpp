// What a run has cost: kept in a checkpoint, summed in a table.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "host/record/totals.hpp"

namespace voussoir::host {
namespace {

std::vector<StageTotals> two_stages() {
  StageTotals gravity;
  gravity.stage = "gravity";
  gravity.evaluations = {2, 3};
  gravity.particle_steps = 4e8;
  gravity.lane_steps = 5e8;
  gravity.parts = {.material = 1.5, .tangents = 0.5, .assembly = 0.25, .solve = 0.5};
  gravity.output = 0.125;
  gravity.writer = {.wall = 0.5, .processor = 0.25};
  gravity.wall = 3.0;
  StageTotals loss = gravity;
  loss.stage = "volume_loss";
  loss.evaluations = {5, 9, 4};
  loss.deferral_error = {0, 2e-3, 5e-4};
  loss.step_limit_points = {0, 2, 1};
  loss.unsettled = {0, 0.02, 0.7};
  loss.out_of_range_points = {0, 40, 3};
  loss.mean_overlap = {0.01, 0.071, 0.05};
  loss.cuts = 2;
  return {gravity, loss};
}

TEST(RunTotals, ComeBackFromACheckpoint) {
  const std::vector<StageTotals> written = two_stages();
  io::Checkpoint checkpoint;
  EXPECT_TRUE(totals_from(checkpoint).empty());
  save(written, checkpoint);
  const std::vector<StageTotals> read = totals_from(checkpoint);
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(read[k].stage, written[k].stage);
    EXPECT_EQ(read[k].evaluations, written[k].evaluations);
    EXPECT_EQ(read[k].deferral_error, written[k].deferral_error);
    EXPECT_EQ(read[k].step_limit_points, written[k].step_limit_points);
    EXPECT_EQ(read[k].unsettled, written[k].unsettled);
    EXPECT_EQ(read[k].out_of_range_points, written[k].out_of_range_points);
    EXPECT_EQ(read[k].mean_overlap, written[k].mean_overlap);
    EXPECT_EQ(read[k].cuts, written[k].cuts);
    EXPECT_EQ(read[k].particle_steps, written[k].particle_steps);
    EXPECT_EQ(read[k].lane_steps, written[k].lane_steps);
    EXPECT_EQ(read[k].parts.material, written[k].parts.material);
    EXPECT_EQ(read[k].parts.tangents, written[k].parts.tangents);
    EXPECT_EQ(read[k].parts.assembly, written[k].parts.assembly);
    EXPECT_EQ(read[k].parts.solve, written[k].parts.solve);
    EXPECT_EQ(read[k].output, written[k].output);
    EXPECT_EQ(read[k].writer.wall, written[k].writer.wall);
    EXPECT_EQ(read[k].writer.processor, written[k].writer.processor);
    EXPECT_EQ(read[k].wall, written[k].wall);
  }
}

/// A checkpoint of a version that counted no steps of lanes: a share of what came since would be no share of the stage.
TEST(RunTotals, OfAnEarlierVersionSayNothingOfLanes) {
  io::Checkpoint now;
  save(two_stages(), now);
  io::Checkpoint then;
  for (const auto& [name, bytes] : now.blobs()) {
    if (!name.starts_with("totals_lane_steps") && !name.starts_with("totals_tangents")) then.put(name, bytes);
  }
  std::vector<StageTotals> read = totals_from(then);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[1].cuts, 2);
  EXPECT_EQ(read[1].parts.tangents, 0.0);
  read[1].lane_steps += 1e6;
  EXPECT_EQ(lanes_line(read[1]), "");
}

TEST(RunTotals, SayWhichShareOfTheLanesWorked) {
  StageTotals stage = two_stages()[0];
  EXPECT_NE(lanes_line(stage).find("gravity: 80.0 % of the steps"), std::string::npos) << lanes_line(stage);
  stage.lane_steps = 0;  // a continuum has no lanes
  EXPECT_EQ(lanes_line(stage), "");
}

TEST(RunTotals, SayWhatDeferralWasOffBy) {
  const std::vector<StageTotals> stages = two_stages();
  EXPECT_EQ(deferral_line(stages[0], 1e-3), "");
  const std::string line = deferral_line(stages[1], 1e-3);
  EXPECT_NE(line.find("up to 2.0e-03 "), std::string::npos) << line;
  EXPECT_NE(line.find("in 1 of 3 increments"), std::string::npos) << line;
}

TEST(RunTotals, SayWhichPointsWereNotAtRest) {
  const std::vector<StageTotals> stages = two_stages();
  EXPECT_EQ(unsettled_line(stages[0], 984), "");
  const std::string line = unsettled_line(stages[1], 984);
  EXPECT_NE(line.find("2 of 3 increments"), std::string::npos) << line;
  EXPECT_NE(line.find("up to 2 of 984"), std::string::npos) << line;
  EXPECT_NE(line.find("by 0.7 of its tolerance"), std::string::npos) << line;
}

TEST(RunTotals, SayWhereTheContactLawEnds) {
  const std::vector<StageTotals> stages = two_stages();
  EXPECT_EQ(range_line(stages[0], 984), "");
  const std::string line = range_line(stages[1], 984);
  EXPECT_NE(line.find("in 2 of 3 increments"), std::string::npos) << line;
  EXPECT_NE(line.find("up to 40 of 984"), std::string::npos) << line;
  EXPECT_NE(line.find("the largest was 7.1 %"), std::string::npos) << line;
}

TEST(RunTotals, TableSumsTheStages) {
  EXPECT_TRUE(totals_table({}).empty());
  const std::vector<std::string> lines = totals_table(two_stages());
  ASSERT_EQ(lines.size(), 5U);  // what the numbers are, head, two stages, sum
  const auto words = [](const std::string& line) {
    std::vector<std::string> found;
    std::istringstream in(line);
    for (std::string word; in >> word;) found.push_back(word);
    return found;
  };
  EXPECT_EQ(words(lines[4]), (std::vector<std::string>{"all", "5", "6.0", "3.0", "1.0", "0.5", "1.0", "0.2", "1.0",
                                                       "0.2", "4", "9", "2", "8.000e+08", "266.7"}));
  EXPECT_EQ(words(lines[2]).at(10), "2.5");
}

}  // namespace
}  // namespace voussoir::host
