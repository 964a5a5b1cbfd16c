#include "host/case/scene_samples.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "io/key_reference.hpp"

namespace voussoir::host {

namespace {

constexpr const char* grid_mesh = R"([mesh]
shape = "grid"
x = ["0 m", "1 m"]
columns = 1
y = ["0 m", "1 m"]
rows = 1
)";

constexpr const char* tunnel_mesh = R"([mesh]
shape = "tunnel"
width = "70 m"
height = "35 m"
diameter = "5 m"
cover_ratio = 2
size_opening = "1 m"
size_far = "4 m"
)";

constexpr const char* ring_mesh = R"([mesh]
shape = "ring"
radius = "1 m"
outer = "10 m"
columns = 1
rows = 1
)";

constexpr const char* everything = R"([[region]]
name = "ground"
[[region.soil.class]]
size_to = "1 m"
[[region]]
name = "elastic"
[region.elastic]
[[support]]
boundary = "base"
fix = "x"
[[stage]]
name = "stage"
steps = 1
[[stage.move]]
boundary = "top"
x = "1 m"
[[stage.press]]
boundary = "top"
pressure = "1 kPa"
[[stage.release]]
boundary = "base"
[[stage.excavate]]
region = "elastic"
[[record]]
name = "record"
region = "ground"
)";

/// Which shapes need a key of [mesh] that not all of them have.
const char* shapes_of(std::string_view key) {
  struct Row {
    std::vector<std::string_view> keys;
    const char* shapes;
  };
  static const std::vector<Row> rows{
      {{"mesh.x", "mesh.y"}, "must be given for a `grid`"},
      {{"mesh.columns", "mesh.rows"}, "must be given for a `grid` and a `ring`"},
      {{"mesh.width", "mesh.height", "mesh.diameter", "mesh.cover_ratio", "mesh.size_opening", "mesh.size_far"},
       "must be given for a `half_tunnel` and a `tunnel`"},
      {{"mesh.radius", "mesh.outer"}, "must be given for a `ring`"}};
  for (const Row& row : rows) {
    if (std::find(row.keys.begin(), row.keys.end(), key) != row.keys.end()) return row.shapes;
  }
  return nullptr;
}

void state_default(io::KeyInfo& info) {
  if (const char* words = shapes_of(info.key)) {
    info.required = false;
    info.default_words = words;
  }
  constexpr std::string_view region = "region[].";
  for (const std::string table : {"soil", "packing"}) {
    const std::string prefix = std::string(region) + table + ".";
    if (!info.key.starts_with(prefix)) continue;
    info.like = info.key.substr(region.size());
    if (info.key.find("[].", prefix.size()) == std::string::npos) info.default_words = "the value of `[" + table + "]`";
  }
}

/// Adds what is not there yet, behind the last key of the same table.
void add_new(std::vector<io::KeyInfo>& to, const std::vector<io::KeyInfo>& more) {
  for (const io::KeyInfo& info : more) {
    const auto is_known = [&](const io::KeyInfo& known) { return known.key == info.key; };
    if (std::any_of(to.begin(), to.end(), is_known)) continue;
    const auto is_beside = [&](const io::KeyInfo& known) {
      return io::parent_of(known.key) == io::parent_of(info.key);
    };
    const auto last = std::find_if(to.rbegin(), to.rend(), is_beside);
    to.insert(last == to.rend() ? to.end() : last.base(), info);
  }
}

}  // namespace

std::vector<std::string> scene_samples() {
  return {std::string(grid_mesh) + everything, std::string(tunnel_mesh) + everything,
          std::string(ring_mesh) + everything};
}

io::KeyList join_scene_keys(const std::vector<io::KeyList>& lists) {
  io::KeyList joined;
  for (const io::KeyList& list : lists) {
    add_new(joined.keys, list.keys);
    add_new(joined.tables, list.tables);
  }
  for (auto* infos : {&joined.keys, &joined.tables}) std::for_each(infos->begin(), infos->end(), state_default);
  return joined;
}

}  // namespace voussoir::host
