// Evaluations in pieces: the bits of an evaluation in one go, pauses in between, and an increment that begins anew
// after a pause has thrown.
#include "host/material/piecewise.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "host/material/rve_pool.hpp"
#include "host/packing/recipe.hpp"
#include "tests/same_bits.hpp"

namespace voussoir::host {
namespace {

constexpr std::size_t n = 100;

/// Points of three packings, as if dealt out by chance.
PackingMix small_mix() {
  const std::vector<std::int64_t> seeds{1, 2, 3};
  PackingCase recipe;
  recipe.grains = 30;
  recipe.pressure = 1e5;
  return mix(make_packings({}, recipe, seeds), n, 1);
}

kernels::RveBatch batch_at(const PackingMix& points) {
  std::vector<kernels::Packing> packings;
  for (const PackedRve& rve : points.packings) packings.push_back(rve.packing);
  kernels::RveBatch batch = kernels::make_batch(std::move(packings), points.of_point);
  for (std::size_t k = 0; k < points.points(); ++k)
    store_rve(points.packings[static_cast<std::size_t>(points.of_point[k])], batch, k);
  return batch;
}

std::vector<kernels::StrainRequest> requests_of() {
  std::vector<kernels::StrainRequest> requests(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double strain = 1e-5 * static_cast<double>(k);
    requests[k] = {.f_rel = {1, strain, 0, 1 - strain}, .strain_steps = 20 + static_cast<int>(k), .hold_cap = 500};
  }
  return requests;
}

TEST(Piecewise, AnswersWithTheBitsOfOneGo) {
  const PackingMix points = small_mix();
  kernels::RveBatch whole = batch_at(points), cut = batch_at(points);
  const auto requests = requests_of();
  std::vector<kernels::RveReport> wanted(n), found(n);
  std::vector<int> some;
  for (int k = 0; k < static_cast<int>(n); k += 1 + k % 2) some.push_back(k);
  const kernels::EngineSettings settings;
  const kernels::Work work = kernels::advance(whole, requests, settings, wanted, some);

  int pauses = 0;
  Piecewise pieces(1e-9);
  pieces.set_pause([&] { ++pauses; });
  const kernels::Work in_pieces = pieces.advance(cut, requests, settings, found, some);
  EXPECT_EQ(pauses, static_cast<int>(some.size() + 15) / 16);
  EXPECT_EQ(in_pieces.particle_steps, work.particle_steps);
  for (std::size_t k = 0; k < n; ++k) {
    EXPECT_TRUE(same_bits(wanted[k].stress, found[k].stress)) << k;
    EXPECT_EQ(wanted[k].steps, found[k].steps) << k;
  }
}

TEST(Piecewise, PiecesThatTakeLongAreWatched) {
  const PackingMix points = small_mix();
  const auto requests = requests_of();
  std::vector<kernels::RveReport> reports(n);
  const std::vector<int> two{0, 50};
  for (const bool is_long : {true, false}) {
    kernels::RveBatch batch = batch_at(points);
    Piecewise pieces(is_long ? 1e-9 : 1e3);
    int watched = 0;
    pieces.set_pause([] {},
                     [&](const std::function<void()>& work) {
                       ++watched;
                       work();
                     });
    EXPECT_GT(pieces.advance(batch, requests, {}, reports, two).particle_steps, 0U);
    EXPECT_EQ(watched, is_long ? 1 : 0);
  }
}

TEST(Piecewise, APauseThatThrowsLeavesTheCommittedState) {
  RvePool pool(small_mix(), {});
  std::vector<fem::Gradient> gradients(n, fem::Gradient::Zero());
  for (fem::Gradient& h : gradients) h(1, 1) = -1e-4;
  std::vector<fem::Stress> wanted(n), found(n);
  const std::vector<std::byte> state = pool.state();
  pool.begin_increment();
  static_cast<void>(pool.evaluate(gradients, wanted, {}));

  pool.set_pause([] { throw std::runtime_error("Ctrl-C"); });
  std::vector<fem::Gradient> larger(n, fem::Gradient::Zero());
  for (fem::Gradient& h : larger) h(1, 1) = -1e-2;
  EXPECT_THROW(static_cast<void>(pool.evaluate(larger, found, {})), std::runtime_error);
  EXPECT_EQ(pool.state(), state);

  int pauses = 0;
  pool.set_pause([&] { ++pauses; });
  static_cast<void>(pool.evaluate(gradients, found, {}));
  EXPECT_GE(pauses, 1);  // slow machines need several pieces
  // With the steps of the larger strain the stresses would be others.
  for (std::size_t k = 0; k < n; ++k) EXPECT_EQ(wanted[k], found[k]) << k;
}

}  // namespace
}  // namespace voussoir::host
