#include "host/stages/ground_record.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>

#include "fem/gauss_points.hpp"
#include "host/case/result_fields.hpp"
#include "host/material/snapshot_source.hpp"

namespace voussoir::host {
namespace {

std::vector<double> flat(const Eigen::Ref<const Eigen::VectorXd>& v) { return {v.data(), v.data() + v.size()}; }

io::Field field_of(const ResultField& row, std::vector<double> values) {
  return {row.name, row.unit, row.location, row.components, std::move(values)};
}

/// A Gauss-point field; `value(point, out)` fills the components of one point.
template <class Value>
io::Field gauss_field(const ResultField& row, std::size_t points, const Value& value) {
  const auto width = static_cast<std::size_t>(row.components);
  std::vector<double> values(points * width);
  for (std::size_t p = 0; p < points; ++p) value(p, values.data() + p * width);
  return field_of(row, std::move(values));
}

void add_stress_fields(std::vector<io::Field>& fields, const std::vector<fem::Stress>& stress) {
  const std::size_t n = stress.size();
  fields.push_back(gauss_field(result_field("stress"), n, [&](std::size_t p, double* out) {
    for (int k = 0; k < 3; ++k) out[k] = stress[p][k];
  }));
  fields.push_back(gauss_field(result_field("mean_stress"), n,
                               [&](std::size_t p, double* out) { *out = fem::mean_stress(stress[p]); }));
  fields.push_back(gauss_field(result_field("deviatoric_stress"), n,
                               [&](std::size_t p, double* out) { *out = fem::deviatoric_stress(stress[p]); }));
}

void add_strain_fields(std::vector<io::Field>& fields, const std::vector<fem::PlaneTensor>& strain) {
  const std::size_t n = strain.size();
  fields.push_back(gauss_field(result_field("strain"), n, [&](std::size_t p, double* out) {
    for (int k = 0; k < 3; ++k) out[k] = strain[p][k];
  }));
  fields.push_back(gauss_field(result_field("volumetric_strain"), n,
                               [&](std::size_t p, double* out) { *out = fem::volumetric_strain(strain[p]); }));
  fields.push_back(gauss_field(result_field("deviatoric_strain"), n,
                               [&](std::size_t p, double* out) { *out = fem::deviatoric_strain(strain[p]); }));
}

/// The current coordinates for a result file; empty where the mesh has not moved.
std::vector<double> moved_coordinates(const Ground& ground) {
  if (ground.state.coordinates == ground.mesh.coordinates) return {};
  return flat(ground.state.coordinates.reshaped());
}

/// Sets the values at points that have been dug out to NaN.
void clear_dug_out(const fem::Mesh& mesh, std::vector<io::Field>& fields) {
  for (io::Field& field : fields) {
    if (field.location != io::FieldLocation::gauss || field.name == result_field("gauss_point_coordinates").name)
      continue;
    const auto width = 4 * static_cast<std::size_t>(field.components);
    for (int e = 0; e < mesh.n_elements(); ++e) {
      const auto first = field.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(e) * width);
      if (mesh.is_dug_out(e)) std::fill_n(first, width, std::numeric_limits<double>::quiet_NaN());
    }
  }
}

/// The boundaries that files have, each with its name there.
std::vector<std::pair<std::string, std::string>> names_in_files(const fem::Mesh& mesh, BoundaryNames names) {
  static constexpr std::array<std::pair<const char*, const char*>, 5> of_files{
      {{"top", "top"}, {"base", "base"}, {"axis", "left"}, {"side", "right"}, {"opening", "tunnel"}}};
  std::vector<std::pair<std::string, std::string>> all;
  if (names == BoundaryNames::of_mesh) {
    for (const auto& [name, nodes] : mesh.nodes) all.emplace_back(name, name);
    return all;
  }
  for (const auto& [ours, theirs] : of_files)
    if (mesh.nodes.contains(ours)) all.emplace_back(ours, theirs);
  return all;
}

}  // namespace

std::vector<io::Field> result_fields(const Ground& ground, const Eigen::VectorXd& reactions) {
  const auto n = static_cast<std::size_t>(ground.mesh.n_points());
  std::vector<io::Field> fields;
  fields.push_back(field_of(result_field("displacement"), flat(ground.total_displacement())));
  if (reactions.size() > 0) fields.push_back(field_of(result_field("reaction"), flat(reactions)));
  const fem::GaussPoints points = fem::gauss_points(ground.mesh, ground.state.coordinates);
  fields.push_back(field_of(result_field("gauss_point_coordinates"), flat(points.positions.reshaped())));
  std::vector<fem::Stress> stress(n);
  ground.material.committed(stress, {});
  add_stress_fields(fields, stress);
  add_strain_fields(fields, ground.total_strain());
  for (fem::PointField& field : ground.material.fields()) {
    fields.push_back({std::move(field.name), std::move(field.unit), io::FieldLocation::gauss, field.components,
                      std::move(field.values)});
  }
  clear_dug_out(ground.mesh, fields);
  return fields;
}

io::MeshData mesh_data(const fem::Mesh& mesh, BoundaryNames names) {
  io::MeshData data;
  data.coordinates = flat(mesh.coordinates.reshaped());
  for (const fem::ElementNodes& element : mesh.elements) {
    data.connectivity.insert(data.connectivity.end(), element.begin(), element.end());
  }
  for (const auto& [ours, theirs] : names_in_files(mesh, names)) {
    const std::vector<int>& nodes = mesh.nodes.at(ours);
    data.boundaries.emplace_back(theirs, std::vector<std::int64_t>(nodes.begin(), nodes.end()));
  }
  data.points.insert(mesh.points.begin(), mesh.points.end());
  if (mesh.region_names.size() > 1) {
    data.regions.assign(mesh.region.begin(), mesh.region.end());
    data.region_names = mesh.region_names;
  }
  return data;
}

io::MeshData mesh_data(const fem::Mesh& mesh, const GroundCase& soil) {
  io::MeshData data = mesh_data(mesh);
  data.geometry = {{"surface_y", soil.height}, {"unit_weight", soil.unit_weight}, {"surcharge", soil.surcharge}};
  if (mesh.nodes.contains("opening")) {
    data.geometry["diameter"] = soil.diameter;
    data.geometry["axis_depth"] = soil.height - soil.axis_height();
  }
  return data;
}

void record_ground(const Ground& ground, const IncrementReport& increment, const Eigen::VectorXd& reactions,
                   const OutputCase& output, RunRecorder& recorder) {
  std::vector<io::RveSnapshot> snapshots;
  if (const auto* source = dynamic_cast<const SnapshotSource*>(&ground.material)) {
    if (!output.rves.empty()) snapshots = source->snapshots(output.rves);
  }
  std::vector<io::Field> fields = result_fields(ground, reactions);
  std::erase_if(fields, [&](const io::Field& field) {
    return !output.fields.empty() &&
           std::find(output.fields.begin(), output.fields.end(), field.name) == output.fields.end();
  });
  recorder.add_file(increment, std::move(fields), std::move(snapshots), moved_coordinates(ground));
}

}  // namespace voussoir::host
