#include "host/library/accepted_case.hpp"

#include <Kokkos_Core.hpp>
#include <stdexcept>
#include <string>

#include "host/case/engine.hpp"
#include "host/case/result_fields.hpp"
#include "host/packing/packing_check.hpp"
#include "io/input_error.hpp"
#include "kernels/isa/choose_lanes.hpp"

namespace voussoir::library {

host::Case accepted(host::Case input) {
  if (!::Kokkos::is_initialized()) throw std::logic_error("there is no voussoir::library::Session");
  if (input.kind == host::CaseKind::probe) input.packing.pressure = input.probe.pressure;
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
  if (input.kind == host::CaseKind::probe) {
    return {.engine = input.engine,
            .tangent = host::tangent_kind(input.probe.tangent),
            .tangent_strain = input.probe.strain};
  }
  host::PoolOptions options = host::options_for_newton(input.engine, input.newton.tangent, input.newton.tangent_strain);
  options.microstructure = host::written_quantities(input.output);
  return options;
}

host::PackingMix mix_of(const host::Case& input, std::size_t n, const host::PackingNote& note) {
  if (n == 0) throw std::invalid_argument("there must be at least one RVE");
  if (n < static_cast<std::size_t>(input.packing.variety)) {
    throw io::InputError(host::place_of(input, "packing.variety"), "packing.variety",
                         "asks for more packings than there are RVEs to hold them");
  }
  return host::choose_packings(input.soil, input.packing, n, note);
}

}  // namespace voussoir::library
