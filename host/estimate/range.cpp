#include "host/estimate/range.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <numbers>

#include "host/element_tests/strength.hpp"
#include "host/packing/grading.hpp"
#include "host/packing/law_range.hpp"
#include "io/packing_file.hpp"
#include "io/units.hpp"

namespace voussoir::host {
namespace {

/// A mean stress [Pa], and where it acts.
struct Load {
  double pressure = 0;
  std::string where;
  double packing = 0;  ///< the largest mean stress without shear, which decides the void ratio [Pa]
  bool sheared = false;
};

/// The largest mean stress that follows from the case without a computation.
Load largest_load(const Case& input) {
  constexpr double strong = 40 * std::numbers::pi / 180;  // friction angle of dense sand and gravel at the peak
  constexpr double k0 = 0.5;
  const auto test = [](double pressure) {
    return Load{mean_stress_at(pressure, strong),
                fmt::format("at the peak of a test at {:.5g} kPa (phi = 40 deg)", pressure * 1e-3), pressure, true};
  };
  const auto rest = [](double pressure, const std::string& where) { return Load{pressure, where, pressure, false}; };
  switch (input.kind) {
    case CaseKind::biaxial:
    case CaseKind::calibrate:
      return test(*std::max_element(input.biaxial.pressures.begin(), input.biaxial.pressures.end()));
    case CaseKind::biaxial_bvp:
      return test(input.biaxial_bvp.pressure);
    case CaseKind::probe:
      return rest(input.probe.pressure, "of the packing");
    case CaseKind::pack:
      return rest(input.packing.pressure, "of the packing");
    case CaseKind::column:
    case CaseKind::tunnel:
      break;
  }
  const double vertical = input.ground.surcharge + input.ground.unit_weight * input.ground.height;
  return rest(vertical * (1 + k0) / 2,
              fmt::format("at the deepest point (vertical stress {:.5g} kPa, K0 = 0.5)", vertical * 1e-3));
}

/// A packing with the grains of the case: those of a file, or a sample of the grading.
kernels::Packing grains_of(const Case& input) {
  SoilCase soil = input.soil;
  if (input.kind == CaseKind::calibrate && !input.calibrate.thickness.empty())
    soil.thickness = std::max(soil.thickness, input.calibrate.thickness.back());
  const PackingCase& packing = input.packing;
  const std::vector<double> radii = packing.files.empty() ? sample_radii(soil, packing.grains, packing.seed)
                                                          : io::load_packing_csv(packing.files.front()).radius;
  return packing_of(soil, radii, soil.thickness);
}

/// Warns of a unit weight that no ground has, such as 2 kN/m3 by mistake for 20. docs/explanation/range.md has the
/// reasons for the limits.
void add_unit_weight(const Case& input, std::vector<std::string>& warnings) {
  constexpr double least = 7e3;  // loose quartz sand under water [N/m3]
  constexpr double most = 30e3;  // the heaviest common rock [N/m3]
  const double weight = input.ground.unit_weight;
  const bool has_weight = input.kind == CaseKind::column || input.kind == CaseKind::tunnel;
  if (!has_weight || (weight >= least && weight <= most)) return;
  warnings.push_back(
      fmt::format("ground.unit_weight ({}) is {:.4g} kN/m3, but ground weighs {:.0f} kN/m3 (loose sand under water) to "
                  "{:.0f} kN/m3 (heavy rock) (docs/explanation/range.md)",
                  place_of(input, "ground.unit_weight"), weight * 1e-3, least * 1e-3, most * 1e-3));
}

/// Warns of contacts that are softer or stiffer than those of all measurements. A packing is made at little pressure
/// and strained later, under a pressure that this case does not know.
void add_softness(const Case& input, const kernels::Packing& grains, double pressure,
                  std::vector<std::string>& warnings) {
  constexpr double usual = 1e5;  // of a test, or of some 5 m of ground [Pa]
  const double compared = input.kind == CaseKind::pack ? usual : std::min(pressure, usual);
  const double soft = stiffness_number(grains, compared), stiff = stiffness_number(grains, usual);
  const bool is_soft = soft < least_usual_stiffness;
  if (!is_soft && stiff <= most_usual_stiffness) return;
  const std::string modulus = input.soil.classes.empty()
                                  ? "soil.modulus of " +
                                        io::format_quantity(input.soil.modulus, io::Dimension::pressure)
                                  : "soil.class";
  warnings.push_back(fmt::format(
      "{} with soil.thickness of {} makes {} contacts: kappa = {:.3g} at {:.4g} kPa, outside of {:.0f} to {:.0f}; {} "
      "(docs/explanation/range.md)",
      modulus, io::format_quantity(input.soil.thickness, io::Dimension::length), is_soft ? "soft" : "stiff",
      is_soft ? soft : stiff, (is_soft ? compared : usual) * 1e-3, least_usual_stiffness, most_usual_stiffness,
      is_soft ? "sand with 51 had little more than half of its strength, and softer sand was not measured"
              : "stiffer sand than 5060 was not measured, and it needs more steps"));
}

}  // namespace

Foretold foretell(const Case& input) {
  Foretold out;
  add_unit_weight(input, out.warnings);
  const bool has_state = input.packing.has_state();  // its pressure is known when it is read
  if ((runs_on_a_mesh(input.kind) && input.material != MaterialKind::grains) || has_state) return out;
  const Load load = largest_load(input);
  const kernels::Packing grains = grains_of(input);
  const double kappa = stiffness_number(grains, load.pressure);
  const double overlap = foretold_overlap(kappa) * (load.sheared ? overlap_of_shear : 1.0);
  add_softness(input, grains, load.pressure, out.warnings);
  out.line = fmt::format(
      "mean stress {:.5g} kPa {}: kappa = {:.3g}, mean overlap about {:.2g} % of r_i + r_j (the contact "
      "law is good for {:.0f} %, docs/explanation/range.md)",
      load.pressure * 1e-3, load.where, kappa, 100 * overlap, 100 * most_mean_overlap);
  constexpr double loose_ratio = 0.19;  // void ratio of a dense packing of coarse sand at little pressure
  const double pressed = foretold_overlap(stiffness_number(grains, load.packing));
  const double left = foretold_void_ratio(loose_ratio, pressed), least = least_void_ratio(grains);
  if (overlap > most_mean_overlap || left < least) {
    out.warnings.push_back(
        fmt::format("the mean stress of {:.5g} kPa {} is beyond what the contact law is good for: kappa "
                    "= {:.3g}, mean overlap about {:.2g} % of r_i + r_j; strengths from there are "
                    "invalid (docs/explanation/range.md)",
                    load.pressure * 1e-3, load.where, kappa, 100 * overlap));
  }
  if (left < least) {
    out.warnings.push_back(
        fmt::format("the grains will interpenetrate: at a mean stress of {:.5g} kPa a void ratio of {:.2g} "
                    "at little pressure becomes about {:.2g}, below {:.3g}, that of the densest packing "
                    "of rigid grains",
                    load.packing * 1e-3, loose_ratio, left, least));
  }
  return out;
}

}  // namespace voussoir::host
