// The committed state of a pool as bytes: everything that an evaluation starts from, without what follows from it.
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

/// Transfers the deferral's record of one RVE; nothing where no RVE may be deferred.
template <class Transfer, class Deferral>
void transfer_deferral(Transfer& transfer, Deferral& deferral, std::size_t rve) {
  if (!deferral.on()) return;
  auto& at = deferral.committed(rve);
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

}  // namespace

std::uint64_t RvePool::identity() const {
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
  if (deferral_.on()) add(std::array{deferral_.bound()});
  return hash;
}

std::vector<std::byte> RvePool::state_of(std::size_t rve) const {
  std::vector<std::byte> bytes;
  const auto grains = static_cast<std::size_t>(batch_.packing(rve).size());
  // A grain takes 24 bytes and a contact 20; there are about two contacts a grain. With more, the vector grows once.
  bytes.reserve(256 + 72 * grains);
  io::ByteWriter write(bytes);
  transfer_report(write, committed_reports_[rve]);
  transfer_deferral(write, deferral_, rve);
  transfer_rve(write, batch_.committed, rve, grains);
  return bytes;
}

void RvePool::set_states(std::span<const std::size_t> rves, std::span<const StateRecord> records) {
  for (std::size_t k = 0; k < rves.size(); ++k) {
    io::ByteReader read(records[k], not_of_this_case);
    transfer_report(read, committed_reports_[rves[k]]);
    transfer_deferral(read, deferral_, rves[k]);
    transfer_rve(read, batch_.committed, rves[k], static_cast<std::size_t>(batch_.packing(rves[k]).size()));
    if (!read.at_end()) throw std::runtime_error(not_of_this_case);
  }
  kernels::forget_candidates(batch_);
  begin_increment();
}

std::vector<std::byte> RvePool::state() const {
  std::vector<std::vector<std::byte>> states;
  for (std::size_t k = 0; k < size(); ++k) states.push_back(state_of(k));
  return join_state(identity(), std::vector<StateRecord>(states.begin(), states.end()));
}

void RvePool::set_state(std::span<const std::byte> bytes) {
  std::vector<std::size_t> all(size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  set_states(all, split_state(bytes, identity(), size()));
}

}  // namespace voussoir::host
