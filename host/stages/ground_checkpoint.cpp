#include "host/stages/ground_checkpoint.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "io/input_error.hpp"

namespace voussoir::host {
namespace {

template <class Matrix>
void put_list(io::Checkpoint& checkpoint, const std::string& name, const std::vector<Matrix>& list) {
  static_assert(sizeof(Matrix) == Matrix::SizeAtCompileTime * sizeof(double));
  const double* first = list.empty() ? nullptr : list.front().data();
  checkpoint.put_doubles(name, {first, list.size() * Matrix::SizeAtCompileTime});
}

std::vector<double> get_sized(const io::Checkpoint& checkpoint, const std::string& name, std::size_t size) {
  std::vector<double> values = checkpoint.get_doubles(name);
  if (values.size() != size) {
    throw io::InputError("--resume", "mesh",
                         "this case's mesh needs " + std::to_string(size) + " numbers of " + name +
                             ", the checkpoint was made with " + std::to_string(values.size()));
  }
  return values;
}

template <class Matrix>
std::vector<Matrix> get_list(const io::Checkpoint& checkpoint, const std::string& name, std::size_t count) {
  constexpr std::size_t width = Matrix::SizeAtCompileTime;
  const std::vector<double> values = get_sized(checkpoint, name, count * width);
  std::vector<Matrix> list(count);
  for (std::size_t k = 0; k < count; ++k) list[k] = Eigen::Map<const Matrix>(values.data() + k * width);
  return list;
}

fem::Coordinates get_coordinates(const io::Checkpoint& checkpoint, const std::string& name, const fem::Mesh& mesh) {
  const std::vector<double> values = get_sized(checkpoint, name, static_cast<std::size_t>(mesh.n_dofs()));
  return Eigen::Map<const fem::Coordinates>(values.data(), 2, mesh.n_nodes());
}

}  // namespace

void put_vector(io::Checkpoint& checkpoint, const std::string& name, const Eigen::VectorXd& values) {
  checkpoint.put_doubles(name, {values.data(), static_cast<std::size_t>(values.size())});
}

Eigen::VectorXd get_vector(const io::Checkpoint& checkpoint, const std::string& name, std::size_t size) {
  const std::vector<double> values = get_sized(checkpoint, name, size);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(size));
}

void save(const Ground& ground, io::Checkpoint& checkpoint) {
  const fem::MeshState& state = ground.state;
  put_vector(checkpoint, "displacement", state.displacement);
  checkpoint.put_doubles("coordinates", {state.coordinates.data(), static_cast<std::size_t>(state.coordinates.size())});
  put_list(checkpoint, "deformation", state.deformation);
  put_list(checkpoint, "initial_tangent", state.initial_tangent);
  put_list(checkpoint, "tangent", state.tangent);
  put_vector(checkpoint, "last_increment", state.last_increment);
  const std::array<double, 5> scalars{state.last_step, state.start, state.parameter, state.step_limit,
                                      state.relaxation_factor};
  checkpoint.put_doubles("load", scalars);
  put_list(checkpoint, "strain", ground.strain);
  if (ground.earlier.coordinates.cols() > 0) {
    put_vector(checkpoint, "earlier_displacement", ground.earlier.displacement);
    put_list(checkpoint, "earlier_strain", ground.earlier.strain);
    checkpoint.put_doubles("earlier_coordinates", {ground.earlier.coordinates.data(),
                                                   static_cast<std::size_t>(ground.earlier.coordinates.size())});
  }
  const std::shared_ptr<const fem::HeldState> material = ground.material.hold();
  checkpoint.put_late(
      "material", {[material] { return material->size(); }, [material](const auto& sink) { material->write(sink); }});
}

void restore(Ground& ground, const io::Checkpoint& checkpoint) {
  const auto dofs = static_cast<std::size_t>(ground.mesh.n_dofs());
  const auto points = static_cast<std::size_t>(ground.mesh.n_points());
  fem::MeshState state;
  state.displacement = get_vector(checkpoint, "displacement", dofs);
  state.coordinates = get_coordinates(checkpoint, "coordinates", ground.mesh);
  state.deformation = get_list<fem::Gradient>(checkpoint, "deformation", points);
  state.initial_tangent = get_list<fem::Tangent>(checkpoint, "initial_tangent", points);
  state.tangent = get_list<fem::Tangent>(checkpoint, "tangent", points);
  const bool moved = !checkpoint.get_doubles("last_increment").empty();
  state.last_increment = get_vector(checkpoint, "last_increment", moved ? dofs : 0);
  const std::vector<double> scalars = get_sized(checkpoint, "load", 5);
  state.last_step = scalars[0];
  state.start = scalars[1];
  state.parameter = scalars[2];
  state.step_limit = scalars[3];
  state.relaxation_factor = scalars[4];
  ground.state = std::move(state);
  ground.strain = get_list<fem::PlaneTensor>(checkpoint, "strain", points);
  ground.earlier = {};
  if (checkpoint.has("earlier_coordinates")) {
    ground.earlier.displacement = get_vector(checkpoint, "earlier_displacement", dofs);
    ground.earlier.strain = get_list<fem::PlaneTensor>(checkpoint, "earlier_strain", points);
    ground.earlier.coordinates = get_coordinates(checkpoint, "earlier_coordinates", ground.mesh);
  }
  ground.material.set_state(checkpoint.get("material"));
}

}  // namespace voussoir::host
