#pragma once
/// [engine] as the engine takes it; its presets, and what they were measured to be wrong by (docs/trade.md,
/// tools/trade).

#include <string>
#include <vector>

#include "host/case/case.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {

/// The table [engine]. Throws io::InputError. @param on_a_mesh a kind with a mesh: only there RVEs may be deferred
[[nodiscard]] EngineCase read_engine(const io::Table& table, bool on_a_mesh);

/// The key `tangent`. Throws io::InputError.
[[nodiscard]] TangentChoice read_tangent(const io::Table& table, TangentChoice otherwise);

[[nodiscard]] std::vector<std::string> engine_preset_names();

/// The values of a preset. Throws std::logic_error for a name that is none.
[[nodiscard]] EngineCase engine_preset(const std::string& name);

/// Preset and measured error of an engine in one line for a log; where keys differ from their preset, which do.
[[nodiscard]] std::string engine_note(const EngineCase& engine);

/// What [engine] says of the engine's own settings. Of the tangents it says nothing; who wants some adds that.
[[nodiscard]] kernels::EngineSettings engine_settings(const EngineCase& engine);

/// The tangent of a choice; where none is named, the elastic one, or with teams of threads that of eq. (4), the only
/// one that teams find.
[[nodiscard]] kernels::TangentKind tangent_kind(TangentChoice choice, const EngineCase& engine);

/// Whether [engine] decides anything of a case: packings and biaxial tests choose their own rates.
[[nodiscard]] bool uses_engine(CaseKind kind, MaterialKind material);

}  // namespace voussoir::host
