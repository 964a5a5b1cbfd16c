// What an increment tells of itself: its columns against the list of docs/reference/files.md, and a report as a row of
// a file.
#include "host/record/increment_report.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "host/kinds/biaxial_bvp.hpp"
#include "host/kinds/column.hpp"
#include "host/kinds/geostatic_check.hpp"
#include "host/kinds/opening_check.hpp"
#include "host/kinds/tunnel.hpp"
#include "io/increment_file.hpp"
#include "tests/format_page.hpp"

namespace voussoir::host {
namespace {

/// "`a`, `b`" and "m, s", or one unit for all names.
void add(const std::string& names, const std::string& units, Descriptions& to) {
  const std::vector<std::string> name = split(names, ", "), unit = split(units, ", ");
  ASSERT_TRUE(unit.size() == 1 || unit.size() == name.size()) << names;
  for (std::size_t k = 0; k < name.size(); ++k) {
    to[unquoted(name[k])] = unit[unit.size() == 1 ? 0 : k];
  }
}

template <class Report, std::size_t n>
void add(const std::array<Column<Report>, n>& columns, Descriptions& to) {
  for (const Column<Report>& column : columns) {
    EXPECT_FALSE(to.contains(column.name)) << column.name;
    to[column.name] = column.unit;
  }
}

TEST(IncrementColumns, AreThoseOfFormatMd) {
  Descriptions described;
  for (const auto& row : rows_below("| attribute | unit | what |")) {
    if (row.at(1) != "text") add(row.at(0), row.at(1), described);
  }
  Descriptions written;
  io::IncrementInfo info;
  io::for_each_number(info, [&](const char* name, const char* unit, auto) { written[name] = unit; });
  add(increment_columns, written);
  add(equilibrium_columns, written);
  add(tunnel_columns, written);
  add(column_base_columns, written);
  add(specimen_columns, written);
  EXPECT_GT(written.size(), 35U);
  EXPECT_EQ(disagreements(described, written), "");
}

/// docs/reference/files.md tells of the columns of a table in a sentence; each must at least be named there.
template <class Report, std::size_t n>
void expect_named(const std::string& table, const std::array<Column<Report>, n>& columns) {
  for (const auto& row : rows_below("| table | columns |")) {
    if (row.at(0) != std::string("`") + table + "`") continue;
    for (const Column<Report>& column : columns) {
      EXPECT_NE(row.at(1).find(std::string("`") + column.name + "`"), std::string::npos) << table << ' ' << column.name;
    }
    return;
  }
  ADD_FAILURE() << "docs/reference/files.md has no table " << table;
}

TEST(TableColumns, AreNamedInFormatMd) {
  expect_named("geostatic_check", geostatic_columns);
  expect_named("geostatic_rows", geostatic_row_columns);
  expect_named("opening_check", opening_columns);
  expect_named("draw_scatter", draw_scatter_columns);
  expect_named("column_rows", column_row_columns);
}

TEST(IncrementReport, BecomesARow) {
  IncrementReport report;
  report.info.stage = "gravity";
  report.info.evaluations = 7;
  report.info.extra["crown_settlement"] = {0.5, "m"};
  report.volume_loss = 0.02;
  io::IncrementInfo row = row_of(report);
  EXPECT_EQ(row.stage, "gravity");
  EXPECT_EQ(row.evaluations, 7);
  EXPECT_EQ(row.extra.size(), 2U);  // a stage's start has no equilibrium to report
  EXPECT_EQ(row.extra.at("volume_loss").value, 0.02);
  EXPECT_EQ(row.extra.at("crown_settlement").value, 0.5);

  report.equilibrium = EquilibriumReport{.open_points = 3, .slowest_steps = 50, .viscous_work = 0.25};
  row = row_of(report);
  EXPECT_EQ(row.extra.at("open_points").value, 3.0);
  EXPECT_EQ(row.extra.at("slowest_steps").value, 50.0);
  EXPECT_EQ(row.extra.at("viscous_work").value, 0.25);
  EXPECT_EQ(row.extra.at("viscous_work").unit, "J/m");
  EXPECT_FALSE(row.extra.contains("slowest_point"));  // it has no value
  EXPECT_FALSE(row.extra.contains("deferred_points"));
}

TEST(TableOf, HasARowForEachReport) {
  const std::vector<GeostaticRow> rows{{.depth = 1, .k0 = 0.5}, {.depth = 2, .k0 = 0.25}};
  const std::vector<io::TableColumn> table = table_of(rows, geostatic_row_columns);
  ASSERT_EQ(table.size(), geostatic_row_columns.size());
  EXPECT_EQ(table.front().name, "depth");
  EXPECT_EQ(table.front().unit, "m");
  EXPECT_EQ(table.front().values, (std::vector<double>{1, 2}));
  EXPECT_EQ(table[4].values, (std::vector<double>{0.5, 0.25}));
}

}  // namespace
}  // namespace voussoir::host
