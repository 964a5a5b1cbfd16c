#include "host/ensemble/reduction.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "host/ensemble/member_tables.hpp"
#include "host/ensemble/trough_fit.hpp"

namespace voussoir::host {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// The place of an increment among those of a member; nothing where the member lacks it.
std::optional<std::size_t> place_in(const MemberResults& member, const io::IncrementInfo& wanted) {
  const auto found = std::find_if(member.increments.begin(), member.increments.end(), [&](const auto& info) {
    return info.stage == wanted.stage && info.stage_index == wanted.stage_index &&
           info.load_parameter == wanted.load_parameter;
  });
  if (found == member.increments.end()) return std::nullopt;
  return static_cast<std::size_t>(found - member.increments.begin());
}

/// The places of the ensemble's increments in a member.
std::vector<std::size_t> places_in(const MemberResults& member, const std::vector<io::EnsembleIncrement>& rows) {
  std::vector<std::size_t> places;
  for (const io::EnsembleIncrement& row : rows) places.push_back(place_of(member, row));
  return places;
}

void reduce_columns(std::span<const MemberResults> members, const std::vector<std::vector<std::size_t>>& places,
                    const BandRule& rule, io::EnsembleData& result) {
  const std::size_t rows = result.increments.size();
  std::map<std::string, std::string> units;
  std::map<std::string, std::vector<std::vector<double>>> values;  // by column: (member)(row)
  for (std::size_t m = 0; m < members.size(); ++m) {
    for (std::size_t row = 0; row < rows; ++row) {
      for (const auto& [name, quantity] : results_of(members[m].increments[places[m][row]])) {
        units[name] = quantity.unit;
        auto& column = values[name];
        if (column.empty()) column.assign(members.size(), std::vector<double>(rows, missing));
        column[m][row] = quantity.value;
      }
    }
  }
  for (const auto& [name, column] : values) result.curves.push_back(bands_of(column, rule, name, units[name], {rows}));
}

void reduce_trough(std::span<const MemberResults> members, const std::vector<std::vector<std::size_t>>& places,
                   const BandRule& rule, io::EnsembleData& result) {
  const std::vector<double>& x = members.front().surface_x;
  const bool all = !x.empty() && std::all_of(members.begin(), members.end(),
                                             [&](const MemberResults& member) { return member.surface_x == x; });
  if (!all) return;
  const std::size_t rows = result.increments.size();
  std::vector<std::vector<double>> settlement(members.size());
  for (std::size_t m = 0; m < members.size(); ++m) {
    for (std::size_t row = 0; row < rows; ++row) {
      std::vector<double> line = members[m].settlement[places[m][row]];
      if (line.empty()) line.assign(x.size(), missing);
      settlement[m].insert(settlement[m].end(), line.begin(), line.end());
    }
  }
  result.trough_x = x;
  result.trough = bands_of(settlement, rule, "settlement", "m", {rows, x.size()});
}

}  // namespace

std::vector<io::EnsembleIncrement> common_increments(std::span<const MemberResults> members) {
  std::vector<io::EnsembleIncrement> rows;
  for (const io::IncrementInfo& info : members.front().increments) {
    io::EnsembleIncrement row{.index = info.index,
                              .stage = info.stage,
                              .stage_index = info.stage_index,
                              .load_parameter = info.load_parameter};
    bool in_all = true;
    for (const MemberResults& member : members) {
      const auto place = place_in(member, info);
      in_all = in_all && place.has_value();
      if (!place) continue;
      row.converged += member.increments[*place].converged ? 1 : 0;
      row.good_troughs += member.good_trough[*place] ? 1 : 0;
    }
    if (in_all) rows.push_back(row);
  }
  return rows;
}

std::size_t place_of(const MemberResults& member, const io::EnsembleIncrement& row) {
  const auto place = place_in(
      member, {.stage = row.stage, .stage_index = row.stage_index, .load_parameter = row.load_parameter});
  if (!place)
    throw std::logic_error(fmt::format("{} lacks an increment that all members have", member.folder.string()));
  return *place;
}

void reduce_curves(std::span<const MemberResults> members, const BandRule& rule, io::EnsembleData& result) {
  result.reduced = rule.members;
  result.confidence = rule.confidence;
  result.student_t = rule.student_t;
  result.mean_factor = rule.mean_factor;
  result.prediction_factor = rule.prediction_factor;
  result.mesh = members.front().mesh;
  result.increments = common_increments(members);
  if (result.increments.empty())
    throw std::runtime_error(
        fmt::format("{}: its increments are those of no other member", members.front().folder.string()));
  std::vector<std::vector<std::size_t>> places;
  for (const MemberResults& member : members) places.push_back(places_in(member, result.increments));
  reduce_columns(members, places, rule, result);
  reduce_trough(members, places, rule, result);
  result.tables = reduce_tables(members, rule);
}

double relative_error(std::span<const MemberResults> members, const std::string& column) {
  const std::vector<io::EnsembleIncrement> rows = common_increments(members);
  if (rows.empty()) throw std::runtime_error("the members have no increment in common");
  std::vector<std::vector<double>> last;
  for (const MemberResults& member : members) {
    const auto value = value_of(member.increments[place_of(member, rows.back())], column);
    if (!value || !std::isfinite(*value))
      throw std::runtime_error(
          fmt::format("{}: the last increment of all members has no value of {}", member.folder.string(), column));
    last.push_back({*value});
  }
  const BandRule rule = band_rule(static_cast<int>(members.size()));
  const io::Bands bands = bands_of(last, rule, column, "-", {1});
  const double error = bands.deviation.front() / std::sqrt(static_cast<double>(members.size()));
  const double mean = std::abs(bands.mean.front());
  return mean > 0 ? error / mean : std::numeric_limits<double>::infinity();
}

}  // namespace voussoir::host
