#include "host/case/key_reference.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "host/case/engine.hpp"
#include "host/case/load_case.hpp"

namespace voussoir::host {
namespace {

/// Adds the defaults that presets of the engine change.
void add_presets(io::KeyReference& reference, CaseKind kind) {
  for (const std::string& preset : engine_preset_names()) {
    if (preset == EngineCase{}.preset) continue;
    for (const io::KeyInfo& info : keys_of(kind, "[engine]\npreset = \"" + preset + "\"\n").keys) {
      const auto listed = std::find_if(reference.keys.begin(), reference.keys.end(),
                                       [&](const io::ListedKey& key) { return key.info.key == info.key; });
      if (listed->info.fallback != info.fallback) listed->other_defaults.emplace_back(preset, info.fallback);
    }
  }
}

io::KeyReference reference_of(const std::vector<CaseKind>& kinds) {
  std::vector<std::pair<std::string, io::KeyList>> lists;
  for (const CaseKind kind : kinds) lists.emplace_back(to_string(kind), keys_of(kind));
  io::KeyReference reference = io::join_kinds("case", lists);
  add_presets(reference, kinds.front());
  return reference;
}

}  // namespace

io::KeyReference case_reference(CaseKind kind) { return reference_of({kind}); }

io::KeyReference case_reference() {
  std::vector<CaseKind> kinds;
  for (const auto& [kind, name] : case_kind_names) kinds.push_back(kind);
  std::reverse(kinds.begin(), kinds.end());  // scenes and tunnels, which have the most tables, come first
  return reference_of(kinds);
}

}  // namespace voussoir::host
