#include "host/library/rves.hpp"

#include <Kokkos_Core.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "host/case/engine.hpp"
#include "host/case/load_case.hpp"
#include "host/material/rve_pool.hpp"
#include "host/packing/packing_check.hpp"
#include "host/packing/packings.hpp"
#include "host/packing/recipe.hpp"
#include "host/process/threads.hpp"
#include "io/input_error.hpp"
#include "io/packing_file.hpp"
#include "kernels/isa/choose_lanes.hpp"

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

namespace {

/// The pressure at which the RVEs of a case begin is packing.pressure, except for a probe.
host::Case with_its_pressure(host::Case input) {
  if (input.kind == host::CaseKind::probe) input.packing.pressure = input.probe.pressure;
  return input;
}

/// Reads a case and refuses what the program would refuse before it makes packings or RVEs of the case.
host::Case accepted(const std::filesystem::path& file, const std::vector<std::string>& settings) {
  if (!::Kokkos::is_initialized()) throw std::logic_error("there is no voussoir::library::Session");
  host::Case input = with_its_pressure(host::load_case(file, settings));
  const auto refuse = [&](const char* key, const std::string& sentence) {
    throw io::InputError(host::place_of(input, key), key, sentence);
  };
  const bool has_one_pressure = input.kind == host::CaseKind::pack || input.kind == host::CaseKind::probe ||
                                input.kind == host::CaseKind::column || input.kind == host::CaseKind::tunnel;
  if (!has_one_pressure) refuse("kind", "the library takes cases of the kinds pack, probe, column and tunnel");
  if (input.material != host::MaterialKind::grains) refuse("material", "the library makes RVEs of grains only");
  const double skin = host::uses_engine(input.kind, input.material) ? input.engine.skin : 0.0;
  const char* key = "packing.file";
  try {
    host::check_packing_files(input.soil, input.packing, skin);
    key = "packing.grains";
    if (input.packing.files.empty()) host::check_recipe(input.soil, input.packing.grains, skin);
  } catch (const io::InputError&) {
    throw;
  } catch (const std::runtime_error& fault) {
    refuse(key, fault.what());
  }
  static_cast<void>(kernels::choose_lanes(input.engine.isa));
  return input;
}

host::PoolOptions options_of(const host::Case& input) {
  if (input.kind != host::CaseKind::probe) {
    return host::options_for_newton(input.engine, input.newton.tangent, input.newton.tangent_strain);
  }
  return {
      .engine = input.engine, .tangent = host::tangent_kind(input.probe.tangent), .tangent_strain = input.probe.strain};
}

}  // namespace

std::vector<std::filesystem::path> make_packings(const std::filesystem::path& case_file,
                                                 const std::vector<std::string>& settings, const Note& note) {
  const host::Case input = accepted(case_file, settings);
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
  const host::Case input = accepted(case_file, settings);
  if (n == 0) throw std::invalid_argument("make_rves needs at least one RVE");
  if (n < static_cast<std::size_t>(input.packing.variety)) {
    throw io::InputError(host::place_of(input, "packing.variety"), "packing.variety",
                         "asks for more packings than there are RVEs to hold them");
  }
  const host::PackingMix mix = host::choose_packings(input.soil, input.packing, n, note);
  auto pool = std::make_unique<host::RvePool>(mix, options_of(input));
  if (note && !pool->device_sentence().empty()) note(pool->device_sentence());
  return pool;
}

}  // namespace voussoir::library
