// A scene that is killed in any of its stages and goes on has the bits of one that ran through.
#include <gtest/gtest.h>

#include <string>

#include "host/scene/run_stages.hpp"
#include "io/result_file.hpp"
#include "tests/same_bits.hpp"
#include "tests/scene_support.hpp"

namespace voussoir::host {
namespace {

struct Killed {};

/// Gravity, a wall that is moved, released in part and then wholly, and an excavation, on a mesh that moves throughout.
Scene five_stages() {
  Scene scene = scene_on(grid(4, 2, 4, 2, {"lower", "upper"}), 20e3);
  scene.input.supports = {support({"base"}, "xy"), support({"left", "right"}, "x")};
  StageCase push = stage("push", 2), part = stage("part", 2), all = stage("all", 2), dig = stage("dig", 2);
  push.moves = {move_by("right", -0.01, {})};
  part.releases = {{.boundary = "right", .share = 0.3}};
  dig.excavations = {{.regions = {"upper"}}};
  dig.presses = {traction_on("right", 500, 0)};
  all.presses = {pressure_on("top", 2e3)};
  StageCase weights = gravity_stage();
  weights.steps = 3;
  scene.input.stages = {weights, push, part, all, dig};
  for (std::size_t k = 1; k < 5; ++k) scene.input.stages[k].geometry = LossGeometry::updated_lagrangian;
  return scene;
}

void expect_same_files(const std::filesystem::path& one, const std::filesystem::path& other) {
  const auto a = io::read_increments(one / "run.h5"), b = io::read_increments(other / "run.h5");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].stage, b[k].stage);
    EXPECT_EQ(a[k].load_parameter, b[k].load_parameter);
    const auto fields = io::read_fields(io::increment_path(one, a[k].index));
    const auto others = io::read_fields(io::increment_path(other, b[k].index));
    ASSERT_EQ(fields.size(), others.size());
    for (std::size_t f = 0; f < fields.size(); ++f)
      // Points that are dug out have values that are no numbers.
      EXPECT_TRUE(same_bits(fields[f].values, others[f].values)) << fields[f].name << " of increment " << k;
  }
}

TEST(Resume, InEveryStageGivesTheSameBits) {
  const std::filesystem::path whole = "whole", parts = "parts";
  const std::vector<StageEnd> through = ElasticRun{.scene = five_stages()}.run(whole);
  ASSERT_EQ(through.size(), 5U);
  const std::vector<std::pair<std::string, std::vector<int>>> kills{
      {"gravity", {1}}, {"push", {0}}, {"part", {1}}, {"all", {0, 2}}, {"dig", {0, 1}}};
  for (const auto& [name, increments] : kills) {
    for (const int increment : increments) {  // 0: killed when the stage has just begun
      ElasticRun run{.scene = five_stages()};
      const auto kill = [killed = name, increment](const StagePlan& plan, int at) {
        if (plan.input.name == killed && at == increment) throw Killed();
      };
      run.on_start = [&](const StagePlan& plan) { kill(plan, 0); };
      run.on_increment = kill;
      EXPECT_THROW(static_cast<void>(run.run(parts)), Killed) << name << increment;
      run.on_start = {};
      run.on_increment = {};
      run.resume = true;
      static_cast<void>(run.run(parts));
      const testing::ScopedTrace trace(__FILE__, __LINE__, name + std::to_string(increment));
      expect_same_files(whole, parts);
    }
  }
}

}  // namespace
}  // namespace voussoir::host
