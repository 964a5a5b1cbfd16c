// The material of a mesh with regions: grains of several soils and elastic ground answer as each alone, at the mesh's
// own points.
#include "host/material/region_batch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "fem/linear_elastic.hpp"
#include "fem/mesh_rectangle.hpp"
#include "host/material/mirrored_batch.hpp"
#include "host/material/rve_pool.hpp"
#include "host/stages/make_material.hpp"
#include "tests/host_support.hpp"

namespace voussoir::host {
namespace {

using Points = std::vector<std::size_t>;

struct Answers {
  std::vector<fem::Stress> stress;
  std::vector<fem::Tangent> tangent;
  fem::BatchReport report;
};

fem::Gradient gradient_of(std::size_t point) {
  fem::Gradient h = fem::Gradient::Zero();
  h(1, 1) = -1e-5 * static_cast<double>(point + 1);
  h(0, 1) = 4e-6;
  return h;
}

/// An increment that is committed: point k of the batch gets the gradient of points[k].
Answers increment(fem::MaterialBatch& batch, const Points& points) {
  Answers out{std::vector<fem::Stress>(points.size()), std::vector<fem::Tangent>(points.size()), {}};
  std::vector<fem::Gradient> gradients;
  for (const std::size_t p : points) gradients.push_back(gradient_of(p));
  batch.begin_increment();
  out.report = batch.evaluate(gradients, out.stress, out.tangent);
  EXPECT_TRUE(out.report.usable) << out.report.message;
  batch.commit();
  return out;
}

Points first(std::size_t n) {
  Points out(n);
  std::iota(out.begin(), out.end(), std::size_t{0});
  return out;
}

void expect_same(const Answers& whole, const Answers& part, const Points& points) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_EQ(whole.stress[points[k]], part.stress[k]) << points[k];
    EXPECT_EQ(whole.tangent[points[k]], part.tangent[k]) << points[k];
  }
}

constexpr std::size_t n = 16;
const Points of_grains{4, 5, 6, 7, 12, 13, 14, 15}, of_elastic{0, 1, 2, 3, 8, 9, 10, 11};

std::unique_ptr<fem::MaterialBatch> grains() {
  return std::make_unique<MirroredBatch>(std::make_unique<RvePool>(small_packing(), PoolOptions{}, 8));
}

std::unique_ptr<fem::MaterialBatch> elastic() {
  return std::make_unique<fem::LinearElastic>(8, fem::ElasticOptions{.initial_stress = {-1e5, -1e5, 0}});
}

RegionBatch batch_of_both() {
  std::vector<RegionPart> parts;
  parts.push_back({grains(), of_grains});
  parts.push_back({elastic(), of_elastic});
  return RegionBatch(std::move(parts));
}

TEST(RegionBatch, EachPointAnswersAsInItsOwnBatch) {
  RegionBatch both = batch_of_both();
  const auto pool = grains(), ground = elastic();
  const Answers all = increment(both, first(n)), some = increment(*pool, of_grains),
                others = increment(*ground, of_elastic);
  expect_same(all, some, of_grains);
  expect_same(all, others, of_elastic);
  EXPECT_EQ(all.report.work, some.report.work);
  EXPECT_EQ(all.report.slowest, of_grains[some.report.slowest]);
  EXPECT_DOUBLE_EQ(all.report.stress_noise, some.report.stress_noise * std::sqrt(8.0 / 16.0));
  EXPECT_EQ(all.report.mean_overlap, some.report.mean_overlap);
  std::vector<fem::Stress> stress(n);
  both.committed(stress, {});
  EXPECT_EQ(stress, all.stress);
}

TEST(RegionBatch, FieldsAreMissingWhereARegionHasNone) {
  RegionBatch both = batch_of_both();
  const auto pool = grains();
  const std::vector<fem::PointField> all = both.fields(), own = pool->fields();
  ASSERT_EQ(all.size(), own.size());
  for (std::size_t f = 0; f < own.size(); ++f) {
    EXPECT_EQ(all[f].name, own[f].name);
    for (std::size_t k = 0; k < of_grains.size(); ++k)
      EXPECT_EQ(all[f].values[of_grains[k]], own[f].values[k]) << own[f].name;
    for (const std::size_t p : of_elastic) EXPECT_TRUE(std::isnan(all[f].values[p])) << own[f].name;
  }
}

TEST(RegionBatch, AStateGoesThroughBytesAndIsHeld) {
  RegionBatch one = batch_of_both(), other = batch_of_both();
  increment(one, first(n));
  const auto held = one.hold();
  std::vector<std::byte> bytes;
  held->write([&](std::span<const std::byte> piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); });
  EXPECT_EQ(bytes, one.state());
  EXPECT_EQ(bytes.size(), held->size());
  const Answers again = increment(one, first(n));
  EXPECT_NE(one.state(), bytes);
  one.return_to(*held);
  EXPECT_EQ(increment(one, first(n)).stress, again.stress);
  other.set_state(bytes);
  EXPECT_EQ(increment(other, first(n)).stress, again.stress);
  bytes.push_back({});
  EXPECT_THROW(other.set_state(bytes), std::runtime_error);
}

TEST(RegionBatch, DugOutPointsOfAnyRegionAnswerZero) {
  RegionBatch whole = batch_of_both(), rest = batch_of_both();
  const Points dug{2, 5, 8, 9};
  const auto pool = grains();
  const std::size_t dug_of_pool = 1;  // point 5
  pool->retire({&dug_of_pool, 1});
  rest.retire(dug);
  const Answers all = increment(whole, first(n)), some = increment(rest, first(n));
  for (std::size_t p = 0; p < n; ++p) {
    const bool is_dug = std::count(dug.begin(), dug.end(), p) > 0;
    EXPECT_EQ(some.stress[p], is_dug ? fem::Stress::Zero() : all.stress[p]) << p;
  }
  const fem::BatchReport alone = increment(*pool, of_grains).report;
  EXPECT_EQ(some.report.work, alone.work);
  EXPECT_LT(alone.work, all.report.work);
  EXPECT_DOUBLE_EQ(some.report.stress_noise, alone.stress_noise * std::sqrt(7.0 / 12.0));
}

TEST(RegionBatch, SnapshotsAreNamedByTheMeshAndOnlyOfGrains) {
  const RegionBatch both = batch_of_both();
  const std::vector<std::int64_t> asked{2, 13};
  const auto snapshots = both.snapshots(asked);
  ASSERT_EQ(snapshots.size(), 1U);
  EXPECT_EQ(snapshots[0].name, point_name(13));
}

TEST(RegionBatch, RefusesPointsThatMakeNoMesh) {
  std::vector<RegionPart> parts;
  parts.push_back({grains(), of_grains});
  parts.push_back({elastic(), {0, 1, 2, 3, 4, 8, 9, 10}});
  EXPECT_THROW(RegionBatch(std::move(parts)), std::invalid_argument);
}

/// The messages of a pool name the mesh's points.
TEST(RegionBatch, AFailureIsToldByItsPointOfTheMesh) {
  PackingMix mix = clones_of(small_packing(), 2);
  mix.numbers = {40, 41};
  RvePool pool(mix, {});
  std::vector<fem::Gradient> gradients(2, fem::Gradient::Zero());
  gradients[1](0, 0) = -0.5;
  std::vector<fem::Stress> stress(2);
  const fem::BatchReport report = pool.evaluate(gradients, stress, {});
  EXPECT_FALSE(report.usable);
  EXPECT_EQ(report.message.rfind("RVE 41: ", 0), 0U) << report.message;
}

/// A mesh of three elements above one another: fill, wall, bank.
fem::Mesh layered_mesh() {
  fem::Mesh mesh = fem::make_rectangle(1, 3, 1, 3);
  mesh.region_names = {"fill", "wall", "bank"};
  mesh.region = {0, 1, 2};
  return mesh;
}

RegionCase region_of(const std::string& name, int grains, const char* folder) {
  RegionCase region;
  region.names = {name};
  region.packing.grains = grains;
  region.packing.pressure = 1e5;
  region.packing.folder = folder;
  return region;
}

MaterialCase layered_case() {
  MaterialCase material;
  material.packing.pressure = 1e5;
  material.elastic.modulus = 2e7;
  const char* folder = "region_packings";
  material.regions = {region_of("bank", 60, folder), region_of("fill", 60, folder), region_of("wall", 60, folder)};
  material.regions[2].elastic = ElasticCase{.modulus = 3e9, .poisson = 0.2};
  return material;
}

std::vector<double> packings_of(const fem::MaterialBatch& batch) {
  for (const fem::PointField& field : batch.fields())
    if (field.name == "packing") return field.values;
  return {};
}

TEST(Regions, EachIsMadeOfItsOwnSoil) {
  MaterialCase material = layered_case();
  material.regions[0].soil.friction_angle = 0.3;
  const auto batch = make_material(material, layered_mesh());
  ASSERT_EQ(batch->size(), 12U);
  std::vector<double> packing = packings_of(*batch);
  ASSERT_EQ(packing.size(), 12U);
  for (std::size_t p = 0; p < 4; ++p) {
    EXPECT_NE(packing[p], packing[8 + p]);
    EXPECT_TRUE(std::isnan(packing[4 + p]));
  }
  std::vector<fem::Stress> stress(12);
  std::vector<fem::Tangent> tangent(12);
  batch->committed(stress, tangent);
  EXPECT_EQ(tangent[5], fem::plane_strain_stiffness(3e9, 0.2));
  EXPECT_EQ(stress[5], fem::Stress(-1e5, -1e5, 0));
  EXPECT_NEAR(stress[0][1], -1e5, 5e3);
}

TEST(Regions, EqualRecipesShareTheirPackings) {
  const auto batch = make_material(layered_case(), layered_mesh());
  EXPECT_TRUE(packings_of(*batch).empty()) << "one packing has no field";
  MaterialCase material = layered_case();
  for (RegionCase& region : material.regions) {
    region.packing.candidates = 2;
    region.packing.variety = 2;
  }
  const std::vector<double> packing = packings_of(*make_material(material, layered_mesh()));
  std::multiset<double> fill(packing.begin(), packing.begin() + 4), bank(packing.begin() + 8, packing.end());
  EXPECT_EQ(fill, (std::multiset<double>{0, 0, 1, 1}));
  EXPECT_EQ(bank, (std::multiset<double>{0, 0, 1, 1}));
}

TEST(Regions, SeveralNamesAreAsManyTables) {
  MaterialCase tables = layered_case();
  for (RegionCase& region : tables.regions) {
    region.packing.candidates = 2;
    region.packing.variety = 2;
  }
  MaterialCase list = tables;
  list.regions.erase(list.regions.begin() + 1);
  list.regions[0].names = {"bank", "fill"};
  const fem::Mesh mesh = layered_mesh();
  const auto one = make_material(list, mesh), two = make_material(tables, mesh);
  EXPECT_EQ(one->state(), two->state());
  const std::vector<double> packings = packings_of(*one), others = packings_of(*two);
  ASSERT_EQ(packings.size(), 12U);
  for (std::size_t p = 0; p < 12; ++p) {
    if (!std::isnan(packings[p])) {
      EXPECT_EQ(packings[p], others[p]) << p;
    }
  }
}

TEST(Regions, OneRegionWithGrainsIsTheMaterialOfAMeshWithout) {
  MaterialCase material = layered_case();
  material.regions = {region_of("ground", 60, "region_packings")};
  fem::Mesh mesh = layered_mesh();
  mesh.region_names = {"ground"};
  mesh.region = {0, 0, 0};
  const auto with = make_material(material, mesh);
  material.soil = material.regions[0].soil;
  material.packing = material.regions[0].packing;
  material.regions.clear();
  const auto without = make_material(material, fem::make_rectangle(1, 3, 1, 3));
  EXPECT_EQ(dynamic_cast<const RegionBatch*>(with.get()), nullptr);
  EXPECT_EQ(with->state(), without->state());
  expect_same(increment(*with, first(12)), increment(*without, first(12)), first(12));
}

TEST(Regions, ARehearsalIsElasticEverywhere) {
  MaterialCase material = layered_case();
  material.kind = MaterialKind::linear_elastic;
  const auto batch = make_material(material, layered_mesh());
  std::vector<fem::Stress> stress(12);
  std::vector<fem::Tangent> tangent(12);
  batch->committed(stress, tangent);
  EXPECT_EQ(tangent[0], fem::plane_strain_stiffness(2e7, 0.3));
  EXPECT_EQ(tangent[4], fem::plane_strain_stiffness(3e9, 0.2));
  EXPECT_EQ(tangent[11], fem::plane_strain_stiffness(2e7, 0.3));
}

TEST(Regions, ARegionWithoutACaseIsRefused) {
  MaterialCase material = layered_case();
  material.regions.pop_back();
  EXPECT_THROW(static_cast<void>(make_material(material, layered_mesh())), std::invalid_argument);
}

}  // namespace
}  // namespace voussoir::host
