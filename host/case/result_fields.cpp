#include "host/case/result_fields.hpp"

#include <array>

namespace voussoir::host {

bool ask_for(const std::string& name, kernels::MicrostructureRequest& request) {
  request.fabric = request.fabric || name == "fabric";
  request.coordination = request.coordination || name == "coordination";
  request.strong_networks = request.strong_networks || name == "strong_networks";
  return name == "fabric" || name == "coordination" || name == "strong_networks";
}

std::vector<MicrostructureField> microstructure_fields(const kernels::MicrostructureRequest& wanted) {
  using M = kernels::Microstructure;
  std::vector<MicrostructureField> out;
  if (wanted.fabric) {
    out.push_back({"fabric_anisotropy", "-", [](const M& m) { return m.fabric_anisotropy; }});
    out.push_back({fabric_direction, "rad", [](const M& m) { return m.fabric_direction; }});
  }
  if (wanted.coordination) {
    out.push_back({"mechanical_coordination", "-", [](const M& m) { return m.mechanical_coordination; }});
  }
  if (wanted.strong_networks) {
    static_assert(kernels::strong_thresholds == std::array{1.0, 2.0, 2.5}, "the names below say the thresholds");
    out.push_back({"strong_coordination_1", "-", [](const M& m) { return m.strong_coordination[0]; }});
    out.push_back({"strong_coordination_2", "-", [](const M& m) { return m.strong_coordination[1]; }});
    out.push_back({"strong_coordination_2_5", "-", [](const M& m) { return m.strong_coordination[2]; }});
  }
  return out;
}

}  // namespace voussoir::host
