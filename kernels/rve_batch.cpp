#include "kernels/rve_batch.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

namespace voussoir::kernels {

namespace {
/// A contact graph of discs is planar on the torus: at most 3 contacts per grain. One more leaves room for overlaps.
constexpr int contacts_per_grain = 4;
constexpr double step_safety = 0.9;  ///< c of kernels/README.md "Mobilities"
constexpr double neighbours = 6.0;
}  // namespace

double Packing::mean_diameter() const {
  return 2.0 * std::accumulate(radii.begin(), radii.end(), 0.0) / static_cast<double>(radii.size());
}

double Packing::largest_radius() const { return *std::max_element(radii.begin(), radii.end()); }

double Packing::solid_area() const {
  double sum = 0;
  for (const double r : radii) sum += std::numbers::pi * r * r;
  return sum;
}

double Packing::mean_mobility() const {
  double sum = 0;
  for (const double r : radii) sum += mobility_of(material, r);
  return sum / static_cast<double>(radii.size());
}

double mobility_of(const GrainMaterial& m, double radius) {
  const double kn = m.modulus * radius;
  const double kt = m.stiffness_ratio * kn;
  return step_safety * step_safety * 4.0 / (neighbours * (kn + 2.0 * kt));
}

double rotational_mobility_of(const GrainMaterial& m, double radius) {
  const double kt = m.stiffness_ratio * m.modulus * radius;
  return step_safety * step_safety * 4.0 / (neighbours * (4.0 + 2.0 * m.rolling_stiffness) * kt * radius * radius);
}

RveStates::RveStates(std::string_view label, std::size_t n, int grains) {
  const auto g = static_cast<std::size_t>(grains);
  const auto name = [&](const char* what) { return "voussoir::rve_batch::" + std::string(label) + "::" + what; };
  position = Array<double** [2]>(name("position"), n, g);
  rotation = Array<double**>(name("rotation"), n, g);
  cell = Array<double* [4]>(name("cell"), n);
  contact_count = Array<int*>(name("contact_count"), n);
  contact_key = Array<std::uint32_t**>(name("contact_key"), n, g * contacts_per_grain);
  contact_history = Array<double** [2]>(name("contact_history"), n, g * contacts_per_grain);
}

const char* name_of(RveStatus s) {
  switch (s) {
    case RveStatus::converged: return "converged";
    case RveStatus::step_limit: return "step_limit";
    case RveStatus::open: return "open";
    case RveStatus::neighbour_overflow: return "neighbour_overflow";
    case RveStatus::overlap_limit: return "overlap_limit";
    case RveStatus::not_finite: return "not_finite";
  }
  return "unknown";
}

RveBatch make_batch(std::vector<Packing> packings, std::vector<int> packing_of) {
  int grains = 0;
  for (const Packing& p : packings) {
    if (p.size() < 2 || p.size() > max_grains) throw std::invalid_argument("a packing needs 2 to 65535 grains");
    grains = std::max(grains, p.size());
  }
  RveBatch batch;
  batch.packings = std::move(packings);
  batch.packing_of = std::move(packing_of);
  const std::size_t n = batch.size();
  batch.committed = RveStates("committed", n, grains);
  batch.trial = RveStates("trial", n, grains);
  batch.candidates.keys.resize(n);
  batch.candidates.valid.assign(n, 0);
  return batch;
}

void commit(RveBatch& batch) {
  std::swap(batch.committed, batch.trial);
  std::fill(batch.candidates.valid.begin(), batch.candidates.valid.end(), 0);
}

}  // namespace voussoir::kernels
