#pragma once
/// Scenes that together read every key of a scene, for lists of keys: no scene alone has all, since each shape has keys
/// of its own.

#include <string>
#include <vector>

#include "io/key_info.hpp"

namespace voussoir::host {

/// The tables of scenes without `kind` and the tables of the grains. Their values do not matter.
[[nodiscard]] std::vector<std::string> scene_samples();

/// The keys of all samples, each once. A key that only some shapes read is not required of a mesh; its default says in
/// words which shape needs it. The default of a key of a region's grains is the value that the scene has.
[[nodiscard]] io::KeyList join_scene_keys(const std::vector<io::KeyList>& lists);

}  // namespace voussoir::host
