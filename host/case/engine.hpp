#pragma once
/// The table [engine], its presets with their measured errors (docs/validation/trade.md, tools/trade), and the settings
/// that the kernels take from it.

#include <string>
#include <vector>

#include "host/case/case.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {

/// The table [engine]. Throws io::InputError. @param on_a_mesh true for a kind with a mesh; RVEs may be deferred only
/// there
[[nodiscard]] EngineCase read_engine(const io::Table& table, bool on_a_mesh);

/// A key that chooses a tangent. Throws io::InputError.
[[nodiscard]] TangentChoice read_tangent(const io::Table& table, const io::Key& key, TangentChoice otherwise);

[[nodiscard]] std::vector<std::string> engine_preset_names();

/// The values of a preset. Throws std::logic_error where no preset has this name.
[[nodiscard]] EngineCase engine_preset(const std::string& name);

/// One line for a log: the preset of an engine and its measured error, or the keys whose values differ from the preset,
/// or what `accuracy` means for grains of this soil.
[[nodiscard]] std::string engine_note(const EngineCase& engine, const SoilCase& soil);

/// The kernels' settings as far as [engine] decides them. A caller that wants tangents adds the settings of these.
[[nodiscard]] kernels::EngineSettings engine_settings(const EngineCase& engine);

/// The tangent of a choice. A choice without a value means the elastic tangent.
[[nodiscard]] kernels::TangentKind tangent_kind(TangentChoice choice);

/// True where [engine] decides anything. It does not for packings and biaxial tests, which have rates of their own.
[[nodiscard]] bool uses_engine(CaseKind kind, MaterialKind material);

}  // namespace voussoir::host
