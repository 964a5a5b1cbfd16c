#include "host/material/mirrored_batch.hpp"

#include <numbers>
#include <stdexcept>

#include "host/case/result_fields.hpp"

namespace voussoir::host {
namespace {

std::vector<bool> every_second(std::size_t n) {
  std::vector<bool> mirrored(n);
  for (std::size_t p = 1; p < n; p += 2) mirrored[p] = true;
  return mirrored;
}

/// Mirrors x to -x and moves the grains back into the mirrored cell, whose first vector is the mirror image of the old
/// one with the opposite sign.
void mirror(io::RveSnapshot& rve) {
  const double a_x = rve.cell[0];
  const double a_y = -rve.cell[2];
  rve.cell = {a_x, -rve.cell[1], a_y, rve.cell[3]};
  for (double& x : rve.x) x = a_x - x;
  for (double& y : rve.y) y += a_y;
  for (double& angle : rve.rotation) angle = -angle;
  for (std::size_t k = 0; k < rve.branch.size(); k += 2) {
    rve.branch[k] = -rve.branch[k];
    rve.force[k] = -rve.force[k];
  }
}

}  // namespace

MirroredBatch::MirroredBatch(std::unique_ptr<fem::MaterialBatch> batch)
    : batch_(std::move(batch)), mirrored_(every_second(batch_->size())) {}

MirroredBatch::MirroredBatch(std::unique_ptr<fem::MaterialBatch> batch, std::vector<bool> mirrored)
    : batch_(std::move(batch)), mirrored_(std::move(mirrored)) {
  if (mirrored_.size() != batch_->size()) throw std::invalid_argument("each point is mirrored or not");
}

void MirroredBatch::mirror(std::span<fem::Stress> stress, std::span<fem::Tangent> tangent) const {
  for (std::size_t p = 0; p < stress.size(); ++p) {
    if (!is_mirrored(p)) continue;
    stress[p][2] = -stress[p][2];
    if (tangent.empty()) continue;
    for (const int k : {0, 1}) {
      tangent[p](k, 2) = -tangent[p](k, 2);
      tangent[p](2, k) = -tangent[p](2, k);
    }
  }
}

fem::BatchReport MirroredBatch::evaluate(std::span<const fem::Gradient> gradients, std::span<fem::Stress> stress,
                                         std::span<fem::Tangent> tangent) {
  std::vector<fem::Gradient> mirrored(gradients.begin(), gradients.end());
  for (std::size_t p = 0; p < mirrored.size(); ++p) {
    if (!is_mirrored(p)) continue;
    mirrored[p](0, 1) = -mirrored[p](0, 1);
    mirrored[p](1, 0) = -mirrored[p](1, 0);
  }
  fem::BatchReport report = batch_->evaluate(mirrored, stress, tangent);
  mirror(stress, tangent);
  return report;
}

void MirroredBatch::committed(std::span<fem::Stress> stress, std::span<fem::Tangent> tangent) const {
  batch_->committed(stress, tangent);
  mirror(stress, tangent);
}

std::vector<fem::PointField> MirroredBatch::fields() const {
  std::vector<fem::PointField> fields = batch_->fields();
  for (fem::PointField& field : fields) {
    const ResultField* row = find_result_field(field.name);
    if (row == nullptr)
      throw std::logic_error("the table of result fields has no row for the field " + field.name +
                             ", so that it cannot be mirrored");
    if (row->mirror == Mirror::none) continue;
    const bool is_axis = row->mirror == Mirror::axis_from_x;
    for (std::size_t p = 0; p < field.values.size(); ++p) {
      if (!is_mirrored(p)) continue;
      // The angles of an axis fill half a circle, (-pi/2, pi/2]: the vertical axis, pi/2, is its own mirror image.
      if (!is_axis || field.values[p] < 0.5 * std::numbers::pi) field.values[p] = -field.values[p];
    }
  }
  return fields;
}

std::vector<io::RveSnapshot> MirroredBatch::snapshots(std::span<const std::int64_t> points) const {
  const auto* source = dynamic_cast<const SnapshotSource*>(batch_.get());
  if (source == nullptr) return {};
  std::vector<io::RveSnapshot> snapshots = source->snapshots(points);
  for (std::size_t k = 0; k < snapshots.size(); ++k) {
    if (is_mirrored(static_cast<std::size_t>(points[k]))) voussoir::host::mirror(snapshots[k]);
  }
  return snapshots;
}

}  // namespace voussoir::host
