// The ground in result files: names of boundaries, regions, and elements that have been dug out.
#include "host/stages/ground_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "fem/linear_elastic.hpp"
#include "fem/mesh_rectangle.hpp"

namespace voussoir::host {
namespace {

std::vector<std::string> names_of(const io::MeshData& data) {
  std::vector<std::string> names;
  for (const auto& [name, nodes] : data.boundaries) names.push_back(name);
  return names;
}

TEST(MeshData, ASceneKeepsTheNamesOfItsBoundaries) {
  fem::Mesh mesh = fem::make_rectangle(1, 2, 1, 2);
  mesh.nodes["door"] = mesh.nodes["base"];
  EXPECT_EQ(names_of(mesh_data(mesh)), (std::vector<std::string>{"top", "base", "left", "right"}));
  const io::MeshData own = mesh_data(mesh, BoundaryNames::of_mesh);
  EXPECT_EQ(names_of(own), (std::vector<std::string>{"axis", "base", "door", "side", "top"}));
  EXPECT_EQ(own.boundaries[2].second.size(), mesh.nodes["base"].size());
}

TEST(MeshData, RegionsStandThereWhereThereAreSeveral) {
  fem::Mesh mesh = fem::make_rectangle(1, 2, 1, 2);
  mesh.region_names = {"ground"};
  mesh.region = {0, 0};
  EXPECT_TRUE(mesh_data(mesh).regions.empty());
  mesh.region_names = {"ground", "wall"};
  mesh.region = {1, 0};
  EXPECT_EQ(mesh_data(mesh).regions, (std::vector<std::int64_t>{1, 0}));
  EXPECT_EQ(mesh_data(mesh).region_names, mesh.region_names);
}

TEST(MeshData, PointsKeepTheirNamesAndNodes) {
  fem::Mesh mesh = fem::make_rectangle(1, 2, 1, 2);
  mesh.points = {{"shoulder", 3}, {"mark", 7}};
  EXPECT_EQ(mesh_data(mesh).points, (std::map<std::string, std::int64_t>{{"mark", 7}, {"shoulder", 3}}));
}

TEST(ResultFields, AreMissingWhereElementsHaveBeenDugOut) {
  fem::Mesh mesh = fem::make_rectangle(1, 2, 1, 2);
  mesh.dug_out = {0, 1};
  fem::LinearElastic material(8, {.initial_stress = {-1e3, -2e3, 0}});
  Ground ground{mesh, material, {}, {}};
  begin_stage(ground);
  int at_points = 0;
  for (const io::Field& field : result_fields(ground, {})) {
    const bool stays = field.location != io::FieldLocation::gauss || field.name == "gauss_point_coordinates";
    at_points += stays ? 0 : 1;
    for (std::size_t k = 0; k < field.values.size(); ++k)
      EXPECT_EQ(std::isnan(field.values[k]), !stays && k >= field.values.size() / 2) << field.name << " " << k;
  }
  EXPECT_EQ(at_points, 6);
}

}  // namespace
}  // namespace voussoir::host
