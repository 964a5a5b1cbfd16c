// Several packings at the points of a mesh: who holds which, and that no point notices what the others hold.
#include "host/packing/variety.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "host/material/rve_pool.hpp"
#include "host/packing/packings.hpp"
#include "tests/host_support.hpp"

namespace voussoir::host {
namespace {

std::vector<PackedRve> small_packings(std::vector<std::int64_t> seeds) {
  Case input;
  input.packing.grains = 60;
  input.packing.pressure = 1e5;
  return make_packings(input.soil, input.packing, seeds);
}

TEST(Variety, PackingsHaveEqualSharesToWithinOnePoint) {
  for (const std::size_t n : {1U, 7U, 80U, 983U}) {
    const PackingMix mixed = mix(std::vector<PackedRve>(8), n, 5);
    std::vector<long> share(8);
    for (std::size_t k = 0; k < 8; ++k) {
      share[k] = std::count(mixed.of_point.begin(), mixed.of_point.end(), static_cast<int>(k));
    }
    const auto [least, most] = std::minmax_element(share.begin(), share.end());
    EXPECT_LE(*most - *least, 1) << n;
    EXPECT_EQ(mixed.points(), n);
  }
}

TEST(Variety, TheSeedDecidesTheMixAndHidesNoPatternInIt) {
  const std::size_t n = 4000;
  const std::vector<PackedRve> packings(4);
  EXPECT_EQ(mix(packings, n, 1).of_point, mix(packings, n, 1).of_point);
  EXPECT_NE(mix(packings, n, 1).of_point, mix(packings, n, 2).of_point);
  // A packing's share of the mirrored points (every second) is hypergeometric: 250 +- 11 of 1000 in each quarter of the
  // mesh; bounds of five standard deviations.
  const std::vector<int> of_point = mix(packings, n, 1).of_point;
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    const auto first = of_point.begin() + static_cast<std::ptrdiff_t>(1000 * quarter);
    EXPECT_NEAR(static_cast<double>(std::count(first, first + 1000, 2)), 250.0, 60.0) << quarter;
  }
  long mirrored = 0;
  for (std::size_t p = 1; p < n; p += 2) mirrored += of_point[p] == 2 ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(mirrored), 500.0, 70.0);
}

/// The answer of a point is that of a pool of this point's packing alone, bit for bit, with and without deferral.
TEST(Variety, APointAnswersAsInAPoolOfItsPacking) {
  const std::vector<PackedRve> packings = small_packings({1, 2, 3});
  const PackingMix mixed = mix(packings, 8, 1);
  std::vector<fem::Gradient> gradients(mixed.points(), fem::Gradient::Zero());
  for (std::size_t p = 0; p < gradients.size(); ++p) gradients[p](1, 1) = -1e-4 * static_cast<double>(p + 1);
  for (const double defer : {0.0, 1e-3}) {
    EngineCase engine;
    engine.defer = defer;
    RvePool pool(mixed, {.engine = engine});
    std::vector<fem::Stress> stress(mixed.points());
    std::vector<fem::Tangent> tangent(mixed.points());
    ASSERT_TRUE(pool.evaluate(gradients, stress, tangent).usable);
    for (std::size_t p = 0; p < mixed.points(); ++p) {
      RvePool alone(packings[static_cast<std::size_t>(mixed.of_point[p])], {.engine = engine}, 1);
      std::vector<fem::Stress> own(1);
      std::vector<fem::Tangent> own_tangent(1);
      ASSERT_TRUE(alone.evaluate({&gradients[p], 1}, own, own_tangent).usable);
      EXPECT_EQ(stress[p], own[0]) << p;
      EXPECT_EQ(tangent[p], own_tangent[0]) << p;
    }
  }
}

TEST(Variety, AMixedPoolSaysWhichPackingAPointHoldsAndGoesThroughBytes) {
  const PackingMix mixed = mix(small_packings({1, 2, 3}), 8, 1);
  RvePool pool(mixed, {}), again(mixed, {});
  const std::vector<fem::PointField> fields = pool.fields();
  const auto field = std::find_if(fields.begin(), fields.end(),
                                  [](const fem::PointField& f) { return f.name == "packing"; });
  ASSERT_NE(field, fields.end());
  EXPECT_EQ(field->values, std::vector<double>(mixed.of_point.begin(), mixed.of_point.end()));
  std::vector<fem::Gradient> gradients(mixed.points(), fem::Gradient::Zero());
  for (fem::Gradient& h : gradients) h(0, 1) = 1e-4;
  std::vector<fem::Stress> stress(mixed.points());
  ASSERT_TRUE(pool.evaluate(gradients, stress, {}).usable);
  pool.commit();
  again.set_state(pool.state());
  EXPECT_EQ(again.state(), pool.state());
  RvePool clones(mixed.packings.front(), {}, mixed.points());
  EXPECT_THROW(clones.set_state(pool.state()), std::runtime_error);
}

TEST(Variety, TheLeastBiasedCandidatesAreMixed) {
  Case input;
  input.packing.grains = 60;
  input.packing.folder = "variety_packings";
  std::filesystem::remove_all(input.packing.folder);
  input.packing.candidates = 4;
  input.packing.variety = 2;
  const PackingMix mixed = choose_packings(input.soil, input.packing, 6);
  ASSERT_EQ(mixed.packings.size(), 2U);
  EXPECT_LE(mixed.packings[0].bias, mixed.packings[1].bias);
  std::vector<PackedRve> all = obtain_packings(input.soil, input.packing, seeds_of(input.packing));
  std::erase_if(all, [&](const PackedRve& rve) { return rve.bias <= mixed.packings[1].bias; });
  EXPECT_EQ(all.size(), 2U);
  input.packing.variety = 1;
  EXPECT_EQ(choose_packings(input.soil, input.packing, 6).packings.front().seed, mixed.packings[0].seed);
  input.packing.variety = 5;  // fewer packings than the case asks for must not pass silently
  EXPECT_THROW(static_cast<void>(choose_packings(input.soil, input.packing, 6)), std::runtime_error);
}

}  // namespace
}  // namespace voussoir::host
