#pragma once
/// A packing as dump_packings.py writes it.

#include <cstdio>
#include <stdexcept>
#include <string>

#include "tests/benchmark/gpu_step/reference.hpp"

namespace voussoir::gpu_step {

/// Of the mean diameter; the engine's default.
constexpr double skin_share = 0.08;

/// Numbers of grains and contacts (int64), cell, positions, radii, histories (double), keys (uint32).
inline Rve read_packing(const std::string& name) {
  std::FILE* const file = std::fopen(name.c_str(), "rb");
  if (file == nullptr) throw std::runtime_error(name + ": cannot be read");
  const auto read = [&](void* to, std::size_t bytes) {
    if (std::fread(to, 1, bytes, file) != bytes) throw std::runtime_error(name + ": too short");
  };
  std::int64_t size[2];
  read(size, sizeof size);
  const auto n = static_cast<std::size_t>(size[0]), contacts = static_cast<std::size_t>(size[1]);
  Rve rve{.cell = {},
          .skin = 0,
          .position = std::vector<double>(2 * n),
          .radius = std::vector<double>(n),
          .kept = std::vector<std::uint32_t>(contacts),
          .history = std::vector<Two<double>>(contacts)};
  read(&rve.cell, sizeof rve.cell);
  read(rve.position.data(), 2 * n * sizeof(double));
  read(rve.radius.data(), n * sizeof(double));
  read(rve.history.data(), contacts * sizeof(Two<double>));
  read(rve.kept.data(), contacts * sizeof(std::uint32_t));
  std::fclose(file);
  for (const double r : rve.radius) rve.skin += 2.0 * skin_share * r / static_cast<double>(n);
  return rve;
}

}  // namespace voussoir::gpu_step
