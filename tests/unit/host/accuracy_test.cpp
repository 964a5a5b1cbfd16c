// `engine.accuracy`: the curves between and beyond what was measured, what they choose, and what a case may say.
#include "host/case/accuracy.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "host/case/engine.hpp"
#include "host/case/load_case.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {
namespace {

constexpr double times[] = {5, 14.9, 25, 42, 80, 133, 300, 420.3, 2000};  ///< inertial times [steps]

TEST(Accuracy, TheErrorGrowsWithTheInertialNumberAndTheInertialTime) {
  for (const double time : times) {
    for (double i = 1e-4; i < 0.9e-2; i *= 1.3) EXPECT_LE(expected_error(i, time), expected_error(1.3 * i, time));
  }
  for (double i = 1e-4; i < 1e-2; i *= 1.3) {
    for (double time = 5; time < 1000; time *= 1.2)
      EXPECT_LE(expected_error(i, time), expected_error(i, 1.2 * time) * (1 + 1e-12)) << i << ' ' << time;
  }
}

TEST(Accuracy, TheExpectedErrorIsAtMostWhatIsAskedForUnlessTheSmallestInertialNumberHasMore) {
  for (const double time : times) {
    for (const double asked : {1e-3, 3e-3, 1e-2, 3e-2, 1e-1}) {
      const AccuracyChoice choice = choose_inertial_number(asked, time);
      EXPECT_NEAR(expected_error(choice.inertial_number, time), choice.error, 1e-9) << time << ' ' << asked;
      if (choice.error > asked) {
        EXPECT_EQ(choice.inertial_number, 1e-4) << "nothing finer was measured";
      } else if (choice.inertial_number < 1e-2) {
        EXPECT_GT(expected_error(1.05 * choice.inertial_number, time), asked) << "a larger number would do";
      }
    }
  }
}

TEST(Accuracy, FollowsTheMeasuredCurves) {
  constexpr double margin = 1.7;
  EXPECT_NEAR(expected_error(1e-3, 42.0), margin * 0.0122, 1e-9) << "100 kPa";
  EXPECT_NEAR(expected_error(3e-4, 132.9), margin * 0.0081, 1e-9) << "10 kPa";
  EXPECT_NEAR(inertial_time_of(SoilCase{}, 1e5), 42.0, 1.5) << "the curves count on the mobility that the law gives";
  EXPECT_GT(expected_error(1e-4, 1000), expected_error(1e-4, 420.3)) << "below 1 kPa it goes on growing";
  EXPECT_EQ(expected_error(1e-4, 5), expected_error(1e-4, 14.9)) << "above 800 kPa it stays";
}

TEST(Accuracy, CannotBeMetAtTheLowestPressure) {
  const double near_the_surface = inertial_time_of(SoilCase{}, 1e3), at_depth = inertial_time_of(SoilCase{}, 8e5);
  EXPECT_NEAR(near_the_surface / at_depth, std::sqrt(800.0), 1e-9);
  EXPECT_GT(choose_inertial_number(0.01, near_the_surface).error, 0.01);
  EXPECT_LE(choose_inertial_number(0.01, at_depth).error, 0.01);
  EngineCase engine;
  engine.accuracy = 0.01;
  const std::string note = accuracy_note(engine, SoilCase{});
  EXPECT_NE(note.find("1 %"), std::string::npos) << note;
  EXPECT_NE(note.find("at 1 kPa (which leaves"), std::string::npos) << note;
  SoilCase graded;
  graded.classes.resize(2);
  EXPECT_EQ(accuracy_note(engine, graded).find("kPa"), std::string::npos) << "their inertial time is not known here";
  engine.hold_cap = 0;
  EXPECT_NE(accuracy_note(engine, SoilCase{}).find("measured with holds"), std::string::npos);
}

Case case_with(const std::vector<std::string>& overrides, const char* kind = "probe") {
  const std::filesystem::path file = "accuracy_under_test.toml";
  std::ofstream(file) << "kind = '" << kind << "'\n";
  return load_case(file, overrides);
}

TEST(Accuracy, DecidesTheBoundsOfTheStepsToo) {
  const EngineCase coarse = case_with({"engine.accuracy=3 %"}).engine,
                   fine = case_with({"engine.accuracy=0.2 %"}).engine;
  EXPECT_EQ(coarse.accuracy, 0.03);
  EXPECT_GT(coarse.hold_tolerance, fine.hold_tolerance);
  EXPECT_LT(coarse.minimum_steps, fine.minimum_steps);
  EXPECT_GT(coarse.maximum_steps, EngineCase{}.maximum_steps) << "a bound that binds is an error that no curve knows";
  EXPECT_NE(case_with({"engine.accuracy=3 %"}).fingerprint, case_with({"engine.accuracy=2 %"}).fingerprint);
  EXPECT_EQ(engine_note(coarse, SoilCase{}), accuracy_note(coarse, SoilCase{}));
}

TEST(Accuracy, IsNotSaidTwice) {
  const auto complaint = [](const std::vector<std::string>& overrides, const char* kind = "probe") -> std::string {
    try {
      (void)case_with(overrides, kind);
      return "";
    } catch (const io::InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(complaint({"engine.accuracy=1 %", "engine.precision=double", "engine.hold_cap=500"}), "");
  EXPECT_EQ(complaint({"engine.accuracy=0", "engine.inertial_number=1e-3"}), "");
  for (const char* key : {"inertial_number", "hold_tolerance", "minimum_steps", "maximum_steps"}) {
    const std::string value = std::string(key).ends_with("steps") ? "100" : "1e-3";
    const std::string said = complaint({"engine.accuracy=1 %", "engine." + std::string(key) + "=" + value});
    EXPECT_NE(said.find("is decided by engine.accuracy"), std::string::npos) << key << ": " << said;
  }
  EXPECT_NE(complaint({"engine.accuracy=0.01 %"}).find("nothing finer was measured"), std::string::npos);
  EXPECT_NE(complaint({"engine.accuracy=20 %"}), "");
  EXPECT_NE(complaint({"engine.accuracy=-1 %"}), "");
  for (const char* kind : {"biaxial", "calibrate"}) {
    EXPECT_NE(complaint({"engine.accuracy=1 %"}, kind).find("tests have the rate of"), std::string::npos) << kind;
  }
  EXPECT_EQ(complaint({"engine.accuracy=1 %"}, "tunnel"), "");
}

}  // namespace
}  // namespace voussoir::host
