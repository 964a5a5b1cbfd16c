#pragma once
/// Names and units under which the contact network's quantities appear in result files (io/FORMAT.md).

#include <string>
#include <vector>

#include "kernels/state/network.hpp"

namespace voussoir::host {

inline constexpr const char* fabric_direction = "fabric_direction";

struct MicrostructureField {
  const char* name;
  const char* unit;
  double (*value)(const kernels::Microstructure&);
};

/// Adds what an entry of `output.microstructure` names; false where it names nothing.
[[nodiscard]] bool ask_for(const std::string& name, kernels::MicrostructureRequest& request);

/// The fields of a request beyond those that every RVE has (coordination, grain rotation).
[[nodiscard]] std::vector<MicrostructureField> microstructure_fields(const kernels::MicrostructureRequest& wanted);

}  // namespace voussoir::host
