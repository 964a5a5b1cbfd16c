#pragma once
/// Columns of tables, made from reports. A report is a struct with named members; a table of columns beside it states
/// the name, the unit and the member of each column, once. Writers, tests and readers of names all use that table.

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

#include "io/result_data.hpp"

namespace voussoir::host {

/// A member of a report that can be a column. An optional member without a value leaves its column out.
template <class Report>
using Member = std::variant<double Report::*, int Report::*, std::size_t Report::*, std::optional<double> Report::*,
                            std::optional<int> Report::*, std::optional<std::size_t> Report::*>;

template <class Report>
struct Column {
  const char* name;
  const char* unit;
  Member<Report> member;
};

/// The column's number in a report; nothing where the member has no value.
template <class Report>
[[nodiscard]] std::optional<double> value_in(const Report& report, const Column<Report>& column) {
  return std::visit(
      [&](auto member) -> std::optional<double> {
        const auto& value = report.*member;
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
          return static_cast<double>(value);
        } else {
          return value ? std::optional(static_cast<double>(*value)) : std::nullopt;
        }
      },
      column.member);
}

/// Adds the columns of one report to those of an increment.
template <class Report, std::size_t n>
void add_columns(const Report& report, const std::array<Column<Report>, n>& columns, io::Quantities& to) {
  for (const Column<Report>& column : columns) {
    if (const std::optional<double> value = value_in(report, column)) to[column.name] = {*value, column.unit};
  }
}

/// A table with one row for each report; a member without a value is not a number there.
template <class Report, std::size_t n>
[[nodiscard]] std::vector<io::TableColumn> table_of(std::span<const std::type_identity_t<Report>> rows,
                                                    const std::array<Column<Report>, n>& columns) {
  std::vector<io::TableColumn> table;
  for (const Column<Report>& column : columns) {
    io::TableColumn& made = table.emplace_back(io::TableColumn{column.name, column.unit, {}});
    for (const Report& row : rows) {
      made.values.push_back(value_in(row, column).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
  }
  return table;
}

}  // namespace voussoir::host
