#pragma once
/// The choice of the lanes' instruction set, once for the whole process: a wish of the caller comes first, then the
/// environment variable VOUSSOIR_ISA, then the largest set that the program holds and the processor takes. All sets
/// give the same bits.

#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "kernels/isa/lane_set.hpp"

namespace voussoir::kernels {

/// The user asks for lanes that the program or the processor lacks.
class UnusableLanes : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Sets in the program, in ascending order.
[[nodiscard]] std::span<const LaneSet* const> compiled_lanes();

/// The name of a set; no value where the text names none.
[[nodiscard]] std::optional<InstructionSet> find_instruction_set(const std::string& name);

/// Why a set cannot be taken, as the rest of a sentence that begins with the set; empty where it can be taken.
[[nodiscard]] std::string why_not(InstructionSet isa);

struct LaneChoice {
  const LaneSet* lanes = nullptr;
  std::string reason;  ///< of the choice, as the rest of a sentence
};

/// Chooses for the whole process; without a wish as if the process had just started. Not to be called while RVEs
/// advance.
/// @throws UnusableLanes where the wish, or VOUSSOIR_ISA, names a set that cannot be taken
const LaneChoice& choose_lanes(std::optional<InstructionSet> wish);

/// The choice that was made, or the one without a wish, which the first call makes.
[[nodiscard]] const LaneChoice& chosen_lanes();

/// The choice in one sentence.
[[nodiscard]] std::string lanes_sentence(const LaneChoice& choice);

}  // namespace voussoir::kernels
