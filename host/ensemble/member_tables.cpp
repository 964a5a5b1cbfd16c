#include "host/ensemble/member_tables.hpp"

#include <algorithm>
#include <cmath>

#include "host/scene/k0_table.hpp"

namespace voussoir::host {
namespace {

constexpr int k0_places = 33;

/// The values of a column; nullptr where the table lacks it.
const io::TableColumn* column_of(const std::vector<io::TableColumn>& table, const std::string& name) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const auto& column) { return column.name == name; });
  return found == table.end() ? nullptr : &*found;
}

/// K0 of all members at the same stresses, equally far apart in the logarithm.
std::vector<io::Bands> reduce_k0(const std::vector<const std::vector<io::TableColumn>*>& tables, const BandRule& rule) {
  std::vector<K0Table> fitted;
  double low = 0, high = HUGE_VAL;
  for (const auto* table : tables) {
    const auto *stress = column_of(*table, "vertical_stress"), *ratio = column_of(*table, "ratio");
    if (stress == nullptr || ratio == nullptr || stress->values.size() < 2 ||
        stress->values.size() != ratio->values.size())
      return {};
    fitted.emplace_back(stress->values, ratio->values);
    low = std::max(low, stress->values.front());
    high = std::min(high, stress->values.back());
  }
  if (!(low > 0) || !(high > low)) return {};
  std::vector<double> stress;
  for (int k = 0; k < k0_places; ++k) stress.push_back(low * std::pow(high / low, k / (k0_places - 1.0)));
  std::vector<std::vector<double>> ratios;
  for (const K0Table& k0 : fitted) {
    ratios.emplace_back();
    for (const double s : stress) ratios.back().push_back(k0.at(s));
  }
  const std::vector<std::vector<double>> stresses(fitted.size(), stress);
  return {bands_of(stresses, rule, "vertical_stress", "Pa", {stress.size()}),
          bands_of(ratios, rule, "ratio", "-", {stress.size()})};
}

/// The columns that all tables have in equal lengths, row by row.
std::vector<io::Bands> reduce_rows(const std::vector<const std::vector<io::TableColumn>*>& tables,
                                   const BandRule& rule) {
  std::vector<io::Bands> found;
  for (const io::TableColumn& column : *tables.front()) {
    std::vector<std::vector<double>> values;
    for (const auto* table : tables) {
      const io::TableColumn* own = column_of(*table, column.name);
      if (own != nullptr && own->values.size() == column.values.size()) values.push_back(own->values);
    }
    if (values.size() == tables.size())
      found.push_back(bands_of(values, rule, column.name, column.unit, {column.values.size()}));
  }
  return found;
}

}  // namespace

std::map<std::string, std::vector<io::Bands>> reduce_tables(std::span<const MemberResults> members,
                                                            const BandRule& rule) {
  std::map<std::string, std::vector<io::Bands>> found;
  for (const auto& [name, own] : members.front().tables) {
    std::vector<const std::vector<io::TableColumn>*> tables;
    for (const MemberResults& member : members) {
      const auto table = member.tables.find(name);
      if (table != member.tables.end()) tables.push_back(&table->second);
    }
    if (tables.size() != members.size()) continue;
    std::vector<io::Bands> columns = name == "k0" ? reduce_k0(tables, rule) : reduce_rows(tables, rule);
    if (!columns.empty()) found[name] = std::move(columns);
  }
  return found;
}

}  // namespace voussoir::host
