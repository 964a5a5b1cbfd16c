#pragma once
/// What `voussoir ensemble --until "5 %" --result COLUMN` asks for.

#include <optional>
#include <string>

#include "host/case/case.hpp"

namespace voussoir::host {

struct Goal {
  std::string result;  ///< column whose last value is looked at
  double share = 0;    ///< wanted standard error over the absolute value of the mean [-]
};

/// The goal of these options, of which the result may be empty; nothing where `until` is empty. Throws io::InputError
/// where the share is no share, or where the members would have no such result.
[[nodiscard]] std::optional<Goal> goal_of(const Case& input, const std::string& until, const std::string& result);

}  // namespace voussoir::host
