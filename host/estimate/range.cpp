#include "host/estimate/range.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "host/element_tests/strength.hpp"
#include "host/packing/case_recipes.hpp"
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

constexpr double k0_at_rest = 0.5;

/// The deepest point of a scene: its largest pressure on a boundary, and the weight of its heaviest region over its
/// whole height.
Load deepest_load(const Case& input, double height) {
  double pressure = input.packing.pressure, unit_weight = 0;
  for (const RegionCase& region : input.scene.regions) unit_weight = std::max(unit_weight, region.unit_weight);
  for (const StageCase& stage : input.scene.stages) {
    for (const PressCase& press : stage.presses)
      if (press.kind == PressKind::pressure) pressure = std::max(pressure, press.pressure);
  }
  const double weight = unit_weight * height, mean = pressure + weight * (1 + k0_at_rest) / 2;
  return {mean,
          fmt::format("at the deepest point (pressure {:.5g} kPa, weight {:.5g} kPa, K0 = 0.5)", pressure * 1e-3,
                      weight * 1e-3),
          mean};
}

/// The largest mean stress that follows from the case without a computation.
Load largest_load(const Case& input, double height) {
  constexpr double strong = 40 * std::numbers::pi / 180;  // friction angle of dense sand and gravel at the peak
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
    case CaseKind::scene:
      return deepest_load(input, height);
    case CaseKind::column:
    case CaseKind::tunnel:
      break;
  }
  const double vertical = input.ground.surcharge + input.ground.unit_weight * input.ground.height;
  return rest(vertical * (1 + k0_at_rest) / 2,
              fmt::format("at the deepest point (vertical stress {:.5g} kPa, K0 = 0.5)", vertical * 1e-3));
}

/// A packing with the grains of the recipe: those of a file, or a sample of the grading.
kernels::Packing grains_of(const Case& input, const SoilRecipe& recipe) {
  SoilCase soil = *recipe.soil;
  if (input.kind == CaseKind::calibrate && !input.calibrate.thickness.empty())
    soil.thickness = std::max(soil.thickness, input.calibrate.thickness.back());
  const PackingCase& packing = *recipe.packing;
  const std::vector<double> radii = packing.files.empty() ? sample_radii(soil, packing.grains, packing.seed)
                                                          : io::load_packing_csv(packing.files.front()).radius;
  return packing_of(soil, radii, soil.thickness);
}

/// Warns of a unit weight that no ground has, such as 2 kN/m3 by mistake for 20. docs/explanation/range.md has the
/// reasons for the limits.
void add_unit_weight(const Case& input, const std::string& key, double weight, std::vector<std::string>& warnings) {
  constexpr double least = 7e3;  // loose quartz sand under water [N/m3]
  constexpr double most = 30e3;  // the heaviest common rock [N/m3]
  if (weight >= least && weight <= most) return;
  warnings.push_back(
      fmt::format("{} ({}) is {:.4g} kN/m3, but ground weighs {:.0f} kN/m3 (loose sand under water) to "
                  "{:.0f} kN/m3 (heavy rock) (docs/explanation/range.md)",
                  key, place_of(input, key), weight * 1e-3, least * 1e-3, most * 1e-3));
}

/// Warns of the weights of the ground. Regions of a scene may be without weight, as those of a test, and elastic ones
/// may be of any material.
void add_unit_weights(const Case& input, std::vector<std::string>& warnings) {
  if (input.kind == CaseKind::column || input.kind == CaseKind::tunnel)
    add_unit_weight(input, "ground.unit_weight", input.ground.unit_weight, warnings);
  for (std::size_t k = 0; k < input.scene.regions.size(); ++k) {
    const RegionCase& region = input.scene.regions[k];
    if (!region.elastic && region.unit_weight > 0)
      add_unit_weight(input, fmt::format("region[{}].unit_weight", k), region.unit_weight, warnings);
  }
}

/// Warns of contacts that are softer or stiffer than those of all measurements. A packing is made at little pressure
/// and strained later, under a pressure that this case does not know.
void add_softness(const Case& input, const SoilCase& soil, const kernels::Packing& grains, double pressure,
                  std::vector<std::string>& warnings) {
  constexpr double usual = 1e5;  // of a test, or of some 5 m of ground [Pa]
  const double compared = input.kind == CaseKind::pack ? usual : std::min(pressure, usual);
  const double soft = stiffness_number(grains, compared), stiff = stiffness_number(grains, usual);
  const bool is_soft = soft < least_usual_stiffness;
  if (!is_soft && stiff <= most_usual_stiffness) return;
  const std::string modulus = soil.classes.empty()
                                  ? "soil.modulus of " + io::format_quantity(soil.modulus, io::Dimension::pressure)
                                  : "soil.class";
  warnings.push_back(fmt::format(
      "{} with soil.thickness of {} makes {} contacts: kappa = {:.3g} at {:.4g} kPa, outside of {:.0f} to {:.0f}; {} "
      "(docs/explanation/range.md)",
      modulus, io::format_quantity(soil.thickness, io::Dimension::length), is_soft ? "soft" : "stiff",
      is_soft ? soft : stiff, (is_soft ? compared : usual) * 1e-3, least_usual_stiffness, most_usual_stiffness,
      is_soft ? "sand with 51 had little more than half of its strength, and softer sand was not measured"
              : "stiffer sand than 5060 was not measured, and it needs more steps"));
}

/// What the load does to these grains, and their mean overlap [-]. @param said of the region before each sentence
std::pair<Foretold, double> foretell_grains(const Case& input, const SoilCase& soil, const Load& load,
                                            const kernels::Packing& grains, const std::string& said) {
  Foretold out;
  const double kappa = stiffness_number(grains, load.pressure);
  const double overlap = foretold_overlap(kappa) * (load.sheared ? overlap_of_shear : 1.0);
  add_softness(input, soil, grains, load.pressure, out.warnings);
  out.line = fmt::format(
      "{}mean stress {:.5g} kPa {}: kappa = {:.3g}, mean overlap about {:.2g} % of r_i + r_j (the contact "
      "law is good for {:.0f} %, docs/explanation/range.md)",
      said, load.pressure * 1e-3, load.where, kappa, 100 * overlap, 100 * most_mean_overlap);
  constexpr double loose_ratio = 0.19;  // void ratio of a dense packing of coarse sand at little pressure
  const double pressed = foretold_overlap(stiffness_number(grains, load.packing));
  const double left = foretold_void_ratio(loose_ratio, pressed), least = least_void_ratio(grains);
  if (overlap > most_mean_overlap || left < least) {
    out.warnings.push_back(
        fmt::format("{}the mean stress of {:.5g} kPa {} is beyond what the contact law is good for: kappa "
                    "= {:.3g}, mean overlap about {:.2g} % of r_i + r_j; strengths from there are "
                    "invalid (docs/explanation/range.md)",
                    said, load.pressure * 1e-3, load.where, kappa, 100 * overlap));
  }
  if (left < least) {
    out.warnings.push_back(
        fmt::format("{}the grains will interpenetrate: at a mean stress of {:.5g} kPa a void ratio of {:.2g} "
                    "at little pressure becomes about {:.2g}, below {:.3g}, that of the densest packing "
                    "of rigid grains",
                    said, load.packing * 1e-3, loose_ratio, left, least));
  }
  return {out, overlap};
}

}  // namespace

Foretold foretell(const Case& input, double height) {
  Foretold out;
  add_unit_weights(input, out.warnings);
  double most = -1;
  for (const SoilRecipe& recipe : recipes_of(input)) {
    if (recipe.packing->has_state()) continue;  // its pressure is known when it is read
    const std::string said = recipe.regions.empty() ? "" : recipe.place() + ": ";
    auto [one, overlap] = foretell_grains(input, *recipe.soil, largest_load(input, height), grains_of(input, recipe),
                                          said);
    out.warnings.insert(out.warnings.end(), one.warnings.begin(), one.warnings.end());
    if (overlap > most) out.line = std::move(one.line);
    most = std::max(most, overlap);
  }
  return out;
}

}  // namespace voussoir::host
