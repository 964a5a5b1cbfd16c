#include "host/case/grains.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "host/case/keys.hpp"
#include "io/packing_file.hpp"
#include "io/units.hpp"

namespace voussoir::host {

using io::Dimension;

namespace {

// Limits that [soil] and its classes share. Within them the engine's numbers stay far from the ends of what a float can
// hold, and a run ends with an answer or says why it has none; tests/regression/key_limits_test.py tries all of them.
const io::QuantityRule size_rule{.at_least = "0.001 mm", .at_most = "1 m"};
const io::QuantityRule modulus_rule{.at_least = "1 MPa", .at_most = "1000 GPa"};
const io::QuantityRule stiffness_ratio_rule{.at_least = "0", .at_most = "2"};
const io::QuantityRule friction_rule{.at_least = "0 deg", .at_most = "80 deg"};
const io::QuantityRule rolling_rule{.at_least = "0", .at_most = "10"};  ///< of rolling_stiffness and rolling_limit

/// Seeds are stored as float64 with the packings, and derived ones are larger by up to a million.
constexpr std::int64_t largest_seed = 9'000'000'000'000'000;
constexpr std::size_t most_seeds = 1000;
constexpr std::int64_t most_variety = 1000;

/// Reads what decides a contact, into the soil or a class of grains. `default_words` as in io::QuantityRule.
template <class Grains>
void read_contact(const io::Table& table, Grains& grains, const std::string& default_words) {
  const auto read = [&](const io::Key& key, Dimension dimension, double& member, io::QuantityRule rule) {
    rule.default_words = default_words;
    read_quantity(table, key, dimension, member, rule);
  };
  read({"modulus",
        "Contact modulus E, from which the normal stiffness k_n of a contact follows. It is a property of the "
        "contact law, far larger than the Young's modulus of the soil. It is no knob for speed: with a tenth "
        "of the default, q/p at 100 kPa nearly halves (docs/validation/trade.md)."},
       Dimension::pressure, grains.modulus, modulus_rule);
  read({"stiffness_ratio", "Ratio k_t / k_n of the tangential to the normal stiffness of a contact."}, Dimension::none,
       grains.stiffness_ratio, stiffness_ratio_rule);
  read({"friction",
        "Friction angle of a contact between two grains, which bounds its tangential force. It is not the "
        "friction angle of the soil, which also depends on density and on the rolling resistance."},
       Dimension::angle, grains.friction_angle, friction_rule);
  read({"rolling_stiffness",
        "Rolling stiffness beta of a contact: two grains of the radii r1 and r2 resist rolling on each "
        "other with the stiffness k_r = beta k_t r1 r2. With 0 for this key or for `rolling_limit` "
        "grains roll freely."},
       Dimension::none, grains.rolling_stiffness, rolling_rule);
  read({"rolling_limit",
        "Rolling limit eta of a contact: its moment is at most eta r f_n, where r is a radius and f_n the "
        "normal force. Rolling resistance stands for the angular shape of grains; larger values make "
        "the soil stronger."},
       Dimension::none, grains.rolling_limit, rolling_rule);
}

/// Refuses what is no grading curve.
void check_grading(const io::Table& table, const SoilCase& soil) {
  const std::size_t sizes = soil.sizes.size(), shares = soil.passing.size();
  if (sizes != shares) {
    const bool lacks_sizes = sizes == 0;
    throw table.error(
        lacks_sizes ? "sizes" : "passing",
        fmt::format("must have as many entries as {}, has {} in place of {}", lacks_sizes ? "passing" : "sizes",
                    lacks_sizes ? sizes : shares, lacks_sizes ? shares : sizes));
  }
  if (sizes == 0) return;
  if (sizes < 2) throw table.error("passing", "must rise from 0 to 1, has only one entry");
  table.expect_order("sizes", soil.sizes, io::Order::ascending);
  table.expect_order("passing", soil.passing, io::Order::not_falling);
  for (const std::size_t end : {std::size_t{0}, shares - 1}) {
    if (soil.passing[end] == (end == 0 ? 0.0 : 1.0)) continue;
    throw table.entry_error("passing", end,
                            fmt::format("must rise from 0 to 1, but {} is the {} one",
                                        table.entry_shown("passing", end), end == 0 ? "first" : "last"));
  }
}

/// Reads `sizes` and `passing`, a grading curve, which also sets the smallest and the largest size.
void read_grading(const io::Table& table, SoilCase& soil) {
  soil.sizes = table.quantities(
      {"sizes",
       "Grading curve: the grain diameters of its points, ascending. Without the key, diameters are drawn uniformly by "
       "number between `size_minimum` and `size_maximum`."},
      Dimension::length, size_rule, std::vector<std::string>{});
  soil.passing = table.quantities(
      {"passing",
       "Grading curve: the share of grains that is smaller than each entry of `sizes`, rising from 0 to 1 as a sieve "
       "curve does."},
      Dimension::none, {.at_least = "0", .at_most = "1"}, std::vector<std::string>{});
  soil.passing_by = table.choice({"passing_by",
                                  "What the shares in `passing` count: the area of the grains, which is their mass in "
                                  "two dimensions and what a "
                                  "sieve curve gives, or their number."},
                                 {"area", "number"}, "area") == "area"
                        ? GradingMeasure::area
                        : GradingMeasure::number;
  check_grading(table, soil);
  if (soil.sizes.empty()) return;
  soil.size_minimum = soil.sizes.front();
  soil.size_maximum = soil.sizes.back();
}

/// Refuses grains whose sizes differ too much; the message names the keys that the user wrote.
void check_size_range(const io::Table& table, const SoilCase& soil) {
  constexpr double widest = 40;
  constexpr const char* reason = ": an RVE cannot hold grains of so different sizes";
  if (soil.size_maximum <= widest * soil.size_minimum) return;
  if (soil.sizes.empty())
    throw table.error(table.has("size_maximum") ? "size_maximum" : "size_minimum",
                      fmt::format("size_maximum ({}) is more than {} times size_minimum ({}){}",
                                  table.shown("size_maximum"), widest, table.shown("size_minimum"), reason));
  const std::size_t last = soil.sizes.size() - 1;
  throw table.entry_error("sizes", last,
                          fmt::format("{} is more than {} times {}{}", table.entry_shown("sizes", last), widest,
                                      table.entry_shown("sizes", 0), reason));
}

std::string in_mm(double size) { return fmt::format("{:.6g} mm", size * 1e3); }

void read_classes(const io::Table& table, SoilCase& soil) {
  for (const io::Table& entry : table.tables(
           {"class",
            "Grains of a range of sizes, which have a contact law of their own. A key that a class leaves out has the "
            "value of `[soil]`; without classes, all grains have it."})) {
    GrainClassCase grains{.size_to = 0,
                          .modulus = soil.modulus,
                          .stiffness_ratio = soil.stiffness_ratio,
                          .friction_angle = soil.friction_angle,
                          .rolling_stiffness = soil.rolling_stiffness,
                          .rolling_limit = soil.rolling_limit};
    grains.size_to = entry.quantity(
        {"size_to",
         "Largest grain diameter of the class, which begins behind the one before; classes ascend, and the last one "
         "must reach the largest grain."},
        Dimension::length, size_rule);
    read_contact(entry, grains, "the value of `[soil]`");
    if (!soil.classes.empty() && grains.size_to <= soil.classes.back().size_to)
      throw entry.error("size_to", fmt::format("must ascend, but {} is not larger than {} of the class before it",
                                               entry.shown("size_to"), in_mm(soil.classes.back().size_to)));
    soil.classes.push_back(grains);
  }
  if (!soil.classes.empty() && soil.classes.back().size_to < soil.size_maximum * (1 - 1e-12)) {
    throw table.error("class", fmt::format("leaves the largest grains without a class: the last one ends at {}, and "
                                           "the largest grain has {}",
                                           in_mm(soil.classes.back().size_to), in_mm(soil.size_maximum)));
  }
  if (soil.classes.size() > 255) throw table.error("class", "has more than 255 entries");
}

void read_grains(const io::Table& table, PackingCase& packing) {
  read_integer(
      table,
      {"grains",
       "Number of grains in one representative volume element. The time of a run grows with it, and the scatter "
       "among packings falls: docs/validation/trade.md has the strength of packings of 100 to 700 grains."},
      packing.grains, {.at_least = 30, .at_most = 20000});
}

void read_seeds(const io::Table& table, PackingCase& packing) {
  packing.seed = table.integer(
      {"seed",
       "Seed of the random places and sizes of the grains, the first one where several packings "
       "are made. It also decides which packing each point of a mesh gets."},
      {.fallback = packing.seed, .at_least = 0, .at_most = largest_seed});
  packing.seeds = table.integers(
      {"seeds", "Seeds of the packings, in place of the consecutive ones that `seed` and `candidates` name."},
      {.at_least = 0, .at_most = largest_seed}, std::vector<std::int64_t>{}, {.most = most_seeds, .different = true});
}

/// Reads how loose grains become a packing.
void read_consolidation(const io::Table& table, PackingCase& packing) {
  read_quantity(table,
                {"consolidation_friction",
                 "Friction coefficient of the contacts while a packing is consolidated, which decides its density: 0 "
                 "makes the densest packing, larger values make looser ones."},
                Dimension::none, packing.consolidation_friction, {.at_least = "0", .at_most = "2"});
  packing.consolidation_rolling = table.boolean(
      {"consolidation_rolling",
       "Lets the rolling resistance of `[soil]` act while a packing is consolidated, too; otherwise grains "
       "roll freely then."},
      packing.consolidation_rolling);
  read_quantity(
      table,
      {"void_ratio",
       "Void ratio of the finished packing, for which the program searches `consolidation_friction`; 0 leaves "
       "that value as it is given."},
      Dimension::none, packing.void_ratio, {.at_least = "0", .at_most = "1"});
}

/// Reads the keys that are the same for all packings of a mesh.
void read_common(const io::Table& table, PackingCase& packing) {
  read_quantity(
      table,
      {"pressure",
       "Isotropic pressure of the finished packing. A tunnel and a column start from it, so that it must equal "
       "`ground.surcharge`; in a scene every boundary that nothing holds carries it."},
      Dimension::pressure, packing.pressure, {.at_least = "100 Pa", .at_most = "10 MPa"});
  packing.mirrored = table.boolean({"mirrored",
                                    "Gives every second Gauss point of a mesh the mirror image of its packing, so that "
                                    "what a packing prefers to the "
                                    "left and to the right cancels out."},
                                   packing.mirrored);
  packing.folder = table.text({"folder",
                               "Folder in which finished packings are kept and looked for, so that each is made once; "
                               "it may be a new one. It is "
                               "relative to the folder in which the program was started."},
                              packing.folder.string());
  std::error_code failure;
  const auto folder = std::filesystem::status(packing.folder, failure).type();
  const bool usable = folder == std::filesystem::file_type::directory ||
                      folder == std::filesystem::file_type::not_found;
  if (packing.folder.empty() || !usable) throw table.error("folder", "must name a folder, which may be a new one");
}

/// The packing in a file. The whole file is read, so that a fault in it is found before a run.
io::Packing packing_in(const io::Table& table, const std::filesystem::path& file) {
  try {
    return io::load_any_packing(file);
  } catch (const std::runtime_error& error) {
    throw table.error("file", error.what());
  }
}

/// Reads `file`, which names one file or several, and what depends on it.
void read_files(const io::Table& table, PackingCase& packing) {
  packing.files = table.optional_paths(
      {"file",
       "Packings that are taken in place of made ones: one or several `NAME_particles.csv` of another program, or one "
       "`packing_*.h5`, a stored state from which only kind `probe` can start. Grains and their sizes are then those "
       "of "
       "the file."});
  if (!packing.files.empty()) packing.grains = 0;
  std::set<std::vector<double>> places;  // two names may lead to one packing, and two files hold copies of it
  for (const std::filesystem::path& file : packing.files) {
    const io::Packing there = packing_in(table, file);
    packing.grains = std::max(packing.grains, static_cast<int>(there.grains()));
    std::vector<double> x = there.x;
    std::sort(x.begin(), x.end());  // other programs may have another order of the same grains
    if (!places.insert(std::move(x)).second)
      throw table.error("file",
                        fmt::format("names a packing twice: {} holds the grains of another file", file.string()));
    if (packing.files.size() > 1 && file.extension() == ".h5")
      throw table.error("file", "names a stored state among others: a state is read alone");
  }
}

/// Reads `candidates` and `variety`. Without these keys all files are used, and one packing of those of the seeds.
void read_variety(const io::Table& table, bool on_a_mesh, PackingCase& packing) {
  packing.variety = packing.files.empty() ? 1 : static_cast<int>(packing.files.size());
  read_integer(
      table,
      {"variety",
       "Number of different packings that are mixed over the points of a mesh. With one packing its draw decides "
       "the result; several packings average over the draw."},
      packing.variety,
      {.at_least = 1, .at_most = most_variety, .default_words = "the number of files in `file`, else 1"});
  packing.candidates = on_a_mesh ? packing.variety : 1;
  read_integer(table,
               {"candidates",
                "Number of seeds that are tried, beginning with `seed`; the `variety` packings with the least shear "
                "stress over vertical stress are taken, which are those nearest to isotropy."},
               packing.candidates, {.at_least = 1, .at_most = 1000, .default_words = "the value of `variety`"});
}

}  // namespace

SoilCase read_soil(const io::Table& table) {
  SoilCase soil;
  read_grading(table, soil);
  if (soil.sizes.empty()) {
    read_quantity(table, size_minimum_key, Dimension::length, soil.size_minimum, size_rule);
    read_quantity(table, size_maximum_key, Dimension::length, soil.size_maximum, size_rule);
  }
  if (soil.size_maximum < soil.size_minimum)
    throw table.error("size_maximum", fmt::format("is smaller than size_minimum ({})", table.shown("size_minimum")));
  check_size_range(table, soil);
  read_contact(table, soil, "");
  read_quantity(table,
                {"damping",
                 "Local damping: the share of the unbalanced force on a grain that is turned against its motion, so "
                 "that the grains come to rest."},
                Dimension::none, soil.damping, {.at_least = "0", .at_most = "0.9"});
  read_quantity(table,
                {"density",
                 "Density of the grains' material. No result depends on it, because loading is quasi-static and the "
                 "program gives the grains masses of its own; the key is there to document the soil."},
                Dimension::density, soil.density, {.at_least = "1 kg/m3", .at_most = "100000 kg/m3"});
  read_quantity(
      table,
      {"thickness",
       "Thickness of a representative volume element out of the plane: the stress is the sum of contact forces "
       "over area times thickness. Thicker elements carry larger contact forces at the same stress, which makes "
       "their contacts softer relative to the pressure."},
      Dimension::length, soil.thickness, {.at_least = "1 mm", .at_most = "100 m"});
  read_classes(table, soil);
  return soil;
}

PackingCase read_packing(const io::Table& table, bool on_a_mesh) {
  PackingCase packing;
  read_grains(table, packing);
  read_seeds(table, packing);
  read_consolidation(table, packing);
  read_common(table, packing);
  read_files(table, packing);
  read_variety(table, on_a_mesh, packing);
  return packing;
}

PackingCase read_region_packing(const io::Table& table, const PackingCase& common) {
  PackingCase packing;
  packing.pressure = common.pressure;
  packing.mirrored = common.mirrored;
  packing.folder = common.folder;
  packing.seed = common.seed;
  packing.seeds = common.seeds;
  read_grains(table, packing);
  read_consolidation(table, packing);
  read_files(table, packing);
  read_variety(table, true, packing);
  check_variety(table, packing);
  check_no_state(table, packing);
  return packing;
}

void check_no_state(const io::Table& table, const PackingCase& packing) {
  if (packing.has_state()) {
    throw table.error(
        "file", "is a stored state: only kind = \"probe\" can start from it, all other kinds need isotropic pressure");
  }
}

void check_variety(const io::Table& table, const PackingCase& packing) {
  std::size_t there = static_cast<std::size_t>(packing.candidates);
  const char* key = "candidates";
  if (!packing.seeds.empty()) there = packing.seeds.size(), key = "seeds";
  if (!packing.files.empty()) there = packing.files.size(), key = "file";
  if (there < static_cast<std::size_t>(packing.variety)) {
    throw table.error("variety", fmt::format("asks for {} different packings, but packing.{} has only {}",
                                             packing.variety, key, there));
  }
}

}  // namespace voussoir::host
