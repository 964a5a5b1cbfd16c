// The committed state of a pool as bytes: everything that an evaluation starts from, without what follows from it.
#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

#include "host/material/rve_pool.hpp"
#include "host/material/state_records.hpp"
#include "io/byte_stream.hpp"
#include "io/hash.hpp"

namespace voussoir::host {

namespace {

/// Transfers a report member by member, since the padding bytes of a struct are not part of the state. A member that is
/// not transferred is 0 after a run has been resumed, as the members tangent_* are: no field of the results may use it.
template <class Transfer, class Report>
void transfer_report(Transfer& transfer, Report& r) {
  transfer(&r.status, 1);
  transfer(&r.steps, 1);
  transfer(&r.contacts, 1);
  transfer(r.stress, 4);
  transfer(r.tangent, 6);
  transfer(&r.unbalanced, 1);
  transfer(&r.inertial_number, 1);
  transfer(&r.largest_overlap, 1);
  transfer(&r.mean_overlap, 1);
  transfer(&r.cell_area, 1);
}

/// Transfers the deferral's record of one RVE.
template <class Transfer, class Committed>
void transfer_deferral(Transfer& transfer, Committed& at) {
  transfer(at.gradient.data(), 4);
  transfer_report(transfer, at.grains);
  transfer(&at.trust, 1);
  transfer(&at.commits, 1);
}

/// Transfers an RVE, in one order of the numbers for writing and reading. The number of contacts comes before the
/// contacts, so that only used contacts are kept.
template <class Transfer, class States>
void transfer_rve(Transfer& transfer, States& s, std::size_t rve, std::size_t grains) {
  transfer(&s.position(rve, 0, 0), 2 * grains);
  transfer(&s.rotation(rve, 0), grains);
  transfer(&s.cell(rve, 0), 4);
  transfer(&s.contact_count(rve), 1);
  const int count = s.contact_count(rve);
  if (count < 0 || count > s.contact_capacity())
    throw std::runtime_error("the checkpoint has an impossible number of contacts");
  transfer(&s.contact_key(rve, 0), static_cast<std::size_t>(count));
  transfer(s.histories_of(rve), s.history_size() * static_cast<std::size_t>(count));
  for (int c = 0; c < count; ++c) {
    const std::uint32_t key = s.contact_key(rve, c);
    if (kernels::first_of(key) >= kernels::second_of(key) || kernels::second_of(key) >= static_cast<int>(grains)) {
      throw std::runtime_error("the checkpoint has a contact between impossible grains");
    }
  }
}

/// Transfers the record of one held RVE.
template <class Transfer>
void transfer_record(Transfer& transfer, const HeldRves& held, std::size_t rve) {
  transfer_report(transfer, held.reports[rve]);
  if (!held.deferred.empty()) transfer_deferral(transfer, held.deferred[rve]);
  transfer_rve(transfer, held.states, rve, held.grains[rve]);
}

/// Reads a record into the RVE `to` of these states.
/// @param deferred null without deferral
/// @throws std::runtime_error where it is no record of an RVE of so many grains
void read_record(const StateRecord& record, kernels::RveReport& report, Deferral::Committed* deferred,
                 const kernels::RveStates& states, std::size_t to, std::size_t grains) {
  io::ByteReader read(record, not_of_this_case);
  transfer_report(read, report);
  if (deferred != nullptr) transfer_deferral(read, *deferred);
  transfer_rve(read, states, to, grains);
  if (!read.at_end()) throw std::runtime_error(not_of_this_case);
}

bool same_arrays(const kernels::RveStates& a, const kernels::RveStates& b) {
  return a.position.data() == b.position.data();
}

/// Counts the bytes that a ByteWriter would write.
struct ByteCounter {
  std::size_t bytes = 0;
  template <class T>
  void operator()(const T* /*from*/, std::size_t n) {
    bytes += n * sizeof(T);
  }
};

}  // namespace

/// Which packing an RVE has counts only where there are several, so that the identities of older checkpoints hold.
std::uint64_t RvePool::identity(std::span<const int> packing_of) const {
  std::uint64_t hash = io::fnv_start;
  const auto add = [&hash](const auto& values) { hash = io::fnv1a(std::as_bytes(std::span(values)), hash); };
  add(std::array{record_version});
  for (const kernels::Packing& p : batch_.packings) {
    add(p.radii);
    add(p.class_of);
    add(std::array{p.thickness, p.local_damping});
    for (const kernels::GrainMaterial& m : p.materials) {
      for (const kernels::MaterialNumber& n : kernels::material_numbers) add(std::array{m.*n.number});
    }
  }
  if (batch_.packings.size() > 1) add(packing_of);
  if (deferral_.on()) add(std::array{deferral_.bound()});
  return hash;
}

void HeldRves::write_record(std::size_t rve, std::vector<std::byte>& bytes) const {
  wait();
  io::ByteWriter write(bytes);
  transfer_record(write, *this, rve);
}

std::size_t HeldRves::size() const {
  wait();
  std::vector<std::byte> head;
  write_head(head, identity, grains.size());
  ByteCounter count{head.size() + grains.size() * sizeof(RecordHead)};
  for (std::size_t k = 0; k < grains.size(); ++k) transfer_record(count, *this, k);
  return count.bytes;
}

void HeldRves::write(const Sink& sink) const {
  wait();
  std::vector<std::byte> bytes;
  write_head(bytes, identity, grains.size());
  sink(bytes);
  for (std::size_t k = 0; k < grains.size(); ++k) {
    bytes.clear();
    write_record(k, bytes);
    const RecordHead head_of_record = head_of(bytes);
    sink(std::as_bytes(std::span(head_of_record)));
    sink(bytes);
  }
}

HeldRves RvePool::committed_rves() const {
  HeldRves held;
  held.arriving = kernels::begin_bringing_committed(batch_);
  held.states = batch_.committed;
  held.reports = committed_reports_;
  held.identity = identity();
  for (std::size_t k = 0; k < size(); ++k) {
    held.grains.push_back(static_cast<std::size_t>(batch_.packing(k).size()));
    if (deferral_.on()) held.deferred.push_back(deferral_.committed(k));
  }
  return held;
}

std::vector<std::vector<std::byte>> RvePool::records(std::span<const std::size_t> rves) const {
  const HeldRves held = committed_rves();
  std::vector<std::vector<std::byte>> records(rves.size());
  for (std::size_t k = 0; k < rves.size(); ++k) held.write_record(rves[k], records[k]);
  return records;
}

std::vector<std::vector<std::byte>> RvePool::records(std::size_t first, std::size_t n) const {
  std::vector<std::size_t> rves(n);
  std::iota(rves.begin(), rves.end(), first);
  return records(rves);
}

std::shared_ptr<const fem::HeldState> RvePool::hold() {
  const auto held = std::make_shared<const HeldRves>(committed_rves());
  held_.push_back(held);
  return held;
}

void RvePool::return_to(const fem::HeldState& held) {
  const auto& rves = dynamic_cast<const HeldRves&>(held);
  rves.wait();
  batch_.committed = rves.states;
  committed_reports_ = rves.reports;
  for (std::size_t k = 0; k < rves.deferred.size(); ++k) deferral_.committed(k) = rves.deferred[k];
  kernels::forget_candidates(batch_);
  begin_increment();
}

bool RvePool::is_held(const kernels::RveStates& states) {
  std::erase_if(held_, [](const auto& held) { return held.expired(); });
  return std::any_of(held_.begin(), held_.end(), [&](const auto& held) {
    const std::shared_ptr<const HeldRves> alive = held.lock();
    return alive && same_arrays(alive->states, states);
  });
}

/// Arrays for trial states that nobody holds. There are three at the most where one state is held at a time.
kernels::RveStates RvePool::free_states() {
  for (const kernels::RveStates& states : all_states_) {
    if (!same_arrays(states, batch_.committed) && !is_held(states)) return states;
  }
  const auto grains = static_cast<int>(batch_.committed.rotation.extent(1));
  all_states_.emplace_back("held", size(), grains, static_cast<int>(batch_.committed.history_size()));
  return all_states_.back();
}

void RvePool::set_states(std::span<const std::size_t> rves, std::span<const StateRecord> records) {
  if (is_held(batch_.committed)) throw std::logic_error("a state that is held would be overwritten");
  const auto grains_of = [&](std::size_t rve) { return static_cast<std::size_t>(batch_.packing(rve).size()); };
  // A damaged record is found before anything is overwritten.
  const kernels::RveStates scratch("scratch", 1, static_cast<int>(batch_.committed.rotation.extent(1)),
                                   static_cast<int>(batch_.committed.history_size()));
  kernels::RveReport report;
  Deferral::Committed deferred;
  for (std::size_t k = 0; k < rves.size(); ++k) {
    read_record(records[k], report, deferral_.on() ? &deferred : nullptr, scratch, 0, grains_of(rves[k]));
  }
  kernels::bring_committed(batch_);
  for (std::size_t k = 0; k < rves.size(); ++k) {
    const std::size_t rve = rves[k];
    read_record(records[k], committed_reports_[rve], deferral_.on() ? &deferral_.committed(rve) : nullptr,
                batch_.committed, rve, grains_of(rve));
  }
  kernels::forget_candidates(batch_);
  begin_increment();
}

std::vector<std::byte> RvePool::state() const {
  const HeldRves held = committed_rves();
  std::vector<std::byte> bytes;
  bytes.reserve(held.size());
  held.write([&bytes](std::span<const std::byte> piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); });
  return bytes;
}

void RvePool::set_state(std::span<const std::byte> bytes) {
  std::vector<std::size_t> all(size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  set_states(all, split_state(bytes, identity(), size()));
}

}  // namespace voussoir::host
