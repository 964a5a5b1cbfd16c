// Presets of the engine: their values, single keys over them, what is said of their error.
#include "host/case/engine.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "host/case/load_case.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {
namespace {

Case case_of(const char* kind, const std::vector<std::string>& overrides) {
  const std::filesystem::path file = "preset_under_test.toml";
  std::ofstream(file) << "kind = '" << kind << "'\n";
  return load_case(file, overrides);
}

Case probe_case(const std::vector<std::string>& overrides) { return case_of("probe", overrides); }

TEST(EnginePresets, TheDeclarationsAreThoseOfStandard) {
  const EngineCase declared, standard = engine_preset("standard"), read = probe_case({}).engine;
  for (const EngineCase& engine : {standard, read}) {
    EXPECT_EQ(engine.preset, "standard");
    EXPECT_EQ(engine.precision, declared.precision);
    EXPECT_EQ(engine.inertial_number, declared.inertial_number);
    EXPECT_EQ(engine.hold_tolerance, declared.hold_tolerance);
    EXPECT_EQ(engine.hold_cap, declared.hold_cap);
    EXPECT_EQ(engine.skin, declared.skin);
    EXPECT_EQ(engine.minimum_steps, declared.minimum_steps);
    EXPECT_EQ(engine.maximum_steps, declared.maximum_steps);
  }
}

TEST(EnginePresets, AreOrderedByAccuracy) {
  const EngineCase fast = engine_preset("fast"), standard = engine_preset("standard"),
                   reference = engine_preset("reference");
  EXPECT_GT(fast.inertial_number, standard.inertial_number);
  EXPECT_GT(standard.inertial_number, reference.inertial_number);
  EXPECT_GE(fast.hold_tolerance, standard.hold_tolerance);
  EXPECT_GT(standard.hold_tolerance, reference.hold_tolerance);
  EXPECT_EQ(reference.precision, kernels::Precision::float64);
}

TEST(EnginePresets, SingleKeysOverrideThem) {
  const EngineCase engine = probe_case({"engine.preset=reference", "engine.precision=float", "engine.hold_cap=7"})
                                .engine;
  EXPECT_EQ(engine.precision, kernels::Precision::float32);
  EXPECT_EQ(engine.hold_cap, 7);
  EXPECT_EQ(engine.inertial_number, engine_preset("reference").inertial_number);
}

TEST(EnginePresets, CountForTheFingerprintThroughTheirValues) {
  const auto fingerprint = [](const std::vector<std::string>& overrides) { return probe_case(overrides).fingerprint; };
  EXPECT_NE(fingerprint({}), fingerprint({"engine.preset=fast"}));
  const EngineCase fast = engine_preset("fast"), standard = engine_preset("standard");
  std::vector<std::string> values{"engine.preset=fast", "engine.precision=float"};
  values.push_back("engine.inertial_number=" + std::to_string(standard.inertial_number));
  values.push_back("engine.hold_tolerance=" + std::to_string(standard.hold_tolerance));
  values.push_back("engine.hold_cap=" + std::to_string(standard.hold_cap));
  values.push_back("engine.minimum_steps=" + std::to_string(standard.minimum_steps));
  values.push_back("engine.maximum_steps=" + std::to_string(standard.maximum_steps));
  values.push_back("engine.skin=" + std::to_string(standard.skin));
  ASSERT_NEAR(std::stod(std::to_string(standard.inertial_number)), standard.inertial_number, 1e-12);
  EXPECT_EQ(fingerprint(values), fingerprint({}));
}

TEST(EnginePresets, TheirErrorIsOnlyClaimedForTheirValues) {
  for (const std::string& name : engine_preset_names()) {
    const std::string note = engine_note(engine_preset(name), SoilCase{});
    EXPECT_NE(note.find(name), std::string::npos);
    EXPECT_NE(note.find('%'), std::string::npos) << note;
  }
  const std::string note = engine_note(probe_case({"engine.preset=fast", "engine.hold_cap=7"}).engine, SoilCase{});
  EXPECT_EQ(note.find('%'), std::string::npos) << note;
  EXPECT_NE(note.find("hold_cap"), std::string::npos) << note;
}

TEST(EnginePresets, DeferOnAMeshOnlyAndNotWhereItIsSwitchedOff) {
  const double fast = engine_preset("fast").defer;
  EXPECT_GT(fast, 0);
  EXPECT_EQ(engine_preset("standard").defer, 0);
  EXPECT_EQ(engine_preset("reference").defer, 0);
  EXPECT_EQ(case_of("column", {"engine.preset=fast"}).engine.defer, fast);
  EXPECT_EQ(case_of("column", {"engine.preset=fast", "engine.defer=0"}).engine.defer, 0);
  EXPECT_EQ(probe_case({"engine.preset=fast"}).engine.defer, 0);
}

TEST(EnginePresets, WhatDeferralCostsIsSaidWhereItIsOn) {
  EXPECT_EQ(engine_note(probe_case({}).engine, SoilCase{}).find("deferred"), std::string::npos);
  EngineCase deferring;
  deferring.defer = 2e-3;
  const std::string note = engine_note(deferring, SoilCase{});
  EXPECT_NE(note.find("deferred up to 0.002"), std::string::npos) << note;
  EXPECT_NE(note.find("standard: "), std::string::npos) << "its error is still that of the grains: " << note;
}

TEST(EnginePresets, AnUnknownOneIsRefused) {
  try {
    (void)probe_case({"engine.preset=quick"});
    FAIL() << "it was taken";
  } catch (const io::InputError& error) {
    EXPECT_STREQ(error.what(), "--set engine.preset: must be one of fast, standard, reference, is quick");
  }
}

TEST(EngineSettings, AreThoseOfTheCase) {
  const kernels::EngineSettings settings = engine_settings(
      {.precision = kernels::Precision::float64, .hold_tolerance = 2e-5, .skin = 0.03});
  EXPECT_EQ(settings.precision, kernels::Precision::float64);
  EXPECT_EQ(settings.hold_tolerance, 2e-5);
  EXPECT_EQ(settings.skin, 0.03);
}

TEST(EngineSettings, ATangentWithoutANameIsElastic) {
  EXPECT_EQ(tangent_kind({}), kernels::TangentKind::elastic);
  EXPECT_EQ(tangent_kind(kernels::TangentKind::loading), kernels::TangentKind::loading);
  EXPECT_EQ(tangent_kind(kernels::TangentKind::contact), kernels::TangentKind::contact);
}

TEST(EngineSettings, TangentsAreReadByTheirNames) {
  using enum kernels::TangentKind;
  const std::vector<std::pair<const char*, TangentChoice>> names{
      {"auto", std::nullopt}, {"contact", contact}, {"elastic", elastic}, {"static", static_}, {"loading", loading}};
  for (const auto& [name, kind] : names) {
    EXPECT_EQ(case_of("column", {std::string("newton.tangent=") + name}).newton.tangent, kind) << name;
    EXPECT_EQ(probe_case({std::string("probe.tangent=") + name}).probe.tangent, kind) << name;
  }
  EXPECT_EQ(case_of("column", {}).newton.tangent, std::nullopt);
  EXPECT_EQ(probe_case({}).probe.tangent, contact);
  EXPECT_THROW((void)probe_case({"probe.tangent=plastic"}), io::InputError);
}

TEST(EnginePresets, AreSpokenOfWhereTheEngineDecides) {
  Case input;
  input.kind = CaseKind::tunnel;
  EXPECT_TRUE(uses_engine(input.kind, input.material));
  input.material = MaterialKind::linear_elastic;
  EXPECT_FALSE(uses_engine(input.kind, input.material));
  input.kind = CaseKind::pack;
  EXPECT_FALSE(uses_engine(input.kind, input.material));
}

}  // namespace
}  // namespace voussoir::host
