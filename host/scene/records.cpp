#include "host/scene/records.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "fem/gauss_points.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// 0 for elements that stay; the higher, the sooner an element is dug out.
std::vector<int> dug_out_rank(const Scene& scene) {
  const fem::Mesh& mesh = scene.mesh;
  std::vector<int> rank(static_cast<std::size_t>(mesh.n_elements()), 0);
  const auto n = static_cast<int>(scene.input.stages.size());
  for (int s = 0; s < n; ++s) {
    for (const ExcavateCase& dug : scene.input.stages[s].excavations) {
      for (int e = 0; e < mesh.n_elements(); ++e) {
        if (mesh.in_region(e, dug.regions)) rank[e] = n - s;
      }
    }
  }
  return rank;
}

void add_place(PlacedRecord& record, const fem::Mesh& mesh, const std::vector<int>& rank, const fem::Point& x,
               double along) {
  const std::optional<fem::Located> found = fem::locate(mesh, mesh.coordinates, x, rank);
  if (!found) return;
  record.places.push_back(*found);
  record.coordinates.push_back(x);
  record.along.push_back(along);
}

/// The node where a plan holds it as a point, else -1.
int held_node(int node, const std::vector<StagePlan>& plans) {
  for (const StagePlan& plan : plans) {
    for (const Holder& holder : plan.holders)
      if (holder.target() == Target{.boundary = "", .node = node}) return node;
  }
  return -1;
}

void place_line(PlacedRecord& record, const std::array<PlaceCase, 2>& line, const fem::Mesh& mesh,
                const std::vector<int>& rank, const std::string& key) {
  const fem::Point a = coordinates_of(mesh, line[0]), b = coordinates_of(mesh, line[1]);
  if ((b - a).norm() == 0) throw std::runtime_error(key + ".line: begins and ends at one place");
  for (int k = 0; k < record.input.points; ++k) {
    const double share = record.input.points > 1 ? static_cast<double>(k) / (record.input.points - 1) : 0.0;
    add_place(record, mesh, rank, a + share * (b - a), share * (b - a).norm());
  }
}

/// Means over the elements of a region that are not dug out.
struct RegionMeans {
  double volume = 0;
  fem::PlaneTensor stress = fem::PlaneTensor::Zero();
  fem::PlaneTensor strain = fem::PlaneTensor::Zero();
  double void_ratio = 0, void_volume = 0;
};

/// The field of this name, of a material or of a file; null where there is none.
template <class Field>
const Field* find_field(const std::vector<Field>& fields, const std::string& name) {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const auto& field) { return field.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

void add_point(const PlacedRecord& record, const Ground& ground, const std::vector<fem::Stress>& stress,
               io::Quantities& to) {
  if (ground.mesh.is_dug_out(record.places.front().element)) return;
  const std::string& name = record.input.name;
  const fem::Point moved = fem::value_at(ground.mesh, record.places.front(), ground.total_displacement());
  to["displacement_" + name + "_x"] = {moved.x(), "m"};
  to["displacement_" + name + "_y"] = {moved.y(), "m"};
  const fem::Stress& s = stress[fem::nearest_gauss_point(record.places.front())];
  to["stress_" + name + "_xx"] = {s[0], "Pa"};
  to["stress_" + name + "_yy"] = {s[1], "Pa"};
  to["stress_" + name + "_xy"] = {s[2], "Pa"};
}

/// The force of what holds the point as a point.
void add_reaction(const PlacedRecord& record, const StagePlan& plan, const Eigen::VectorXd& reactions,
                  io::Quantities& to) {
  if (record.held_node < 0) return;
  for (int axis = 0; axis < 2; ++axis) {
    const auto owner = plan.owners.find(2 * record.held_node + axis);
    const bool holds = owner != plan.owners.end() && !plan.holders[owner->second].is_boundary;
    to[fmt::format("reaction_{}_{}", record.input.name, axis == 0 ? "x" : "y")] = {
        holds ? reactions[2 * record.held_node + axis] : 0.0, "N/m"};
  }
}

void add_region(const PlacedRecord& record, const Ground& ground, const std::vector<fem::Stress>& stress,
                const std::vector<fem::PlaneTensor>& strain, const std::vector<double>& void_ratio,
                io::Quantities& to) {
  const fem::GaussPoints points = fem::gauss_points(ground.mesh, ground.state.coordinates);
  RegionMeans means;
  for (const int element : record.elements) {
    for (int p = 4 * element; p < 4 * element + 4; ++p) {
      means.volume += points.volumes[p];
      means.stress += points.volumes[p] * stress[p];
      means.strain += points.volumes[p] * strain[p];
      if (void_ratio.empty() || !std::isfinite(void_ratio[p]) || points.volumes[p] == 0) continue;
      means.void_ratio += points.volumes[p] * void_ratio[p];
      means.void_volume += points.volumes[p];
    }
  }
  const std::string& name = record.input.name;
  if (means.volume == 0) return;  // all of it has been dug out
  const fem::PlaneTensor s = means.stress / means.volume;
  const double p = fem::mean_stress(s), q = fem::deviatoric_stress(s);
  to["p_" + name] = {p, "Pa"};
  to["q_" + name] = {q, "Pa"};
  to["q_over_p_" + name] = {p > 0 ? q / p : 0.0, "-"};
  to["volumetric_strain_" + name] = {fem::volumetric_strain(means.strain / means.volume), "-"};
  if (means.void_volume > 0) to["void_ratio_" + name] = {means.void_ratio / means.void_volume, "-"};
}

}  // namespace

std::vector<PlacedRecord> place_records(const Scene& scene, const std::vector<StagePlan>& plans) {
  std::vector<PlacedRecord> records;
  const std::vector<int> rank = dug_out_rank(scene);
  for (std::size_t k = 0; k < scene.input.records.size(); ++k) {
    PlacedRecord record{.input = scene.input.records[k]};
    const std::string key = fmt::format("record[{}]", k);
    if (record.input.point) {
      const fem::Point x = coordinates_of(scene.mesh, *record.input.point);
      add_place(record, scene.mesh, rank, x, 0.0);
      if (record.places.empty())
        throw std::runtime_error(
            fmt::format("{}.point: ({:.6g}, {:.6g}) m lies outside the ground", key, x.x(), x.y()));
      record.held_node = held_node(node_at(scene.mesh, *record.input.point), plans);
    } else if (record.input.line) {
      place_line(record, *record.input.line, scene.mesh, rank, key);
      if (record.places.empty()) throw std::runtime_error(key + ".line: no point of the line lies in the ground");
    } else {
      for (int e = 0; e < scene.mesh.n_elements(); ++e) {
        if (scene.mesh.in_region(e, record.input.regions)) record.elements.push_back(e);
      }
    }
    records.push_back(std::move(record));
  }
  return records;
}

void add_record_columns(const std::vector<PlacedRecord>& records, const StagePlan& plan,
                        const Eigen::VectorXd& reactions, const Ground& ground, io::Quantities& to) {
  const bool some = std::any_of(records.begin(), records.end(), [](const auto& one) { return !one.input.line; });
  if (!some) return;
  std::vector<fem::Stress> stress(static_cast<std::size_t>(ground.mesh.n_points()));
  ground.material.committed(stress, {});
  const std::vector<fem::PlaneTensor> strain = ground.total_strain();
  const bool regions = std::any_of(records.begin(), records.end(),
                                   [](const auto& one) { return !one.input.regions.empty(); });
  const std::vector<fem::PointField> fields = regions ? ground.material.fields() : std::vector<fem::PointField>{};
  const fem::PointField* void_ratio = find_field(fields, "void_ratio");
  for (const PlacedRecord& record : records) {
    if (record.input.point) {
      add_point(record, ground, stress, to);
      add_reaction(record, plan, reactions, to);
    }
    if (!record.input.regions.empty())
      add_region(record, ground, stress, strain, void_ratio == nullptr ? std::vector<double>{} : void_ratio->values,
                 to);
  }
}

std::vector<std::string> column_names(const std::vector<PlacedRecord>& records) {
  std::vector<std::string> names;
  for (const PlacedRecord& record : records) {
    const std::string& name = record.input.name;
    if (record.input.point) {
      for (const char* column :
           {"displacement_{}_x", "displacement_{}_y", "stress_{}_xx", "stress_{}_yy", "stress_{}_xy"})
        names.push_back(fmt::format(fmt::runtime(column), name));
    }
    if (record.held_node >= 0)
      for (const char* axis : {"x", "y"}) names.push_back(fmt::format("reaction_{}_{}", name, axis));
    if (record.input.regions.empty()) continue;
    for (const char* column : {"p", "q", "q_over_p", "volumetric_strain", "void_ratio"})
      names.push_back(fmt::format("{}_{}", column, name));
  }
  return names;
}

std::vector<io::TableColumn> line_table(const PlacedRecord& line, const fem::Mesh& mesh,
                                        const std::vector<StagePlan>& plans, const std::filesystem::path& folder) {
  std::vector<io::TableColumn> table{{"increment", "-", {}},
                                     {"s", "m", {}},
                                     {"x", "m", {}},
                                     {"y", "m", {}},
                                     {"displacement_x", "m", {}},
                                     {"displacement_y", "m", {}},
                                     {"stress_xx", "Pa", {}},
                                     {"stress_yy", "Pa", {}},
                                     {"stress_xy", "Pa", {}}};
  for (const io::IncrementInfo& info : io::read_increments(folder / "run.h5")) {
    const std::filesystem::path file = io::increment_path(folder, info.index);
    if (!std::filesystem::exists(file)) continue;
    const std::vector<io::Field> fields = io::read_fields(file);
    const io::Field* moved = find_field(fields, "displacement");
    const io::Field* stress = find_field(fields, "stress");
    const auto plan = std::find_if(plans.begin(), plans.end(),
                                   [&](const StagePlan& one) { return one.input.name == info.stage; });
    for (std::size_t k = 0; k < line.places.size(); ++k) {
      const bool dug = plan != plans.end() && !plan->dug_out.empty() && plan->dug_out[line.places[k].element] != 0;
      fem::Point u(missing, missing);
      if (moved != nullptr && !dug) {
        const Eigen::Map<const Eigen::VectorXd> values(moved->values.data(), mesh.n_dofs());
        u = fem::value_at(mesh, line.places[k], values);
      }
      std::array<double, 3> s{missing, missing, missing};
      const auto point = static_cast<std::size_t>(fem::nearest_gauss_point(line.places[k]));
      if (stress != nullptr && !dug)
        std::copy_n(stress->values.begin() + static_cast<std::ptrdiff_t>(3 * point), 3, s.begin());
      const std::array<double, 9> row{static_cast<double>(info.index),
                                      line.along[k],
                                      line.coordinates[k].x(),
                                      line.coordinates[k].y(),
                                      u.x(),
                                      u.y(),
                                      s[0],
                                      s[1],
                                      s[2]};
      for (std::size_t c = 0; c < row.size(); ++c) table[c].values.push_back(row[c]);
    }
  }
  return table;
}

}  // namespace voussoir::host
