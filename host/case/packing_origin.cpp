#include "host/case/packing_origin.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <string>
#include <vector>

#include "host/case/made_with.hpp"
#include "io/packing_file.hpp"
#include "io/units.hpp"
#include "kernels/contact/engine_law.hpp"

namespace voussoir::host {

namespace {

constexpr std::size_t soil_prefix = 5;  ///< "soil."

/// Where packings are asked for: at the top of the case, or in a region of a scene.
struct Asked {
  const io::Table& owner;  ///< of the tables soil and packing
  std::string prefix;      ///< of the names of their keys
  SoilCase& soil;
  const PackingCase& packing;
};

/// The error at the key's own place, where the case has this key.
[[noreturn]] void refuse(const io::Table& owner, const io::KeyDifference& difference, const std::string& maker) {
  const std::string key = difference.key.substr(soil_prefix);
  throw owner.known_table("soil").error(
      key, fmt::format("this case has {}, {} was made with {}", difference.ours, maker, difference.theirs));
}

void check_state(const Asked& asked, const std::filesystem::path& name, Case& input) {
  const io::Packing file = io::load_packing(name);
  const std::string maker = "the state in " + name.string();
  const io::Table packing = asked.owner.known_table("packing");
  constexpr auto& names = kernels::PlainEngineLaw::history_names;
  const std::vector<std::string> ours(names.begin(), names.end());
  if (file.history_names != ours) {
    throw packing.error("file", fmt::format("law: this program's contact law keeps [{}], {} has [{}]",
                                            fmt::join(ours, ", "), maker, fmt::join(file.history_names, ", ")));
  }
  const KeyTexts soil = soil_keys_of(file);
  if (soil.empty()) {
    throw packing.error("file",
                        "does not say which soil its state was made with, because an older version of this "
                        "program wrote it: make the state anew");
  }
  const std::vector<io::KeyDifference> different = differences(soil_keys(asked.soil), soil);
  if (!different.empty()) refuse(asked.owner, different.front(), maker);
  // A key that the file has lost, others being there, would let any value of the case pass.
  for (const io::KeyDifference& lost : differences(soil, soil_keys(asked.soil))) {
    throw packing.error("file", fmt::format("does not say {} of the soil that {} was made with, but other keys of it: "
                                            "make the state anew",
                                            lost.key, maker));
  }
  for (const io::KeyDifference& d : differences(engine_keys(input.engine), engine_keys_of(file))) {
    input.remarks.push_back(
        fmt::format("{}: this case has {}, {} was made with {}; the two may differ, because the run "
                    "begins with a look at the state and says whether it is at rest",
                    d.key, d.ours, maker, d.theirs));
  }
}

void check_foreign_packing(const Asked& asked, const std::filesystem::path& name, Case& input) {
  const io::Packing file = io::load_packing_csv(name);
  const std::string maker = "the packing in " + name.string();
  const auto length = [](double x) { return io::format_quantity(x, io::Dimension::length); };
  if (asked.soil.thickness != file.thickness) {
    if (asked.owner.known_table("soil").has("thickness")) {
      throw asked.owner.known_table("soil").error(
          "thickness", fmt::format("this case has {}, {} was made with {}", length(asked.soil.thickness), maker,
                                   length(file.thickness)));
    }
    const std::string first = asked.packing.files.front().string();
    if (name != first) {  // the RVEs of a mesh share one thickness, since their stresses are forces over it
      throw asked.owner.known_table("packing").error(
          "file", fmt::format("names packings of different thickness: {} in {} and {} in {}",
                              length(asked.soil.thickness), first, length(file.thickness), name.string()));
    }
    input.remarks.push_back(fmt::format("{}soil.thickness: {} has {}, which the run takes; the case gives none",
                                        asked.prefix, maker, length(file.thickness)));
    asked.soil.thickness = file.thickness;
  }
  if (input.kind == CaseKind::calibrate && !input.calibrate.thickness.empty()) {
    throw asked.owner.known_table("calibrate")
        .error("thickness", "cannot be searched: packing.file has a thickness of its own");
  }
  for (const io::KeyDifference& d : differences(soil_keys(asked.soil), soil_keys_of(file))) {
    // The sizes of the grains are those of the file, whatever curve the case gives.
    const bool is_size = d.key.find(".size") != std::string::npos || d.key.find(".passing") != std::string::npos;
    if (is_size || d.ours == "nothing" || d.key == "soil.thickness") continue;
    input.remarks.push_back(
        fmt::format("{}{}: this case has {}, {} was made with {}; the two may differ, because the "
                    "packing comes to rest anew with this case's soil",
                    asked.prefix, d.key, d.ours, maker, d.theirs));
  }
}

/// The packings of a scene are those of its regions of grains.
void check_regions(const io::Table& root, Case& input) {
  const std::vector<io::Table> entries = root.known_tables("region");
  for (std::size_t k = 0; k < entries.size(); ++k) {
    RegionCase& region = input.scene.regions[k];
    if (region.elastic) continue;
    const Asked asked{entries[k], fmt::format("region[{}].", k), region.soil, region.packing};
    for (const std::filesystem::path& name : region.packing.files) check_foreign_packing(asked, name, input);
  }
}

}  // namespace

void check_packing_origin(const io::Table& root, Case& input) {
  if (runs_on_a_mesh(input.kind) && input.material != MaterialKind::grains) return;
  if (input.kind == CaseKind::scene) return check_regions(root, input);
  const Asked asked{root, "", input.soil, input.packing};
  for (const std::filesystem::path& name : input.packing.files) {
    if (input.packing.has_state()) {
      check_state(asked, name, input);
    } else {
      check_foreign_packing(asked, name, input);
    }
  }
}

}  // namespace voussoir::host
