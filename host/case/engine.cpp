#include "host/case/engine.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <stdexcept>

#include "host/case/accuracy.hpp"
#include "host/case/keys.hpp"
#include "kernels/advance_rves.hpp"
#include "kernels/isa/choose_lanes.hpp"

namespace voussoir::host {

namespace {

struct Preset {
  EngineCase values;
  const char* error;  ///< the measured error of the stress, see docs/validation/trade.md
};

const std::array<Preset, 3>& presets() {
  static const std::array<Preset, 3> all{{
      {{.preset = "fast", .inertial_number = 1e-3, .minimum_steps = 10, .maximum_steps = 1000, .defer = 1e-3},
       "along a path the stress is off by 3 % of p at 1 kPa, 2 % at 10 kPa, 1.2 % at 100 kPa, 0.4 % at 800 kPa (rms "
       "over packings)"},
      {{.preset = "standard"},
       "along a path the stress is off by 3 % of p at 1 kPa, 0.8 % at 10 kPa, 0.3 % at 100 kPa, 0.1 % at 800 kPa (rms "
       "over packings)"},
      {{.preset = "reference",
        .precision = kernels::Precision::float64,
        .inertial_number = 3e-5,
        .hold_tolerance = 1e-4,
        .hold_cap = 10000,
        .minimum_steps = 300,
        .maximum_steps = 200000},
       "along a path the stress is off by 1 % of p at 1 kPa (repeated runs differ as much), 0.02 % at 100 kPa, 0.03 % "
       "at 800 kPa (rms over packings, under compression)"},
  }};
  return all;
}

const Preset& find(const std::string& name) {
  for (const Preset& preset : presets()) {
    if (preset.values.preset == name) return preset;
  }
  throw std::logic_error("there is no preset of the name " + name);
}

/// The keys of `engine` whose values differ from those of the preset.
std::string overridden(const EngineCase& engine, const EngineCase& preset) {
  std::string names;
  const auto compare = [&](const char* name, const auto& a, const auto& b) {
    if (a != b) names += names.empty() ? name : std::string(", ") + name;
  };
  compare("precision", engine.precision, preset.precision);
  compare("inertial_number", engine.inertial_number, preset.inertial_number);
  compare("hold_tolerance", engine.hold_tolerance, preset.hold_tolerance);
  compare("hold_cap", engine.hold_cap, preset.hold_cap);
  compare("skin", engine.skin, preset.skin);
  compare("minimum_steps", engine.minimum_steps, preset.minimum_steps);
  compare("maximum_steps", engine.maximum_steps, preset.maximum_steps);
  return names;
}

/// Reads `accuracy`, or the keys that it decides, which must not be set beside it.
void read_rates(const io::Table& table, EngineCase& engine) {
  read_quantity(
      table,
      {"accuracy",
       "Error of the stress over the pressure that a run may have, such as \"1 %\": each representative volume "
       "element gets the largest inertial number whose measured error is below it (docs/validation/trade.md). "
       "It replaces `inertial_number`, `hold_tolerance`, `minimum_steps` and `maximum_steps`, which must not "
       "stand beside it; 0 leaves the choice to these keys, and the finest value is 0.05 %. Kinds `biaxial` "
       "and `calibrate` take 0 only."},
      io::Dimension::none, engine.accuracy, {.at_least = "0", .at_most = "0.1"});
  if (engine.accuracy > 0) {
    if (engine.accuracy < finest_accuracy) {
      throw table.error("accuracy",
                        fmt::format("must be 0 (off) or at least {:g}: nothing finer was measured", finest_accuracy));
    }
    for (const char* key : {"inertial_number", "hold_tolerance", "minimum_steps", "maximum_steps"}) {
      if (table.has(key)) throw table.error(key, "is decided by engine.accuracy");
    }
    return apply_accuracy(engine);
  }
  read_quantity(
      table,
      {"inertial_number",
       "Inertial number of an increment, which says how fast the grains are strained; smaller values are nearer "
       "to quasi-static loading and cost more steps. At 100 kPa the error along a path is 1.2 % of the "
       "pressure with 1e-3, 0.32 % with 3e-4 and 0.10 % with 1e-4 (docs/validation/trade.md)."},
      io::Dimension::none, engine.inertial_number, {.at_least = "1e-6", .at_most = "1e-2"});
  read_quantity(table,
                {"hold_tolerance",
                 "Unbalanced force ratio at which the hold behind an increment ends, in which grains come to rest. It "
                 "decides the noise of the stress rather than the stress: between 1e-3 and 1e-4 the error along a path "
                 "at 100 kPa stays 0.13 % (docs/validation/trade.md)."},
                io::Dimension::none, engine.hold_tolerance, {.at_least = "1e-6", .at_most = "0.1"});
  read_integer(
      table,
      {"minimum_steps",
       "Least number of time steps in which an increment of strain is put on the grains. Fewer steps make small "
       "increments cheaper; what this costs is measured in docs/validation/trade.md."},
      engine.minimum_steps, {.at_least = 1, .at_most = 10'000'000});
  read_integer(
      table,
      {"maximum_steps",
       "Largest number of time steps in which an increment of strain is put on the grains, whatever the inertial "
       "number asks for. At low pressure this bound decides: too few steps make the sand too weak "
       "(docs/validation/trade.md)."},
      engine.maximum_steps, {.at_least = 1, .at_most = 10'000'000});
  if (engine.maximum_steps < engine.minimum_steps) throw table.error("maximum_steps", "is smaller than minimum_steps");
}

/// The processor of this command decides what the key may be: a set that cannot be taken here is a fault of the input.
InstructionSetChoice read_instruction_set(const io::Table& table) {
  const auto isa = kernels::find_instruction_set(table.choice(
      {"isa",
       "Instruction set of the processor that moves the grains: none beyond plain x86-64, AVX2 or AVX-512. It decides "
       "the speed and no bit of a result; a set that the processor lacks is refused."},
      {"auto", "scalar", "v3", "v4"}, "auto"));
  if (isa) {
    const std::string fault = kernels::why_not(*isa);
    if (!fault.empty()) throw table.error("isa", fmt::format("\"{}\" {}", kernels::name_of(*isa), fault));
  }
  return isa;
}

/// RVEs of a mesh may be advanced by a GPU; few RVEs would leave most of it idle.
Backend read_backend(const io::Table& table, bool on_a_mesh) {
  const std::string name = table.choice(
      {"backend",
       "Where the grains of a mesh are moved: on a GPU where one is found, always by the processor, or always on a "
       "GPU, "
       "without which the run ends at once. The results agree as repeats of a run do. Kinds without a mesh run on the "
       "processor."},
      {"auto", "lanes", "gpu"}, "auto");
  if (name == "gpu" && !on_a_mesh)
    throw table.error("backend", "\"gpu\" is for kinds with a mesh only: all other kinds run a few RVEs, by lanes");
  if (!on_a_mesh || name == "lanes") return Backend::lanes;
  return name == "gpu" ? Backend::gpu : Backend::automatic;
}

}  // namespace

EngineCase read_engine(const io::Table& table, bool on_a_mesh) {
  EngineCase engine = engine_preset(table.choice(
      {"preset",
       "Set of values for the other keys of this table, which single keys override. At 100 kPa the stress along a path "
       "is "
       "off by 1.2 % of the pressure with `fast`, by 0.3 % with `standard` and, under compression, by 0.02 % with "
       "`reference` (docs/validation/trade.md)."},
      engine_preset_names(), EngineCase{}.preset));
  const char* width = engine.precision == kernels::Precision::float32 ? "float" : "double";
  engine.precision = table.choice(
                         {"precision",
                          "Numbers in which forces between grains are computed: 4 or 8 bytes. Errors along a path are "
                          "the "
                          "same to two digits, and `double` takes 1.8 times the time (docs/validation/trade.md)."},
                         {"float", "double"}, width) == "float"
                         ? kernels::Precision::float32
                         : kernels::Precision::float64;
  engine.backend = read_backend(table, on_a_mesh);
  engine.isa = read_instruction_set(table);
  read_rates(table, engine);
  read_integer(
      table,
      {"hold_cap",
       "Largest number of time steps of the hold behind an increment. Grains that are still in motion then have "
       "the status `step_limit`, and their stress may be wrong; the log counts them. On a mesh 1000 is too few "
       "for grains that have just collapsed (docs/validation/trade.md)."},
      engine.hold_cap, {.at_least = 0, .at_most = 10'000'000});
  read_quantity(table,
                {"skin",
                 "Distance over the mean grain diameter up to which grains count as neighbours before they touch. It "
                 "changes the time of a run and no result; between 0.05 and 0.3 the time changes by 15 % "
                 "(docs/validation/trade.md)."},
                io::Dimension::none, engine.skin, {.at_least = "0.005", .at_most = "1"});
  if (!on_a_mesh) engine.defer = 0;  // even where the preset defers
  read_quantity(
      table,
      {"defer",
       "Change of stress over pressure up to which a representative volume element on a mesh answers by its "
       "tangent and its grains are moved later; 0 moves the grains always. In cases/tunnel_quick "
       "1e-3 saved a quarter of the work of `fast`, and no deferred answer was off by more than 8.2e-4 of the "
       "pressure (docs/validation/trade.md). Kinds without a mesh take 0 only."},
      io::Dimension::none, engine.defer, {.at_least = "0", .at_most = "0.1"});
  if (!on_a_mesh && engine.defer > 0)
    throw table.error("defer", "is for kinds with a mesh only: in all other kinds the grains of every RVE have to run");
  return engine;
}

TangentChoice read_tangent(const io::Table& table, const io::Key& key, TangentChoice otherwise) {
  using enum kernels::TangentKind;
  const std::string automatic = "auto";
  std::vector<std::string> names{automatic};
  for (const kernels::TangentKind kind : {contact, elastic, static_, loading})
    names.emplace_back(kernels::name_of(kind));
  const std::string name = table.choice(key, names, otherwise ? kernels::name_of(*otherwise) : automatic);
  for (const kernels::TangentKind kind : {contact, elastic, static_, loading}) {
    if (name == kernels::name_of(kind)) return kind;
  }
  return {};
}

std::vector<std::string> engine_preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.push_back(preset.values.preset);
  return names;
}

EngineCase engine_preset(const std::string& name) { return find(name).values; }

std::string engine_note(const EngineCase& engine, const SoilCase& soil) {
  const Preset& preset = find(engine.preset);
  const std::string others = overridden(engine, preset.values);
  std::string note = "engine preset " + engine.preset;
  if (engine.accuracy > 0)
    note = accuracy_note(engine, soil);
  else if (others.empty())
    note += fmt::format(": {} (docs/validation/trade.md)", preset.error);
  else
    note += fmt::format(
        ", with other values of {}: the measured error of the preset may not hold (docs/validation/trade.md)", others);
  if (engine.defer > 0) {
    note += fmt::format(
        "; RVEs are deferred up to {:g} of p: the log says at the end of each stage how far they were off; in "
        "tunnel_quick "
        "it was 2e-4 of p with defer = 3e-4, 8e-4 with 1e-3, 2e-3 and once 2e-2 with 3e-3",
        engine.defer);
  }
  return note;
}

kernels::TangentKind tangent_kind(TangentChoice choice) { return choice.value_or(kernels::TangentKind::elastic); }

kernels::EngineSettings engine_settings(const EngineCase& engine) {
  return {.precision = engine.precision, .skin = engine.skin, .hold_tolerance = engine.hold_tolerance};
}

bool uses_engine(CaseKind kind, MaterialKind material) {
  return kind == CaseKind::probe || (runs_on_a_mesh(kind) && material == MaterialKind::grains);
}

}  // namespace voussoir::host
