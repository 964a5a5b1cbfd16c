#pragma once
/// Names for profilers: any tool that Kokkos loads (KOKKOS_TOOLS_LIBS) shows the parts of a run as regions.

namespace voussoir::host {

/// From now on the parts of fem's increments (fem/part_times.hpp) are regions of Kokkos' profiling interface. They cost
/// nothing measurable while no tool is loaded.
void show_parts_to_profilers();

}  // namespace voussoir::host
