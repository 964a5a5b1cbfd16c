#include "host/packing/packed_rve.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace voussoir::host {

std::vector<kernels::GrainMaterial> grain_materials(const SoilCase& soil) {
  const auto material = [](const auto& from) {
    return kernels::GrainMaterial{.modulus = from.modulus,
                                  .stiffness_ratio = from.stiffness_ratio,
                                  .friction = std::tan(from.friction_angle),
                                  .rolling_stiffness = from.rolling_stiffness,
                                  .rolling_limit = from.rolling_limit};
  };
  if (soil.classes.empty()) return {material(soil)};
  std::vector<kernels::GrainMaterial> out;
  for (const GrainClassCase& grains : soil.classes) out.push_back(material(grains));
  return out;
}

std::vector<std::uint8_t> classes_of(const SoilCase& soil, std::span<const double> radii) {
  std::vector<std::uint8_t> out;
  for (std::size_t i = 0; i < radii.size() && soil.classes.size() > 1; ++i) {
    std::size_t k = 0;
    while (k + 1 < soil.classes.size() && 2.0 * radii[i] > soil.classes[k].size_to) ++k;
    out.push_back(static_cast<std::uint8_t>(k));
  }
  return out;
}

kernels::Packing packing_of(const SoilCase& soil, std::vector<double> radii, double thickness) {
  return {.radii = radii,
          .materials = grain_materials(soil),
          .class_of = classes_of(soil, radii),
          .thickness = thickness,
          .local_damping = soil.damping};
}

double void_ratio(double cell_area, double solid_area) { return cell_area / solid_area - 1.0; }

kernels::RveBatch batch_of(std::span<const PackedRve> rves) {
  std::vector<kernels::Packing> packings;
  std::vector<int> packing_of;
  for (const PackedRve& rve : rves) {
    packing_of.push_back(static_cast<int>(packings.size()));
    packings.push_back(rve.packing);
  }
  kernels::RveBatch batch = kernels::make_batch(std::move(packings), std::move(packing_of));
  for (std::size_t k = 0; k < rves.size(); ++k) store_rve(rves[k], batch, k);
  return batch;
}

void store_rve(const PackedRve& from, kernels::RveBatch& batch, std::size_t rve) {
  kernels::RveStates& to = batch.committed;
  if (static_cast<int>(from.contact_key.size()) > to.contact_capacity()) {
    throw std::invalid_argument("a packing has more contacts than so many discs can have");
  }
  batch.candidates.skin[rve] = -1.0;
  std::copy(from.position.begin(), from.position.end(), &to.position(rve, 0, 0));
  std::copy(from.rotation.begin(), from.rotation.end(), &to.rotation(rve, 0));
  const double h[4] = {from.cell.xx, from.cell.xy, from.cell.yx, from.cell.yy};
  for (std::size_t k = 0; k < 4; ++k) to.cell(rve, k) = h[k];
  to.contact_count(rve) = static_cast<int>(from.contact_key.size());
  std::copy(from.contact_key.begin(), from.contact_key.end(), &to.contact_key(rve, 0));
  std::copy(from.contact_history.begin(), from.contact_history.end(), to.histories_of(rve));
}

void load_rve(const kernels::RveStates& from, std::size_t rve, PackedRve& to) {
  const std::size_t n = to.packing.radii.size();
  const auto contacts = static_cast<std::size_t>(from.contact_count(rve));
  to.position.assign(&from.position(rve, 0, 0), &from.position(rve, 0, 0) + 2 * n);
  to.rotation.assign(&from.rotation(rve, 0), &from.rotation(rve, 0) + n);
  to.cell = {from.cell(rve, 0), from.cell(rve, 1), from.cell(rve, 2), from.cell(rve, 3)};
  to.contact_key.assign(&from.contact_key(rve, 0), &from.contact_key(rve, 0) + contacts);
  to.contact_history.assign(from.histories_of(rve), from.histories_of(rve) + from.history_size() * contacts);
}

}  // namespace voussoir::host
