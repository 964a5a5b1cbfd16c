// K0 (sigma_yy): exact on smooth samples, monotone on rough ones, 1 at the initial stress.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "host/scene/k0_table.hpp"

namespace voussoir::host {
namespace {

constexpr double initial = 1.0e3;

/// Oedometric compression of a linear elastic ground with Poisson's ratio 0.3 from an isotropic stress.
double elastic_k0(double vertical) {
  const double k = 0.3 / 0.7;
  return (initial + k * (vertical - initial)) / vertical;
}

std::vector<K0Sample> elastic_samples(double noise) {
  std::mt19937 random(7);
  std::normal_distribution<double> error(0.0, noise);
  std::vector<K0Sample> samples;
  for (double s = initial; s < 7e5; s *= 1.01)
    samples.push_back({s, elastic_k0(s) + (noise > 0 ? error(random) : 0.0)});
  return samples;
}

TEST(K0Table, FollowsSmoothSamples) {
  const K0Table table = K0Table::fit(elastic_samples(0), initial);
  for (double s = initial; s < 6.5e5; s *= 1.07) EXPECT_NEAR(table.at(s), elastic_k0(s), 2e-3) << s;
}

TEST(K0Table, NeverRises) {
  const K0Table table = K0Table::fit(elastic_samples(0.05), initial);
  double before = 1.0;
  for (double s = initial; s < 1e6; s *= 1.003) {
    const double k0 = table.at(s);
    EXPECT_LE(k0, before + 1e-15) << s;
    EXPECT_NEAR(k0, elastic_k0(s), 0.05) << s;
    before = k0;
  }
}

TEST(K0Table, IsOneAtTheInitialStressAndConstantOutside) {
  const K0Table table = K0Table::fit(elastic_samples(0.02), initial);
  EXPECT_EQ(table.at(initial), 1.0);
  EXPECT_EQ(table.at(0.1 * initial), 1.0);
  EXPECT_EQ(table.at(1e7), table.ratio().back());
  EXPECT_EQ(K0Table().at(5e4), 1.0);
}

TEST(K0Table, IgnoresWhatIsNoSample) {
  std::vector<K0Sample> samples = elastic_samples(0);
  samples.push_back({-5e3, 0.1});
  samples.push_back({5e3, std::nan("")});
  const K0Table table = K0Table::fit(samples, initial);
  EXPECT_NEAR(table.at(5e3), elastic_k0(5e3), 2e-3);
}

TEST(K0Table, IsTheSameFromItsKnots) {
  const K0Table table = K0Table::fit(elastic_samples(0.05), initial);
  const K0Table copy(table.stress(), table.ratio());
  for (double s = initial; s < 7e5; s *= 1.3) EXPECT_EQ(table.at(s), copy.at(s));
}

}  // namespace
}  // namespace voussoir::host
