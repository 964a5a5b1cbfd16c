#include "host/case/result_fields.hpp"

#include <algorithm>
#include <utility>

#include "host/case/case.hpp"

namespace voussoir::host {

bool is_written(const ResultField& field, const OutputCase& output) {
  const std::vector<std::string>& names = output.fields;
  return is_asked_for(field, output.microstructure) &&
         (names.empty() || std::find(names.begin(), names.end(), field.name) != names.end());
}

kernels::MicrostructureRequest written_quantities(const OutputCase& output) {
  kernels::MicrostructureRequest written;
  for (const ResultField& field : result_field_table) {
    if (field.request != nullptr && is_written(field, output)) written.*field.request = true;
  }
  return written;
}

std::vector<std::string> result_field_names() {
  std::vector<std::string> names;
  for (const ResultField& field : result_field_table) names.emplace_back(field.name);
  return names;
}

namespace {

using Request = kernels::MicrostructureRequest;
constexpr std::array<std::pair<const char*, bool Request::*>, 3> requests{
    {{"fabric", &Request::fabric},
     {"coordination", &Request::coordination},
     {"strong_networks", &Request::strong_networks}}};

}  // namespace

std::vector<std::string> microstructure_names() {
  std::vector<std::string> names;
  for (const auto& [name, member] : requests) names.emplace_back(name);
  return names;
}

bool ask_for(std::string_view name, kernels::MicrostructureRequest& request) {
  for (const auto& [known, member] : requests) {
    if (name != known) continue;
    request.*member = true;
    return true;
  }
  return false;
}

}  // namespace voussoir::host
