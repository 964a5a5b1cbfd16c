#pragma once
/// The data that teams read and write: packings, states and requests in the memory of the space that runs them. Where
/// this is the host's memory, the states are the batch's own.

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <span>
#include <string>

#include "kernels/course/rve_course.hpp"

namespace voussoir::kernels::teams {

template <class T, class Space>
using TeamArray = Kokkos::View<T, Kokkos::LayoutRight, typename Space::memory_space>;

/// The packings of a batch.
template <class real, class Space>
struct TeamPackings {
  TeamArray<RunScales*, Space> scales;
  TeamArray<double**, Space> radii;             ///< (packing, grain) [m]
  TeamArray<GrainShape<real>**, Space> shapes;  ///< (packing, grain)
  TeamArray<GrainMaterial**, Space> materials;  ///< (packing, grain)
};

/// RveStates in the space's memory.
template <class Space>
struct TeamStates {
  TeamArray<double** [2], Space> position;
  TeamArray<double**, Space> rotation;
  TeamArray<double* [4], Space> cell;
  TeamArray<int*, Space> contact_count;
  TeamArray<std::uint32_t**, Space> contact_key;
  TeamArray<double***, Space> contact_history;
};

template <class Law, class Space>
[[nodiscard]] TeamPackings<real_of<typename Law::Value>, Space> team_packings(const RveBatch& batch,
                                                                              const EngineSettings& settings) {
  const std::size_t n = batch.packings.size();
  std::size_t grains = 0;
  for (const Packing& p : batch.packings) grains = std::max(grains, p.radii.size());
  const auto unset = [](const char* label) {
    return Kokkos::view_alloc(Kokkos::WithoutInitializing, std::string(label));
  };
  using Packings = TeamPackings<real_of<typename Law::Value>, Space>;
  const Packings out{.scales = decltype(Packings::scales)(unset("voussoir::team_batch::scales"), n),
                     .radii = decltype(Packings::radii)(unset("voussoir::team_batch::radii"), n, grains),
                     .shapes = decltype(Packings::shapes)(unset("voussoir::team_batch::shapes"), n, grains),
                     .materials = decltype(Packings::materials)(unset("voussoir::team_batch::materials"), n, grains)};
  const auto scales = Kokkos::create_mirror_view(out.scales);
  const auto radii = Kokkos::create_mirror_view(out.radii);
  const auto shapes = Kokkos::create_mirror_view(out.shapes);
  const auto materials = Kokkos::create_mirror_view(out.materials);
  for (std::size_t k = 0; k < n; ++k) {
    const Packing& packing = batch.packings[k];
    scales(k) = scales_of<Law>(packing, settings);
    for (std::size_t i = 0; i < packing.radii.size(); ++i) {
      radii(k, i) = packing.radii[i];
      shapes(k, i) = grain_shape<Law>(packing, i, scales(k).largest_radius, settings.overlap_limit);
      materials(k, i) = packing.material_of(i);
    }
  }
  Kokkos::deep_copy(out.scales, scales);
  Kokkos::deep_copy(out.radii, radii);
  Kokkos::deep_copy(out.shapes, shapes);
  Kokkos::deep_copy(out.materials, materials);
  return out;
}

template <class Space>
[[nodiscard]] TeamStates<Space> team_states(const RveStates& from) {
  const typename Space::memory_space memory;
  return {.position = Kokkos::create_mirror_view_and_copy(memory, from.position),
          .rotation = Kokkos::create_mirror_view_and_copy(memory, from.rotation),
          .cell = Kokkos::create_mirror_view_and_copy(memory, from.cell),
          .contact_count = Kokkos::create_mirror_view_and_copy(memory, from.contact_count),
          .contact_key = Kokkos::create_mirror_view_and_copy(memory, from.contact_key),
          .contact_history = Kokkos::create_mirror_view_and_copy(memory, from.contact_history)};
}

template <class Space>
void copy_back(const TeamStates<Space>& from, RveStates& to) {
  Kokkos::deep_copy(to.position, from.position);
  Kokkos::deep_copy(to.rotation, from.rotation);
  Kokkos::deep_copy(to.cell, from.cell);
  Kokkos::deep_copy(to.contact_count, from.contact_count);
  Kokkos::deep_copy(to.contact_key, from.contact_key);
  Kokkos::deep_copy(to.contact_history, from.contact_history);
}

/// A copy of the values of a span in the space's memory.
template <class Space, class T>
[[nodiscard]] TeamArray<T*, Space> team_array(const char* label, std::span<const T> values) {
  const TeamArray<T*, Space> out(Kokkos::view_alloc(Kokkos::WithoutInitializing, std::string(label)), values.size());
  const auto host = Kokkos::create_mirror_view(out);
  std::copy(values.begin(), values.end(), host.data());
  Kokkos::deep_copy(out, host);
  return out;
}

/// Everything one launch works on.
template <class real, class Drive, class Space>
struct TeamBatch {
  TeamPackings<real, Space> packings;
  TeamStates<Space> committed, trial;
  TeamArray<int*, Space> packing_of;        ///< by RVE
  TeamArray<int*, Space> order;             ///< RVEs, most work first
  TeamArray<Drive*, Space> drives;          ///< by RVE
  TeamArray<RveReport*, Space> reports;     ///< by RVE
  TeamArray<ServoSample**, Space> samples;  ///< (RVE, sample), of stress-controlled cells
  TeamArray<int*, Space> sample_count;      ///< by RVE
  int most_grains = 0;                      ///< of all packings
};

}  // namespace voussoir::kernels::teams
