#include "host/library/grain_batch.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "host/library/accepted_case.hpp"
#include "host/material/mirrored_batch.hpp"

namespace voussoir::library {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

host::PackingMix mix_of(std::vector<Grains>& packings, const std::vector<int>& packing_of) {
  if (packings.empty()) throw std::invalid_argument("a batch needs at least one packing");
  if (packing_of.empty()) throw std::invalid_argument("a batch needs at least one point");
  for (const int k : packing_of) {
    if (k < 0 || static_cast<std::size_t>(k) >= packings.size())
      throw std::invalid_argument(fmt::format("packing_of names packing {}, but there are {}", k, packings.size()));
  }
  host::PackingMix mix{{}, packing_of};
  for (Grains& grains : packings) mix.packings.push_back(std::move(grains.rve));
  return mix;
}

/// All gradients are within 0.1 of the identity matrix, as deformation gradients F are. As displacement gradients they
/// would double both sides of every cell within one increment, so that all grains part. Hardly any honest call asks
/// for this: a Newton iterate that diverges over many RVEs is not near the same matrix everywhere. A single RVE may
/// meet it, where a search tries to double its cell; the documents tell that this is refused.
bool look_like_f(std::span<const fem::Gradient> gradients) {
  return std::all_of(gradients.begin(), gradients.end(), [](const fem::Gradient& h) {
    return (h - fem::Gradient::Identity()).cwiseAbs().maxCoeff() <= 0.1;
  });
}

/// The symmetric matrices of fem are the same row by row and column by column.
std::span<fem::Tangent> tangents_of(std::span<double> numbers) {
  static_assert(sizeof(fem::Tangent) == 9 * sizeof(double) && alignof(fem::Tangent) == alignof(double));
  return {reinterpret_cast<fem::Tangent*>(numbers.data()), numbers.size() / 9};
}

}  // namespace

void require_finite(std::span<const double> gradients) {
  const auto wrong = std::find_if_not(gradients.begin(), gradients.end(), [](double h) { return std::isfinite(h); });
  if (wrong == gradients.end()) return;
  throw std::invalid_argument(fmt::format("the gradient of RVE {} is not finite", (wrong - gradients.begin()) / 4));
}

GrainBatch::GrainBatch(std::vector<Grains> packings, std::vector<int> packing_of, const host::PoolOptions& options,
                       std::vector<bool> mirrored)
    : packing_of_(std::move(packing_of)) {
  for (const Grains& grains : packings) {
    soils_.push_back(grains.soil);
    seeds_.push_back(grains.rve.seed);
  }
  auto pool = std::make_unique<host::RvePool>(mix_of(packings, packing_of_), options);
  pool_ = pool.get();
  batch_ = std::move(pool);
  if (!mirrored.empty()) batch_ = std::make_unique<host::MirroredBatch>(std::move(batch_), std::move(mirrored));
  gradients_.resize(size());
  stresses_.resize(size());
}

void GrainBatch::take_gradients(std::span<const double> f_minus_i) {
  require_finite(f_minus_i);
  for (std::size_t k = 0; k < size(); ++k) {
    const double* h = f_minus_i.data() + 4 * k;
    gradients_[k] << h[0], h[1], h[2], h[3];
  }
  if (look_like_f(gradients_)) {
    throw std::invalid_argument(
        "all gradients are within 0.1 of the identity matrix, as F is: H is the displacement gradient (F minus "
        "identity)");
  }
}

fem::BatchReport GrainBatch::evaluate(std::span<const double> f_minus_i, const AnswerArrays& to) {
  trial_ = Trial::unfinished;
  take_gradients(f_minus_i);
  if (std::exchange(increment_begins_, false)) batch_->begin_increment();
  const auto begin = std::chrono::steady_clock::now();
  const fem::BatchReport report = batch_->evaluate(gradients_, stresses_, tangents_of(to.tangent));
  engine_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  give(to, pool_->trial_reports());
  trial_ = report.usable ? Trial::usable : Trial::unusable;
  fault_ = report.message;
  return report;
}

void GrainBatch::commit() {
  if (trial_ == Trial::none) throw std::logic_error("commit() needs an evaluation after the last commit or set_state");
  if (trial_ == Trial::unfinished)
    throw std::logic_error("the last evaluation was refused or interrupted and cannot be committed");
  if (trial_ == Trial::unusable) throw std::logic_error("the last evaluation cannot be committed: " + fault_);
  batch_->commit();
  begin_increment();
  trial_ = Trial::none;
}

void GrainBatch::begin_increment() { increment_begins_ = true; }

void GrainBatch::committed(const AnswerArrays& to) const {
  batch_->committed(stresses_, tangents_of(to.tangent));
  give(to, pool_->committed_reports());
}

void GrainBatch::give(const AnswerArrays& to, std::span<const kernels::RveReport> reports) const {
  for (std::size_t k = 0; k < size(); ++k) {
    const kernels::RveReport& r = reports[k];
    const bool failed = kernels::is_failure(r.status);
    const fem::Stress s = failed ? fem::Stress(nan, nan, nan) : stresses_[k];
    if (to.stress.size() == 3 * size()) {
      std::copy_n(s.data(), 3, to.stress.data() + 3 * k);
    } else {
      const double row[4] = {s[0], s[2], s[2], s[1]};
      std::copy(std::begin(row), std::end(row), to.stress.data() + 4 * k);
    }
    if (failed && !to.tangent.empty()) std::fill_n(to.tangent.data() + 9 * k, 9, nan);
    to.reports[k] = {.status = static_cast<std::int32_t>(r.status),
                     .steps = r.steps,
                     .contacts = r.contacts,
                     .unbalanced = r.unbalanced,
                     .inertial_number = r.inertial_number,
                     .largest_overlap = r.largest_overlap,
                     .mean_overlap = r.mean_overlap,
                     .cell_area = r.cell_area};
  }
}

void GrainBatch::check(std::span<const std::size_t> points) const {
  for (const std::size_t point : points) {
    if (point >= size()) throw std::out_of_range(fmt::format("there is no point {}: the batch has {}", point, size()));
  }
}

std::vector<int> GrainBatch::packings_of(std::span<const std::size_t> points) const {
  std::vector<int> out;
  for (const std::size_t point : points) out.push_back(packing_of_[point]);
  return out;
}

std::vector<std::byte> GrainBatch::state(std::span<const std::size_t> points) const {
  check(points);
  const std::vector<std::vector<std::byte>> records = pool_->records(points);
  return host::join_state(pool_->identity(packings_of(points)),
                          std::vector<host::StateRecord>(records.begin(), records.end()));
}

void GrainBatch::set_state(std::span<const std::byte> bytes, std::span<const std::size_t> points) {
  check(points);
  std::vector<std::size_t> ascending(points.begin(), points.end());
  std::sort(ascending.begin(), ascending.end());
  if (std::adjacent_find(ascending.begin(), ascending.end()) != ascending.end())
    throw std::invalid_argument("a point occurs twice, but has one state");
  pool_->set_states(points, host::split_state(bytes, pool_->identity(packings_of(points)), points.size()));
  trial_ = Trial::none;
  begin_increment();
}

std::vector<double> GrainBatch::void_ratios() const {
  std::vector<double> out;
  for (std::size_t k = 0; k < size(); ++k) out.push_back(pool_->void_ratio_of(k));
  return out;
}

io::RveSnapshot GrainBatch::snapshot(std::size_t point) const {
  check(std::span(&point, 1));
  const auto number = static_cast<std::int64_t>(point);
  return dynamic_cast<const host::SnapshotSource&>(*batch_).snapshots(std::span(&number, 1)).at(0);
}

io::Packing GrainBatch::packing(std::size_t point) const {
  check(std::span(&point, 1));
  const auto k = static_cast<std::size_t>(packing_of_[point]);
  Grains grains{pool_->packed(point), soils_[k]};
  grains.rve.seed = seeds_[k];
  return file_of(grains);
}

std::unique_ptr<GrainBatch> make_batch(const host::Case& input, host::PackingMix mix, std::vector<bool> mirrored) {
  std::vector<Grains> grains;
  for (host::PackedRve& rve : mix.packings) grains.push_back({std::move(rve), input.soil});
  return std::make_unique<GrainBatch>(std::move(grains), std::move(mix.of_point), options_of(input),
                                      std::move(mirrored));
}

}  // namespace voussoir::library
