#include "host/case/idle_keys.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "host/case/grains.hpp"

namespace voussoir::host {

namespace {

using Condition = bool (*)(const Case&);

/// Keys of one table that do not count where the condition holds; without keys it is the whole table.
struct IdleRule {
  const char* table;
  std::vector<const char*> keys;
  Condition when;
  const char* reason;  ///< completes "not used, because ..."
};

bool on_a_mesh(const Case& c) { return runs_on_a_mesh(c.kind); }
bool is_elastic(const Case& c) { return on_a_mesh(c) && c.material == MaterialKind::linear_elastic; }
bool has_file(const Case& c) { return !c.packing.files.empty(); }
bool has_state(const Case& c) { return c.packing.has_state(); }
bool has_no_mesh(const Case& c) { return !on_a_mesh(c); }
bool has_seeds(const Case& c) { return !c.packing.seeds.empty(); }
bool has_one_packing(const Case& c) { return has_file(c) && c.packing.variety == 1; }
bool has_one_of_seeds(const Case& c) { return has_seeds(c) && (c.packing.variety == 1 || !on_a_mesh(c)); }
bool searches_void_ratio(const Case& c) { return c.packing.void_ratio > 0; }
bool is_frictionless(const Case& c) { return !searches_void_ratio(c) && c.packing.consolidation_friction == 0; }
bool rolls_freely(const Case& c) {
  const auto free = [](const auto& grains) { return grains.rolling_stiffness * grains.rolling_limit == 0; };
  return c.soil.classes.empty() ? free(c.soil) : std::all_of(c.soil.classes.begin(), c.soil.classes.end(), free);
}
bool is_pack(const Case& c) { return c.kind == CaseKind::pack; }
bool runs_tests(const Case& c) { return c.kind == CaseKind::biaxial || c.kind == CaseKind::calibrate; }
bool has_own_pressure(const Case& c) {
  return runs_tests(c) || c.kind == CaseKind::probe || c.kind == CaseKind::biaxial_bvp;
}

bool has_stage_of_gravity(const Case& c) {
  return std::any_of(c.scene.stages.begin(), c.scene.stages.end(), [](const StageCase& s) { return s.steps == 0; });
}
bool has_at_rest(const Case& c) {
  return std::any_of(c.scene.stages.begin(), c.scene.stages.end(), [](const StageCase& stage) {
    return std::any_of(stage.presses.begin(), stage.presses.end(),
                       [](const PressCase& press) { return press.kind == PressKind::at_rest; });
  });
}
bool needs_no_column(const Case& c) { return c.kind == CaseKind::scene && !has_at_rest(c); }
bool needs_no_gravity(const Case& c) { return needs_no_column(c) && !has_stage_of_gravity(c); }

/// The rules go from the widest reason to the narrowest, because a key is reported with the first reason that holds.
const std::vector<IdleRule>& rules() {
  static const std::vector<IdleRule> all{
      {"soil", {}, is_elastic, "material is \"linear_elastic\""},
      {"engine", {}, is_elastic, "material is \"linear_elastic\""},
      {"packing",
       {"grains", "seed", "seeds", "candidates", "variety", "consolidation_friction", "consolidation_rolling",
        "void_ratio", "mirrored", "folder", "file"},
       is_elastic,
       "material is \"linear_elastic\""},
      {"newton", {"tangent", "tangent_strain"}, is_elastic, "material is \"linear_elastic\""},
      {"output", {"microstructure", "rves"}, is_elastic, "material is \"linear_elastic\", which has no grains"},
      {"elastic", {}, [](const Case& c) { return on_a_mesh(c) && !is_elastic(c); }, "material is \"grains\""},
      {"column", {}, needs_no_column, "no stage has a press with at_rest = true"},
      {"gravity", {}, needs_no_gravity, "no stage puts gravity on alone, and none has a press with at_rest = true"},
      {"engine", {}, is_pack, "packings are made with settings of their own"},
      {"engine",
       {"inertial_number", "hold_cap", "minimum_steps", "maximum_steps"},
       runs_tests,
       "tests have the rate of biaxial.inertial_number and no hold"},
      {"packing",
       {"grains", "seeds", "candidates", "consolidation_friction", "consolidation_rolling", "void_ratio", "folder"},
       has_file,
       "packing.file has grains of its own"},
      {"packing", {"seed"}, has_one_packing, "packing.file has grains of its own"},
      {"packing", {"pressure"}, has_state, "packing.file is a stored state, which has its own pressure"},
      {"probe", {"pressure"}, has_state, "packing.file is a stored state, which has its own pressure"},
      {"packing", {"candidates"}, has_seeds, "packing.seeds names the seeds"},
      {"packing", {"seed"}, has_one_of_seeds, "packing.seeds names the seeds"},
      {"packing", {"consolidation_friction"}, searches_void_ratio, "packing.void_ratio searches it"},
      {"packing",
       {"consolidation_rolling"},
       is_frictionless,
       "packing.consolidation_friction is 0, without which grains feel no torque"},
      {"packing", {"consolidation_rolling"}, rolls_freely, "the grains of [soil] do not resist rolling"},
      {"packing", {"pressure"}, has_own_pressure, "the kind's own table says the pressure of its packings"},
      {"packing", {"mirrored"}, has_no_mesh, "only kinds with a mesh have mirror images"},
      {"packing", {"variety"}, has_no_mesh, "only kinds with a mesh mix packings"},
      {"soil", {"density"}, [](const Case&) { return true; }, "the motion is quasi-static, with masses of its own"},
      {"soil",
       {"passing_by"},
       [](const Case& c) { return c.soil.sizes.empty(); },
       "there is no grading curve (soil.sizes, soil.passing)"},
      {"newton",
       {"tangent_strain"},
       [](const Case& c) { return on_a_mesh(c) && c.newton.tangent != kernels::TangentKind::loading; },
       "newton.tangent is not \"loading\""},
      {"newton",
       {"relax_below", "relax_attempts", "relax_near"},
       [](const Case& c) { return on_a_mesh(c) && c.newton.relax_substeps == 0; },
       "newton.relax_substeps = 0 forbids relaxation"},
      {"newton",
       {"relax_attempts", "relax_near", "relax_substeps"},
       [](const Case& c) { return on_a_mesh(c) && c.newton.relax_below == 0; },
       "newton.relax_below = 0 forbids relaxation"},
  };
  return all;
}

/// A grading curve sets the smallest and the largest size, which are keys of their own without a curve.
void declare_sizes(const io::Table& soil) {
  for (const io::Key& key : {size_minimum_key, size_maximum_key}) {
    if (!soil.has(key.name)) continue;
    static_cast<void>(soil.quantity(key, io::Dimension::length));
    soil.declare_idle(key.name, "soil.sizes has the smallest and the largest size");
  }
}

/// A number of [soil] is the default of the classes; where each class has its own, the number of [soil] has no grains.
void declare_class_defaults(const io::Table& soil) {
  const std::vector<io::Table> classes = soil.known_tables("class");
  for (const char* key : {"modulus", "stiffness_ratio", "friction", "rolling_stiffness", "rolling_limit"}) {
    const bool everywhere = std::all_of(classes.begin(), classes.end(),
                                        [key](const io::Table& entry) { return entry.has(key); });
    if (everywhere && !classes.empty()) soil.declare_idle(key, "each soil.class has its own");
  }
}

void declare(const io::Table& owner, const IdleRule& rule) {
  const io::Table table = owner.known_table(rule.table);
  if (rule.keys.empty()) table.declare_idle("", rule.reason);
  for (const char* key : rule.keys) {
    if (table.has(key)) table.declare_idle(key, rule.reason);
  }
}

/// The tables of a region of grains follow the rules of those at the top of the case.
void declare_in_region(const io::Table& entry, const RegionCase& region, const Case& input) {
  if (region.elastic) return;
  Case alone = input;
  alone.soil = region.soil;
  alone.packing = region.packing;
  for (const IdleRule& rule : rules()) {
    const std::string_view table = rule.table;
    if ((table == "soil" || table == "packing") && rule.when(alone)) declare(entry, rule);
  }
  if (!region.soil.sizes.empty()) declare_sizes(entry.known_table("soil"));
  declare_class_defaults(entry.known_table("soil"));
}

}  // namespace

void declare_idle_keys(const io::Table& root, const Case& input) {
  for (const IdleRule& rule : rules()) {
    if (rule.when(input)) declare(root, rule);
  }
  const std::vector<io::Table> entries = root.known_tables("region");
  for (std::size_t k = 0; k < input.scene.regions.size(); ++k)
    declare_in_region(entries[k], input.scene.regions[k], input);
  const io::Table soil = root.known_table("soil");
  if (!input.soil.sizes.empty()) declare_sizes(soil);
  // A calibration searches parameters as factors of [soil], which therefore counts.
  if (input.kind != CaseKind::calibrate) declare_class_defaults(soil);
}

}  // namespace voussoir::host
