#pragma once
/// The engine's presets, and what they were measured to be wrong by (docs/trade.md, tools/trade).

#include <string>
#include <vector>

#include "host/case/case.hpp"

namespace voussoir::host {

[[nodiscard]] std::vector<std::string> engine_preset_names();

/// The values of a preset. Throws std::logic_error for a name that is none.
[[nodiscard]] EngineCase engine_preset(const std::string& name);

/// Preset and measured error of an engine in one line for a log; where keys differ from their preset, which do.
[[nodiscard]] std::string engine_note(const EngineCase& engine);

/// Whether [engine] decides anything of this case: packings and biaxial tests choose their own rates.
[[nodiscard]] bool uses_engine(const Case& input);

}  // namespace voussoir::host
