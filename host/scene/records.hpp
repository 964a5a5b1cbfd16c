#pragma once
/// The records of a scene: points and regions as columns of the table of increments, lines as tables of their own.

#include <filesystem>
#include <string>
#include <vector>

#include "fem/increment.hpp"
#include "fem/locate.hpp"
#include "host/scene/scene.hpp"
#include "host/stages/ground.hpp"
#include "io/result_data.hpp"

namespace voussoir::host {

/// A record with its places in the mesh as drawn.
struct PlacedRecord {
  RecordCase input = {};
  std::vector<fem::Located> places = {};     ///< of a point one, of a line those that lie in the ground
  std::vector<fem::Point> coordinates = {};  ///< of the places, as drawn [m]
  std::vector<double> along = {};            ///< of the places: distance from the line's first point [m]
  std::vector<int> elements = {};            ///< of the regions
  int held_node = -1;                        ///< of a point: its node, if a support or a stage holds it as a point
};

/// Throws std::runtime_error, whose text begins with the key at fault, where a point lies outside the ground or a line
/// meets none.
[[nodiscard]] std::vector<PlacedRecord> place_records(const Scene& scene, const std::vector<StagePlan>& plans);

/// Adds, of each point NAME: displacement_NAME_x, _y [m] and the stress of the nearest Gauss point, stress_NAME_xx,
/// _yy, _xy [Pa]; of regions NAME the means over their area p_NAME, q_NAME [Pa], q_over_p_NAME,
/// volumetric_strain_NAME and void_ratio_NAME [-], where q is that of the mean stress and the void ratio is of grains
/// only. What has been dug out has no columns; of elements that meet at a point, the one that stays longest counts.
/// A point that a stage of the scene holds as a point has reaction_NAME_x, _y [N/m], the force on the ground besides;
/// it is 0 where the plan has no such holder that owns its node.
void add_record_columns(const std::vector<PlacedRecord>& records, const StagePlan& plan,
                        const Eigen::VectorXd& reactions, const Ground& ground, io::Quantities& to);

/// The names of these columns.
[[nodiscard]] std::vector<std::string> column_names(const std::vector<PlacedRecord>& records);

/// Table `line_NAME`: a row for each increment's file and each place of the line, gathered from the files of the run in
/// `folder`. What a file lacks is NaN, and so is all of a place whose element has been dug out.
[[nodiscard]] std::vector<io::TableColumn> line_table(const PlacedRecord& line, const fem::Mesh& mesh,
                                                      const std::vector<StagePlan>& plans,
                                                      const std::filesystem::path& folder);

}  // namespace voussoir::host
