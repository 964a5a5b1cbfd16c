#include "host/ensemble/csv.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

namespace voussoir::host {
namespace {

std::string number(double value) { return std::isnan(value) ? std::string() : fmt::format("{:.9g}", value); }

/// The number of increments that did not converge.
std::ptrdiff_t unconverged(const MemberResults& member) {
  return std::count_if(member.increments.begin(), member.increments.end(),
                       [](const io::IncrementInfo& info) { return !info.converged; });
}

}  // namespace

std::string curves_csv(const io::EnsembleData& data) {
  std::string text = "stage,load_parameter,converged_members";
  for (const io::Bands& curve : data.curves) {
    for (const char* what : {"mean", "deviation", "mean_half_width", "prediction_half_width"})
      text += fmt::format(",{}_{}", curve.name, what);
  }
  text += "\n";
  for (std::size_t row = 0; row < data.increments.size(); ++row) {
    const io::EnsembleIncrement& increment = data.increments[row];
    text += fmt::format("{},{:.9g},{}", increment.stage, increment.load_parameter, increment.converged);
    for (const io::Bands& curve : data.curves) {
      for (const auto* values : {&curve.mean, &curve.deviation, &curve.mean_half_width, &curve.prediction_half_width})
        text += fmt::format(",{}", number((*values)[row]));
    }
    text += "\n";
  }
  return text;
}

std::string members_csv(const std::vector<io::EnsembleMember>& members, const std::vector<MemberResults>& reduced) {
  std::set<std::string> columns;
  for (const MemberResults& member : reduced) {
    for (const auto& [name, value] : results_of(member.increments.back())) columns.insert(name);
  }
  std::string text = "name,seed,status,exit_code,reduced,unconverged_increments,stage,load_parameter";
  for (const std::string& column : columns) text += fmt::format(",{}", column);
  text += "\n";
  std::size_t next = 0;
  for (const io::EnsembleMember& member : members) {
    text += fmt::format("{},{},{},{},{}", member.name, member.seed, member.status, member.exit_code,
                        member.reduced ? 1 : 0);
    const MemberResults* results = member.reduced ? &reduced[next++] : nullptr;
    const io::IncrementInfo* last = results != nullptr ? &results->increments.back() : nullptr;
    text += last != nullptr ? fmt::format(",{},{},{:.9g}", unconverged(*results), last->stage, last->load_parameter)
                            : std::string(",,,");
    for (const std::string& column : columns)
      text += fmt::format(",{}", number(last != nullptr ? value_of(*last, column).value_or(NAN) : NAN));
    text += "\n";
  }
  return text;
}

}  // namespace voussoir::host
