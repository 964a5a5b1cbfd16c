#include "host/case/case.hpp"

namespace voussoir::host {

std::string to_string(CaseKind kind) {
  for (const auto& [candidate, name] : case_kind_names) {
    if (candidate == kind) return name;
  }
  return "unknown";
}

std::string to_string(MaterialKind kind) { return kind == MaterialKind::grains ? "grains" : "linear_elastic"; }

std::string place_of(const Case& input, const std::string& key) {
  const auto found = input.places.find(key);
  return found != input.places.end() && !found->second.empty() ? found->second : input.name;
}

}  // namespace voussoir::host
