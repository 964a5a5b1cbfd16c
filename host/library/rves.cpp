#include "host/library/rves.hpp"

#include <Kokkos_Core.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "host/case/load_case.hpp"
#include "host/library/accepted_case.hpp"
#include "host/material/rve_pool.hpp"
#include "host/packing/packings.hpp"
#include "host/process/threads.hpp"
#include "io/input_error.hpp"
#include "io/packing_file.hpp"

namespace voussoir::library {

struct Session::Kokkos {
  std::optional<host::KokkosSession> started;  // empty where the foreign program has started Kokkos
};

Session::Session(int threads) : kokkos_(std::make_unique<Kokkos>()) {
  if (::Kokkos::is_finalized()) throw std::logic_error("Kokkos has ended in this process and cannot start again");
  if (!::Kokkos::is_initialized()) kokkos_->started.emplace(threads);
}

Session::~Session() = default;

int Session::threads() const { return ::Kokkos::DefaultHostExecutionSpace().concurrency(); }

std::vector<std::filesystem::path> make_packings(const std::filesystem::path& case_file,
                                                 const std::vector<std::string>& settings, const Note& note) {
  const host::Case input = accepted(host::load_case(case_file, settings));
  if (!input.packing.files.empty()) {
    throw io::InputError(host::place_of(input, "packing.file"), "packing.file", "names packings that are made already");
  }
  std::vector<std::filesystem::path> files;
  for (const host::PackedRve& rve :
       host::obtain_packings(input.soil, input.packing, host::seeds_of(input.packing), note)) {
    files.push_back(host::stored_path(input.soil, input.packing, rve.seed));
  }
  return files;
}

std::unique_ptr<fem::MaterialBatch> make_rves(const std::filesystem::path& case_file, std::size_t n,
                                              const std::vector<std::string>& settings, const Note& note) {
  const host::Case input = accepted(host::load_case(case_file, settings));
  const host::PackingMix mix = mix_of(input, n, note);
  auto pool = std::make_unique<host::RvePool>(mix, options_of(input));
  if (note && !pool->device_sentence().empty()) note(pool->device_sentence());
  return pool;
}

}  // namespace voussoir::library
