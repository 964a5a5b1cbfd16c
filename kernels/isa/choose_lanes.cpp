#include "kernels/isa/choose_lanes.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>

namespace voussoir::kernels {

namespace {

constexpr const char* variable = "VOUSSOIR_ISA";

const LaneSet* find_lanes(InstructionSet isa) {
  for (const LaneSet* lanes : compiled_lanes()) {
    if (lanes->isa == isa) return lanes;
  }
  return nullptr;
}

/// The names of the sets in the program, or of those among them that the processor takes.
std::string names(bool only_takeable) {
  std::string text;
  for (const LaneSet* lanes : compiled_lanes()) {
    if (only_takeable && lanes->isa > processor_set()) continue;
    text += (text.empty() ? "" : ", ") + std::string(name_of(lanes->isa));
  }
  return text;
}

LaneChoice best() {
  LaneChoice choice;
  for (const LaneSet* lanes : compiled_lanes()) {
    if (lanes->isa <= processor_set()) choice.lanes = lanes;
  }
  if (choice.lanes == nullptr) choice.lanes = compiled_lanes().front();  // whose instructions the whole program needs
  choice.reason = choice.lanes->isa == processor_set()
                      ? "the processor offers no larger set"
                      : std::string("the largest set in this program that the processor takes, which offers ") +
                            name_of(processor_set()) + " (a build with -DVOUSSOIR_ISA=all holds all sets)";
  return choice;
}

LaneChoice choose(std::optional<InstructionSet> wish) {
  if (wish) {
    const std::string fault = why_not(*wish);
    if (!fault.empty()) throw UnusableLanes(std::string("engine.isa: ") + name_of(*wish) + " " + fault);
    return {find_lanes(*wish), "engine.isa asks for it"};
  }
  const char* const value = std::getenv(variable);
  if (value == nullptr || *value == '\0' || std::string(value) == "auto") return best();
  const std::string where = std::string("the environment variable ") + variable;
  const auto asked = find_instruction_set(value);
  if (!asked) throw UnusableLanes(where + " is \"" + value + "\"; it can be auto, scalar, v3 or v4");
  const std::string fault = why_not(*asked);
  if (!fault.empty()) throw UnusableLanes(where + ": " + value + " " + fault);
  return {find_lanes(*asked), where + " asks for it"};
}

std::optional<LaneChoice>& current() {
  static std::optional<LaneChoice> choice;
  return choice;
}

}  // namespace

std::span<const LaneSet* const> compiled_lanes() {
  static constexpr std::array sets{
      &voussoir_lanes_plain,
#if defined(VOUSSOIR_HAS_V3)
      &voussoir_lanes_v3,
#endif
#if defined(VOUSSOIR_HAS_V4)
      &voussoir_lanes_v4,
#endif
  };
  return sets;
}

std::optional<InstructionSet> find_instruction_set(const std::string& name) {
  for (const InstructionSet isa : {InstructionSet::scalar, InstructionSet::v3, InstructionSet::v4}) {
    if (name == name_of(isa)) return isa;
  }
  return {};
}

std::string why_not(InstructionSet isa) {
  if (isa > processor_set()) {
    return "is not offered by this processor (" + processor_name() + "), which takes " + names(true);
  }
  if (find_lanes(isa) == nullptr) {
    return "is not in this program, which holds " + names(false) + "; a build with -DVOUSSOIR_ISA=all holds all sets";
  }
  return {};
}

const LaneChoice& choose_lanes(std::optional<InstructionSet> wish) {
  static std::vector<const LaneSet*> begun;
  const LaneChoice& choice = current().emplace(choose(wish));
  if (std::find(begun.begin(), begun.end(), choice.lanes) == begun.end()) {
    choice.lanes->begin();
    begun.push_back(choice.lanes);
  }
  return choice;
}

const LaneChoice& chosen_lanes() {
  const std::optional<LaneChoice>& now = current();
  return now ? *now : choose_lanes({});
}

std::string lanes_sentence(const LaneChoice& choice) {
  const bool slow = choice.lanes->isa == InstructionSet::scalar;
  return std::string("lanes: ") + description_of(choice.lanes->isa) +
         (slow ? ", 150 to 300 times slower than v3 and v4 (docs/measurements/isa.md)" : "") + ", " +
         std::to_string(choice.lanes->floats) + " RVEs side by side in float and " +
         std::to_string(choice.lanes->doubles) + " in double; " + choice.reason;
}

}  // namespace voussoir::kernels
