#include "host/case/result_fields.hpp"

#include <utility>

namespace voussoir::host {

bool ask_for(std::string_view name, kernels::MicrostructureRequest& request) {
  using Request = kernels::MicrostructureRequest;
  constexpr std::array<std::pair<const char*, bool Request::*>, 3> requests{
      {{"fabric", &Request::fabric},
       {"coordination", &Request::coordination},
       {"strong_networks", &Request::strong_networks}}};
  for (const auto& [known, member] : requests) {
    if (name != known) continue;
    request.*member = true;
    return true;
  }
  return false;
}

}  // namespace voussoir::host
