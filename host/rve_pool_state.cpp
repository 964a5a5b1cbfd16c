// The committed state of a pool as bytes: what an evaluation starts from, nothing derived.

#include <array>
#include <cstring>
#include <stdexcept>

#include "host/rve_pool.hpp"
#include "io/hash.hpp"

namespace voussoir::host {

namespace {

class Writer {
 public:
  explicit Writer(std::vector<std::byte>& bytes) : bytes_(bytes) {}
  template <class T>
  void operator()(const T* from, std::size_t n) {
    if (n == 0) return;
    const std::size_t at = bytes_.size();
    bytes_.resize(at + n * sizeof(T));
    std::memcpy(bytes_.data() + at, from, n * sizeof(T));
  }

 private:
  std::vector<std::byte>& bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <class T>
  void operator()(T* to, std::size_t n) {
    const std::size_t length = n * sizeof(T);
    if (length > bytes_.size()) throw std::runtime_error("the checkpoint's RVEs are not those of this case");
    if (length > 0) std::memcpy(to, bytes_.data(), length);
    bytes_ = bytes_.subspan(length);
  }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
};

/// Field by field: the padding of a struct is no state.
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
}

/// One order of the numbers for both directions; `count` comes first so that only used contacts are kept.
template <class Transfer, class States>
void transfer_rve(Transfer& transfer, States& s, std::size_t rve, std::size_t grains) {
  transfer(&s.position(rve, 0, 0), 2 * grains);
  transfer(&s.rotation(rve, 0), grains);
  transfer(&s.cell(rve, 0), 4);
  transfer(&s.contact_count(rve), 1);
  const int count = s.contact_count(rve);
  if (count < 0 || count > s.contact_capacity()) throw std::runtime_error("the checkpoint's contact count is impossible");
  transfer(&s.contact_key(rve, 0), static_cast<std::size_t>(count));
  transfer(&s.contact_history(rve, 0, 0), 2 * static_cast<std::size_t>(count));
  for (int c = 0; c < count; ++c) {
    const std::uint32_t key = s.contact_key(rve, c);
    if (kernels::first_of(key) >= kernels::second_of(key) || kernels::second_of(key) >= static_cast<int>(grains)) {
      throw std::runtime_error("the checkpoint's contacts are impossible");
    }
  }
}

/// What the RVEs are made of; their state is nothing without it.
std::uint64_t identity(const kernels::RveBatch& batch) {
  std::uint64_t hash = io::fnv_start;
  const auto add = [&hash](const auto& values) { hash = io::fnv1a(std::as_bytes(std::span(values)), hash); };
  for (const kernels::Packing& p : batch.packings) {
    add(p.radii);
    add(p.class_of);
    add(std::array{p.thickness, p.local_damping});
    for (const kernels::GrainMaterial& m : p.materials) {
      add(std::array{m.modulus, m.stiffness_ratio, m.friction, m.rolling_stiffness, m.rolling_limit});
    }
  }
  return hash;
}

}  // namespace

std::vector<std::byte> RvePool::state() const {
  std::vector<std::byte> bytes;
  Writer write(bytes);
  const std::uint64_t n = size();
  const std::uint64_t packing = identity(batch_);
  write(&n, 1);
  write(&packing, 1);
  for (const auto& report : committed_reports_) transfer_report(write, report);
  for (std::size_t k = 0; k < size(); ++k) {
    transfer_rve(write, batch_.committed, k, static_cast<std::size_t>(batch_.packing(k).size()));
  }
  return bytes;
}

void RvePool::set_state(std::span<const std::byte> bytes) {
  Reader read(bytes);
  std::uint64_t n = 0;
  read(&n, 1);
  if (n != size()) throw std::runtime_error("the checkpoint has another number of RVEs");
  std::uint64_t packing = 0;
  read(&packing, 1);
  if (packing != identity(batch_)) throw std::runtime_error("the checkpoint's RVEs are of another packing");
  for (auto& report : committed_reports_) transfer_report(read, report);
  for (std::size_t k = 0; k < size(); ++k) {
    transfer_rve(read, batch_.committed, k, static_cast<std::size_t>(batch_.packing(k).size()));
  }
  if (!read.at_end()) throw std::runtime_error("the checkpoint's RVEs are not those of this case");
  kernels::forget_candidates(batch_);
  steps_are_fixed_ = false;
}

}  // namespace voussoir::host
