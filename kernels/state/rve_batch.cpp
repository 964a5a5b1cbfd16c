#include "kernels/state/rve_batch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace voussoir::kernels {

namespace {
/// The contacts of discs form a planar graph on the torus, which has at most 3 contacts per grain. One more leaves room
/// for overlaps.
constexpr int contacts_per_grain = 4;
}  // namespace

RveStates::RveStates(std::string_view label, std::size_t n, int grains, int history) {
  const auto g = static_cast<std::size_t>(grains);
  const auto name = [&](const char* what) { return "voussoir::rve_batch::" + std::string(label) + "::" + what; };
  position = Array<double** [2]>(name("position"), n, g);
  rotation = Array<double**>(name("rotation"), n, g);
  cell = Array<double* [4]>(name("cell"), n);
  contact_count = Array<int*>(name("contact_count"), n);
  contact_key = Array<std::uint32_t**>(name("contact_key"), n, g * contacts_per_grain);
  contact_history = Array<double***>(name("contact_history"), n, g * contacts_per_grain,
                                     static_cast<std::size_t>(history));
}

void copy_state(const RveStates& from, RveStates& to, std::size_t rve, std::size_t grains) {
  const auto contacts = static_cast<std::size_t>(from.contact_count(rve));
  std::copy_n(&from.position(rve, 0, 0), 2 * grains, &to.position(rve, 0, 0));
  std::copy_n(&from.rotation(rve, 0), grains, &to.rotation(rve, 0));
  std::copy_n(&from.cell(rve, 0), 4, &to.cell(rve, 0));
  to.contact_count(rve) = from.contact_count(rve);
  std::copy_n(&from.contact_key(rve, 0), contacts, &to.contact_key(rve, 0));
  std::copy_n(from.histories_of(rve), from.history_size() * contacts, to.histories_of(rve));
}

const char* name_of(RveStatus s) {
  switch (s) {
    case RveStatus::converged:
      return "converged";
    case RveStatus::step_limit:
      return "step_limit";
    case RveStatus::open:
      return "open";
    case RveStatus::neighbour_overflow:
      return "neighbour_overflow";
    case RveStatus::overlap_limit:
      return "overlap_limit";
    case RveStatus::not_finite:
      return "not_finite";
  }
  return "unknown";
}

const char* name_of(TangentKind kind) {
  switch (kind) {
    case TangentKind::contact:
      return "contact";
    case TangentKind::elastic:
      return "elastic";
    case TangentKind::static_:
      return "static";
    case TangentKind::loading:
      return "loading";
  }
  return "unknown";
}

RveBatch make_batch(std::vector<Packing> packings, std::vector<int> packing_of, int history) {
  int grains = 0;
  for (const Packing& p : packings) {
    const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
    if (!positive(p.thickness) || !std::all_of(p.radii.begin(), p.radii.end(), positive)) {
      throw std::invalid_argument("radii and thickness of a packing must be positive numbers");
    }
    if (p.size() < 2 || p.size() > max_grains) throw std::invalid_argument("a packing needs 2 to 65535 grains");
    const bool classes_fit = std::all_of(p.class_of.begin(), p.class_of.end(),
                                         [&](std::uint8_t c) { return c < p.materials.size(); });
    if (p.materials.empty() || !classes_fit || (!p.class_of.empty() && p.class_of.size() != p.radii.size())) {
      throw std::invalid_argument("a packing's grain classes do not fit its grains");
    }
    grains = std::max(grains, p.size());
  }
  for (const int p : packing_of) {
    if (p < 0 || p >= static_cast<int>(packings.size())) throw std::invalid_argument("an RVE has no packing");
  }
  RveBatch batch;
  batch.packings = std::move(packings);
  batch.packing_of = std::move(packing_of);
  const std::size_t n = batch.size();
  batch.committed = RveStates("committed", n, grains, history);
  batch.trial = RveStates("trial", n, grains, history);
  batch.candidates.keys.resize(n);
  forget_candidates(batch);
  return batch;
}

void commit(RveBatch& batch, std::span<const int> kept) {
  if (batch.residence) return batch.residence->commit(kept);
  std::swap(batch.committed, batch.trial);
  CandidateCache& c = batch.candidates;
  for (std::size_t k = 0; k < batch.size(); ++k) {
    if (c.spending[k] < 0) c.skin[k] = -1.0;
    c.spent[k] = c.spending[k];
    c.spending[k] = -1.0;
  }
  for (const int rve : kept) {
    const auto k = static_cast<std::size_t>(rve);
    copy_state(batch.trial, batch.committed, k, batch.packing(k).radii.size());
    c.skin[k] = -1.0;
  }
}

void bring_committed(const RveBatch& batch) {
  const std::shared_future<void> arriving = begin_bringing_committed(batch);
  if (arriving.valid()) arriving.get();
}

std::shared_future<void> begin_bringing_committed(const RveBatch& batch) {
  return batch.residence ? batch.residence->begin_bringing(batch.committed) : std::shared_future<void>();
}

void bring_committed(const RveBatch& batch, std::size_t rve) {
  if (batch.residence) batch.residence->bring_one(batch.committed, static_cast<int>(rve));
}

void forget_candidates(RveBatch& batch) {
  if (batch.residence) batch.residence->forget();
  CandidateCache& c = batch.candidates;
  for (auto* numbers : {&c.skin, &c.spent, &c.spending}) numbers->assign(batch.size(), -1.0);
}

}  // namespace voussoir::kernels
