#include "host/case/made_with.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <sstream>

#include "io/units.hpp"

namespace voussoir::host {

namespace {

using io::Dimension;

/// An angle in degrees to 12 digits: most angles have no exact value in radians.
std::string degrees(double angle) { return fmt::format("{:.12g} deg", angle * 180.0 / std::numbers::pi); }

/// Adds the numbers that [soil] and its classes both have.
template <class Material>
void add_material(const Material& m, const std::string& table, KeyTexts& to) {
  to.emplace_back(table + ".modulus", io::format_quantity(m.modulus, Dimension::pressure));
  to.emplace_back(table + ".stiffness_ratio", io::format_quantity(m.stiffness_ratio, Dimension::none));
  to.emplace_back(table + ".friction", degrees(m.friction_angle));
  to.emplace_back(table + ".rolling_stiffness", io::format_quantity(m.rolling_stiffness, Dimension::none));
  to.emplace_back(table + ".rolling_limit", io::format_quantity(m.rolling_limit, Dimension::none));
}

std::string list_of(const std::vector<double>& values, Dimension dimension) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + io::format_quantity(value, dimension);
  return "[" + text + "]";
}

/// Sets the number of a recipe's name (kernels::material_numbers) in `m`; false for another name.
template <class Material>
bool set_number(Material& m, const std::string& name, double value) {
  if (name == "E") m.modulus = value;
  if (name == "kt/kn") m.stiffness_ratio = value;
  if (name == "mu") m.friction_angle = std::atan(value);
  if (name == "beta") m.rolling_stiffness = value;
  if (name == "eta") m.rolling_limit = value;
  return name == "E" || name == "kt/kn" || name == "mu" || name == "beta" || name == "eta";
}

/// The soil of a recipe's text (recipe_text, host/packing/recipe.hpp). Empty where the text is no recipe.
KeyTexts soil_of_recipe(const std::string& recipe) {
  std::istringstream words(recipe);
  std::string name, version;
  if (!(words >> name >> version) || name != "recipe") return {};
  SoilCase soil;
  std::vector<GrainClassCase> materials;
  std::vector<double> limits;
  double value = 0;
  while (words >> name) {
    const std::size_t colon = name.find(':');
    if (colon != std::string::npos) {
      soil.sizes.push_back(std::strtod(name.c_str(), nullptr));
      soil.passing.push_back(std::strtod(name.c_str() + colon + 1, nullptr));
    } else if (name == "by") {
      if (!(words >> name)) return {};
      soil.passing_by = name == "area" ? GradingMeasure::area : GradingMeasure::number;
    } else if (!(words >> value)) {
      return {};
    } else if (name == "d") {
      soil.size_minimum = value;
      if (!(words >> soil.size_maximum)) return {};
    } else if (name == "damping") {
      soil.damping = value;
    } else if (name == "t") {
      soil.thickness = value;
    } else if (name == "to") {
      limits.push_back(value);
    } else {
      if (name == "E") materials.emplace_back();
      if (!materials.empty()) static_cast<void>(set_number(materials.back(), name, value));
    }
  }
  if (materials.empty() || (!limits.empty() && limits.size() != materials.size())) return {};
  for (std::size_t k = 0; k < limits.size(); ++k) {
    soil.classes.push_back(materials[k]);
    soil.classes.back().size_to = limits[k];
  }
  const GrainClassCase& first = materials.front();
  soil.modulus = first.modulus;
  soil.stiffness_ratio = first.stiffness_ratio;
  soil.friction_angle = first.friction_angle;
  soil.rolling_stiffness = first.rolling_stiffness;
  soil.rolling_limit = first.rolling_limit;
  return soil_keys(soil);
}

/// The soil of a meta file of Yade, as far as it names numbers that [soil] has.
KeyTexts soil_of_numbers(const std::map<std::string, double>& numbers) {
  constexpr double degree = std::numbers::pi / 180.0;
  struct Name {
    const char *theirs, *key;
    Dimension dimension;
    double factor;
  };
  constexpr Name names[] = {{"E", "soil.modulus", Dimension::pressure, 1},
                            {"kt_over_kn", "soil.stiffness_ratio", Dimension::none, 1},
                            {"phi_deg", "soil.friction", Dimension::angle, degree},
                            {"alphaKr", "soil.rolling_stiffness", Dimension::none, 1},
                            {"etaRoll", "soil.rolling_limit", Dimension::none, 1},
                            {"damping", "soil.damping", Dimension::none, 1}};
  KeyTexts keys;
  for (const Name& name : names) {
    const auto found = numbers.find(name.theirs);
    if (found != numbers.end())
      keys.emplace_back(name.key, name.dimension == Dimension::angle
                                      ? degrees(found->second * name.factor)
                                      : io::format_quantity(found->second * name.factor, name.dimension));
  }
  return keys;
}

KeyTexts labels_of(const io::Packing& file, const std::string& prefix) {
  KeyTexts keys;
  for (const auto& [name, text] : file.labels) {
    if (name.starts_with(prefix)) keys.emplace_back(name, text);
  }
  return keys;
}

/// Equal to 9 digits: the recipe of an older file has the friction as a coefficient.
bool is_same(const std::string& a, const std::string& b) {
  if (io::same_value(a, b)) return true;
  try {
    const double x = io::parse_quantity(a, Dimension::angle), y = io::parse_quantity(b, Dimension::angle);
    return std::abs(x - y) <= 1e-9;
  } catch (const io::UnitError&) {
    return false;
  }
}

}  // namespace

KeyTexts soil_keys(const SoilCase& soil) {
  KeyTexts keys;
  if (soil.sizes.empty()) {
    keys.emplace_back("soil.size_minimum", io::format_quantity(soil.size_minimum, Dimension::length));
    keys.emplace_back("soil.size_maximum", io::format_quantity(soil.size_maximum, Dimension::length));
  } else {
    keys.emplace_back("soil.sizes", list_of(soil.sizes, Dimension::length));
    keys.emplace_back("soil.passing", list_of(soil.passing, Dimension::none));
    keys.emplace_back("soil.passing_by", soil.passing_by == GradingMeasure::area ? "area" : "number");
  }
  if (soil.classes.empty()) add_material(soil, "soil", keys);
  for (std::size_t k = 0; k < soil.classes.size(); ++k) {
    const std::string table = fmt::format("soil.class[{}]", k);
    keys.emplace_back(table + ".size_to", io::format_quantity(soil.classes[k].size_to, Dimension::length));
    add_material(soil.classes[k], table, keys);
  }
  keys.emplace_back("soil.damping", io::format_quantity(soil.damping, Dimension::none));
  keys.emplace_back("soil.thickness", io::format_quantity(soil.thickness, Dimension::length));
  return keys;
}

KeyTexts engine_keys(const EngineCase& engine) {
  const bool is_float = engine.precision == kernels::Precision::float32;
  const bool by_accuracy = engine.accuracy > 0;  // each state then has an inertial number of its own
  return {{"engine.precision", is_float ? "float" : "double"},
          {by_accuracy ? "engine.accuracy" : "engine.inertial_number",
           io::format_quantity(by_accuracy ? engine.accuracy : engine.inertial_number, Dimension::none)},
          {"engine.hold_tolerance", io::format_quantity(engine.hold_tolerance, Dimension::none)}};
}

KeyTexts soil_keys_of(const io::Packing& file) {
  KeyTexts keys = labels_of(file, "soil.");
  const auto recipe = file.labels.find("recipe");
  if (keys.empty() && recipe != file.labels.end()) keys = soil_of_recipe(recipe->second);
  return keys.empty() ? soil_of_numbers(file.numbers) : keys;
}

KeyTexts engine_keys_of(const io::Packing& file) { return labels_of(file, "engine."); }

std::vector<io::KeyDifference> differences(const KeyTexts& ours, const KeyTexts& theirs) {
  std::vector<io::KeyDifference> found;
  for (const auto& [key, text] : theirs) {
    const auto mine = std::find_if(ours.begin(), ours.end(),
                                   [&k = key](const auto& entry) { return entry.first == k; });
    if (mine == ours.end()) {
      found.push_back({key, "nothing", text});
    } else if (!is_same(mine->second, text)) {
      found.push_back({key, mine->second, text});
    }
  }
  return found;
}

}  // namespace voussoir::host
