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
  read_quantity(table, "accuracy", io::Dimension::none, engine.accuracy, {.at_least = "0", .at_most = "0.1"});
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
  read_quantity(table, "inertial_number", io::Dimension::none, engine.inertial_number,
                {.at_least = "1e-6", .at_most = "1e-2"});
  read_quantity(table, "hold_tolerance", io::Dimension::none, engine.hold_tolerance,
                {.at_least = "1e-6", .at_most = "0.1"});
  read_integer(table, "minimum_steps", engine.minimum_steps, {.at_least = 1, .at_most = 10'000'000});
  read_integer(table, "maximum_steps", engine.maximum_steps, {.at_least = 1, .at_most = 10'000'000});
  if (engine.maximum_steps < engine.minimum_steps) throw table.error("maximum_steps", "is smaller than minimum_steps");
}

/// The processor of this command decides what the key may be: a set that cannot be taken here is a fault of the input.
InstructionSetChoice read_instruction_set(const io::Table& table) {
  const auto isa = kernels::find_instruction_set(table.choice("isa", {"auto", "scalar", "v3", "v4"}, "auto"));
  if (isa) {
    const std::string fault = kernels::why_not(*isa);
    if (!fault.empty()) throw table.error("isa", fmt::format("\"{}\" {}", kernels::name_of(*isa), fault));
  }
  return isa;
}

/// RVEs of a mesh may be advanced by a GPU; few RVEs would leave most of it idle.
Backend read_backend(const io::Table& table, bool on_a_mesh) {
  const std::string name = table.choice("backend", {"auto", "lanes", "gpu"}, "auto");
  if (name == "gpu" && !on_a_mesh)
    throw table.error("backend", "\"gpu\" is for kinds with a mesh only: all other kinds run a few RVEs, by lanes");
  if (!on_a_mesh || name == "lanes") return Backend::lanes;
  return name == "gpu" ? Backend::gpu : Backend::automatic;
}

}  // namespace

EngineCase read_engine(const io::Table& table, bool on_a_mesh) {
  EngineCase engine = engine_preset(table.choice("preset", engine_preset_names(), EngineCase{}.preset));
  const char* width = engine.precision == kernels::Precision::float32 ? "float" : "double";
  engine.precision = table.choice("precision", {"float", "double"}, width) == "float" ? kernels::Precision::float32
                                                                                      : kernels::Precision::float64;
  engine.backend = read_backend(table, on_a_mesh);
  engine.isa = read_instruction_set(table);
  read_rates(table, engine);
  read_integer(table, "hold_cap", engine.hold_cap, {.at_least = 0, .at_most = 10'000'000});
  read_quantity(table, "skin", io::Dimension::none, engine.skin, {.at_least = "0.005", .at_most = "1"});
  if (!on_a_mesh) engine.defer = 0;  // even where the preset defers
  read_quantity(table, "defer", io::Dimension::none, engine.defer, {.at_least = "0", .at_most = "0.1"});
  if (!on_a_mesh && engine.defer > 0)
    throw table.error("defer", "is for kinds with a mesh only: in all other kinds the grains of every RVE have to run");
  return engine;
}

TangentChoice read_tangent(const io::Table& table, TangentChoice otherwise) {
  using enum kernels::TangentKind;
  const std::string automatic = "auto";
  std::vector<std::string> names{automatic};
  for (const kernels::TangentKind kind : {contact, elastic, static_, loading})
    names.emplace_back(kernels::name_of(kind));
  const std::string name = table.choice("tangent", names, otherwise ? kernels::name_of(*otherwise) : automatic);
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
