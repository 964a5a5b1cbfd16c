// The table of fields against the fields that a run writes, of grains and without any, and against
// docs/reference/files.md.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "host/case/result_fields.hpp"
#include "host/kinds/biaxial_bvp.hpp"
#include "host/stages/make_material.hpp"
#include "tests/format_page.hpp"

namespace voussoir::host {
namespace {

constexpr kernels::MicrostructureRequest everything{.fabric = true, .coordination = true, .strong_networks = true};

Case one_element(MaterialKind material, const std::string& name) {
  Case input;
  input.kind = CaseKind::biaxial_bvp;
  input.material = material;
  input.packing.grains = 60;
  input.packing.folder = "packings";
  input.biaxial_bvp = {.width = 0.05, .height = 0.05, .columns = 1, .rows = 1, .strain = 1e-4, .strain_step = 1e-4};
  input.name = name;
  input.fingerprint = "result_fields_test";
  return input;
}

/// The fields of the run's last file by their names.
std::map<std::string, io::Field> written_by(const Case& input) {
  RunOptions options;
  options.folder = input.name;
  std::filesystem::remove_all(options.folder);
  EXPECT_EQ(run_biaxial_bvp(input, options), RunStatus::finished);
  std::map<std::string, io::Field> fields;
  for (io::Field& field : io::read_fields(io::increment_path(options.folder, 1))) fields[field.name] = field;
  return fields;
}

/// Exactly the fields of the table that `belongs` names are there, each as its row says.
template <class Belongs>
void expect_rows(const std::map<std::string, io::Field>& written, const Belongs& belongs) {
  std::size_t rows = 0;
  for (const ResultField& row : result_field_table) {
    EXPECT_EQ(written.contains(row.name), belongs(row)) << row.name;
    if (!written.contains(row.name)) continue;
    ++rows;
    const io::Field& field = written.at(row.name);
    EXPECT_EQ(field.unit, row.unit) << row.name;
    EXPECT_EQ(field.components, row.components) << row.name;
    EXPECT_EQ(field.location, row.location) << row.name;
  }
  EXPECT_EQ(rows, written.size()) << "a run writes a field that the table lacks";
}

TEST(ResultFields, ARunOfGrainsWritesTheWholeTable) {
  Case input = one_element(MaterialKind::grains, "grains_with_networks");
  input.output.microstructure = everything;
  input.packing.variety = input.packing.candidates = 2;
  input.engine.accuracy = 0.01;
  expect_rows(written_by(input), [](const ResultField&) { return true; });
}

TEST(ResultFields, ARunOfGrainsWritesNoNetworkUnlessAskedFor) {
  const Case input = one_element(MaterialKind::grains, "grains");
  expect_rows(written_by(input),
              [](const ResultField& row) { return row.request == nullptr && !row.of_mix && !row.of_accuracy; });
}

TEST(ResultFields, ARunWithoutGrainsWritesTheMeshesFieldsAlone) {
  const Case input = one_element(MaterialKind::linear_elastic, "elastic");
  expect_rows(written_by(input), [](const ResultField& row) { return !row.of_grains; });
}

TEST(ResultFields, QuantitiesThatNoFileHoldsAreNotComputed) {
  Case input;
  input.output.microstructure = everything;
  input.output.fields = {"stress", "fabric_direction"};
  const kernels::MicrostructureRequest computed = material_case(input).microstructure;
  EXPECT_TRUE(computed.fabric);
  EXPECT_FALSE(computed.coordination || computed.strong_networks);
  input.output.fields = {"stress"};
  EXPECT_FALSE(material_case(input).microstructure.any());
  input.output.fields = {"strong_coordination_2"};
  input.output.microstructure = {.fabric = true};
  EXPECT_FALSE(material_case(input).microstructure.any()) << "it was not asked for";
  input.output.fields = {};
  EXPECT_TRUE(material_case(input).microstructure.fabric) << "no names stand for all fields";
}

TEST(ResultFields, AChoiceOfFieldsChangesNoneOfThem) {
  Case input = one_element(MaterialKind::grains, "all_fields");
  input.output.microstructure = everything;
  const auto all = written_by(input);
  input = one_element(MaterialKind::grains, "some_fields");
  input.output.microstructure = everything;
  input.output.fields = {"grain_rotation", "void_ratio", "fabric_anisotropy"};
  const auto some = written_by(input);
  ASSERT_EQ(some.size(), input.output.fields.size());
  for (const auto& [name, field] : some) EXPECT_EQ(field.values, all.at(name).values) << name;
  input = one_element(MaterialKind::grains, "fields_without_networks");
  const auto plain = written_by(input);
  for (const auto& [name, field] : plain) EXPECT_EQ(field.values, all.at(name).values) << name;
}

/// Such as "gauss, Pa, 1, asked for by fabric".
std::string described(const std::string& where, const std::string& unit, int components, const std::string& request) {
  return where + ", " + unit + ", " + std::to_string(components) +
         (request.empty() ? std::string() : ", asked for by " + request);
}

std::string request_of(const ResultField& row) {
  for (const char* name : {"fabric", "coordination", "strong_networks"}) {
    kernels::MicrostructureRequest request;
    EXPECT_TRUE(ask_for(name, request)) << name;
    if (row.request != nullptr && is_asked_for(row, request)) return name;
  }
  EXPECT_EQ(row.request, nullptr) << row.name;
  return {};
}

TEST(ResultFields, AreThoseOfFormatMd) {
  Descriptions page, program;
  for (const auto& row : rows_below("| name | where | unit | components |")) {
    for (const std::string& name : split(row.at(0), ", ")) {
      page[unquoted(name)] = described(row.at(1), row.at(2), std::stoi(row.at(3)), "");
    }
  }
  for (const auto& row : rows_below("| asked for | name | where | unit | what |")) {
    for (const std::string& name : split(row.at(1), ", ")) {
      page[unquoted(name)] = described(row.at(2), row.at(3), 1, unquoted(row.at(0)));
    }
  }
  for (const ResultField& row : result_field_table) {
    const char* where = row.location == io::FieldLocation::node ? "node" : "gauss";
    program[row.name] = described(where, row.unit, row.components, request_of(row));
  }
  EXPECT_EQ(program.size(), result_field_table.size());
  EXPECT_EQ(disagreements(page, program), "");
}

TEST(ResultFields, NamesAreUniqueAndFound) {
  for (const ResultField& row : result_field_table) EXPECT_EQ(find_result_field(row.name), &row) << row.name;
  EXPECT_EQ(find_result_field("stresses"), nullptr);
}

TEST(ResultFields, EveryRequestAddsFieldsAndOtherNamesNone) {
  for (const char* name : {"fabric", "coordination", "strong_networks"}) {
    kernels::MicrostructureRequest request;
    EXPECT_TRUE(ask_for(name, request)) << name;
    std::size_t fields = 0;
    for (const ResultField& row : result_field_table) {
      if (row.request == nullptr || !is_asked_for(row, request)) continue;
      ++fields;
      EXPECT_NE(row.of_network, nullptr) << row.name;
    }
    EXPECT_GT(fields, 0U) << name;
  }
  kernels::MicrostructureRequest none;
  EXPECT_FALSE(ask_for("stress", none));
  EXPECT_FALSE(none.any());
}

}  // namespace
}  // namespace voussoir::host
