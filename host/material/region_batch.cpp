#include "host/material/region_batch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "host/material/rve_pool.hpp"
#include "io/byte_stream.hpp"

namespace voussoir::host {
namespace {

constexpr const char* not_of_these_regions = "the checkpoint's regions are not those of this case";

class HeldRegions final : public fem::HeldState {
 public:
  explicit HeldRegions(std::vector<std::shared_ptr<const fem::HeldState>> parts) : parts_(std::move(parts)) {}

  [[nodiscard]] std::size_t size() const override {
    std::size_t bytes = 0;
    for (const auto& part : parts_) bytes += sizeof(std::uint64_t) + part->size();
    return bytes;
  }
  void write(const Sink& sink) const override {
    for (const auto& part : parts_) {
      const std::uint64_t length = part->size();
      sink(std::as_bytes(std::span(&length, 1)));
      part->write(sink);
    }
  }
  [[nodiscard]] const std::vector<std::shared_ptr<const fem::HeldState>>& parts() const { return parts_; }

 private:
  std::vector<std::shared_ptr<const fem::HeldState>> parts_;
};

/// The values of some points of the mesh, in the order of the part.
template <class Value>
std::vector<Value> gathered(std::span<const Value> all, const std::vector<std::size_t>& points) {
  std::vector<Value> out;
  out.reserve(points.size());
  for (const std::size_t p : points) out.push_back(all[p]);
  return out;
}

template <class Value>
void scatter(const std::vector<Value>& from, const std::vector<std::size_t>& points, std::span<Value> all) {
  for (std::size_t k = 0; k < from.size(); ++k) all[points[k]] = from[k];
}

void add_field(std::vector<fem::PointField>& all, const fem::PointField& field, const std::vector<std::size_t>& points,
               std::size_t n) {
  const auto width = static_cast<std::size_t>(field.components);
  auto found = std::find_if(all.begin(), all.end(), [&](const auto& other) { return other.name == field.name; });
  if (found == all.end()) {
    const double missing = std::numeric_limits<double>::quiet_NaN();
    found = all.insert(all.end(), {field.name, field.unit, field.components, std::vector<double>(n * width, missing)});
  }
  for (std::size_t k = 0; k < points.size(); ++k)
    std::copy_n(field.values.data() + k * width, width, found->values.data() + points[k] * width);
}

}  // namespace

RegionBatch::RegionBatch(std::vector<RegionPart> parts) : parts_(std::move(parts)) {
  std::size_t n = 0;
  for (const RegionPart& part : parts_) n += part.points.size();
  part_of_.assign(n, {parts_.size(), 0});
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const std::vector<std::size_t>& points = parts_[k].points;
    if (points.size() != parts_[k].batch->size()) throw std::invalid_argument("a region's batch has other points");
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i] >= n || part_of_[points[i]].part != parts_.size())
        throw std::invalid_argument("the regions' points are not the points of one mesh");
      part_of_[points[i]] = {k, i};
    }
    retired_.emplace_back(points.size());
  }
}

void RegionBatch::begin_increment() {
  for (const RegionPart& part : parts_) part.batch->begin_increment();
}

fem::BatchReport RegionBatch::evaluate(std::span<const fem::Gradient> gradients, std::span<fem::Stress> stress,
                                       std::span<fem::Tangent> tangent) {
  std::vector<fem::BatchReport> reports;
  for (const RegionPart& part : parts_) {
    const std::vector<fem::Gradient> own = gathered(gradients, part.points);
    std::vector<fem::Stress> own_stress(part.points.size());
    std::vector<fem::Tangent> own_tangent(tangent.empty() ? 0 : part.points.size());
    reports.push_back(part.batch->evaluate(own, own_stress, own_tangent));
    scatter(own_stress, part.points, stress);
    scatter(own_tangent, part.points, tangent);
  }
  return joined(reports);
}

/// Rms values are weighted by the numbers of the points that have not been dug out.
fem::BatchReport RegionBatch::joined(const std::vector<fem::BatchReport>& reports) const {
  fem::BatchReport out;
  double noise = 0, unsettled = 0, counted = 0;
  for (std::size_t k = 0; k < reports.size(); ++k) {
    const fem::BatchReport& r = reports[k];
    const auto points = static_cast<double>(retired_[k].left());
    noise += points * r.stress_noise * r.stress_noise;
    unsettled += points * r.unsettled_stress * r.unsettled_stress;
    counted += points;
    out.usable = out.usable && r.usable;
    if (out.message.empty()) out.message = r.message;
    out.work += r.work;
    out.lane_steps += r.lane_steps;
    out.tangent_time += r.tangent_time;
    out.open += r.open;
    out.step_limit += r.step_limit;
    out.out_of_range += r.out_of_range;
    if (r.mean_overlap) out.mean_overlap = std::max(out.mean_overlap.value_or(0.0), *r.mean_overlap);
    out.deferred += r.deferred;
    out.deferral_error = std::max(out.deferral_error, r.deferral_error);
    if (r.slowest_steps > out.slowest_steps) {
      out.slowest = parts_[k].points[r.slowest];
      out.slowest_steps = r.slowest_steps;
    }
  }
  out.stress_noise = std::sqrt(noise / std::max(counted, 1.0));
  out.unsettled_stress = std::sqrt(unsettled / std::max(counted, 1.0));
  return out;
}

void RegionBatch::commit() {
  for (const RegionPart& part : parts_) part.batch->commit();
}

void RegionBatch::committed(std::span<fem::Stress> stress, std::span<fem::Tangent> tangent) const {
  for (const RegionPart& part : parts_) {
    std::vector<fem::Stress> own_stress(part.points.size());
    std::vector<fem::Tangent> own_tangent(tangent.empty() ? 0 : part.points.size());
    part.batch->committed(own_stress, own_tangent);
    scatter(own_stress, part.points, stress);
    scatter(own_tangent, part.points, tangent);
  }
}

std::vector<fem::PointField> RegionBatch::fields() const {
  std::vector<fem::PointField> all;
  for (const RegionPart& part : parts_) {
    for (const fem::PointField& field : part.batch->fields()) add_field(all, field, part.points, size());
  }
  return all;
}

std::vector<std::byte> RegionBatch::state() const {
  std::vector<std::byte> bytes;
  io::ByteWriter write(bytes);
  for (const RegionPart& part : parts_) write.list(part.batch->state());
  return bytes;
}

void RegionBatch::set_state(std::span<const std::byte> bytes) {
  io::ByteReader read(bytes, not_of_these_regions);
  for (const RegionPart& part : parts_) part.batch->set_state(read.take(read.value<std::uint64_t>()));
  if (!read.at_end()) throw std::runtime_error(not_of_these_regions);
}

void RegionBatch::retire(std::span<const std::size_t> points) {
  std::vector<std::vector<std::size_t>> of_part(parts_.size());
  for (const std::size_t p : points) {
    if (p >= size()) throw std::out_of_range("a point is dug out that does not exist");
    of_part[part_of_[p].part].push_back(part_of_[p].point);
  }
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    parts_[k].batch->retire(of_part[k]);
    retired_[k].add(of_part[k]);
  }
}

std::shared_ptr<const fem::HeldState> RegionBatch::hold() {
  std::vector<std::shared_ptr<const fem::HeldState>> held;
  for (const RegionPart& part : parts_) held.push_back(part.batch->hold());
  return std::make_shared<HeldRegions>(std::move(held));
}

void RegionBatch::return_to(const fem::HeldState& held) {
  const auto& regions = dynamic_cast<const HeldRegions&>(held);
  for (std::size_t k = 0; k < parts_.size(); ++k) parts_[k].batch->return_to(*regions.parts()[k]);
}

std::vector<io::RveSnapshot> RegionBatch::snapshots(std::span<const std::int64_t> points) const {
  std::vector<io::RveSnapshot> out;
  for (const std::int64_t point : points) {
    if (point < 0 || static_cast<std::size_t>(point) >= size())
      throw std::out_of_range("there is no Gauss point of this number");
    const Place& place = part_of_[static_cast<std::size_t>(point)];
    const auto* source = dynamic_cast<const SnapshotSource*>(parts_[place.part].batch.get());
    if (source == nullptr) continue;
    const auto own = static_cast<std::int64_t>(place.point);
    for (io::RveSnapshot& snapshot : source->snapshots(std::span(&own, 1))) {
      snapshot.name = point_name(static_cast<std::size_t>(point));
      out.push_back(std::move(snapshot));
    }
  }
  return out;
}

}  // namespace voussoir::host
