#pragma once
/// The tables of a scene: [mesh], [[region]], [[support]], [[stage]], [[record]]. All readers throw io::InputError.

#include <vector>

#include "host/case/case.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {

/// Reads all tables of a scene and what relates them without the mesh itself. `input` has the tables of the grains
/// already, from which regions take what they do not say.
[[nodiscard]] SceneCase read_scene(const io::Table& root, const Case& input);

[[nodiscard]] SceneMeshCase read_scene_mesh(const io::Table& table);
[[nodiscard]] std::vector<RegionCase> read_regions(const io::Table& root, const Case& input);
[[nodiscard]] std::vector<StageCase> read_stages(const io::Table& root);

// What the readers share.

/// Names of regions, stages, records and boundaries become parts of the names of columns.
inline const io::TextRule column_name_rule{
    .pattern = "[A-Za-z0-9_-]{1,64}",
    .fault = "names columns of results: it must have 1 to 64 letters, digits, _ or -",
    .default_words = {}};

/// Coordinates and displacements.
inline const io::QuantityRule coordinate_rule{.at_least = "-10 km", .at_most = "10 km"};

/// A place that may be left out.
[[nodiscard]] std::optional<PlaceCase> read_place(const io::Table& table, const io::Key& key);

/// Throws at the key `name` of the last of these tables where an earlier one has the same name.
void check_new_name(const io::Table& table, const std::string& name, const std::vector<std::string>& earlier);

}  // namespace voussoir::host
