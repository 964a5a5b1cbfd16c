#pragma once
/// Whether a case presses its grains beyond what the contact law is good for, or has a unit weight or a stiffness of
/// the grains that is far from those of soils; told before it is run.

#include <string>
#include <vector>

#include "host/case/case.hpp"

namespace voussoir::host {

struct Foretold {
  std::string line;                   ///< kappa and mean overlap at the largest pressure; empty without grains
  std::vector<std::string> warnings;  ///< what is beyond the law's range (packing/law_range.hpp), or no likely value
};

/// The largest pressure of the case's own loads, and what it does to the grains; its unit weights, and the stiffness of
/// its contacts. Paths of `probe` are not foretold. In
/// a scene every region with grains is pressed as the deepest point of its mesh is; the line is that of the region
/// whose grains overlap most.
/// @param height of a scene's mesh [m]
[[nodiscard]] Foretold foretell(const Case& input, double height);

}  // namespace voussoir::host
