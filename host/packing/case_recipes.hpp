#pragma once
/// The soils and recipes of a whole case: one, or one for each region of a scene.

#include <string>
#include <vector>

#include "host/case/case.hpp"

namespace voussoir::host {

/// A soil and a recipe from which a case makes packings.
struct SoilRecipe {
  const SoilCase* soil;
  const PackingCase* packing;
  std::string table;                      ///< key of the table that holds [soil] and [packing]: "" or "region[1]."
  std::vector<std::string> regions = {};  ///< names of the regions that take it; empty: the whole case

  /// "region bank" or "regions bank, fill"; empty: the whole case.
  [[nodiscard]] std::string place() const;
};

/// The recipes of a case: the one of its root, or in a scene that of each region with grains, and none where the
/// material is elastic everywhere on the mesh. The result points into `input`.
[[nodiscard]] std::vector<SoilRecipe> recipes_of(const Case& input);

/// True where the run needs grains.
[[nodiscard]] bool has_grains(const Case& input);

}  // namespace voussoir::host
