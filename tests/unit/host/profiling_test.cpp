// What a profiler sees of a run: the parts of the mesh's work as regions, by their names.
#include "host/stages/profiling.hpp"

#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <filesystem>
#include <set>
#include <string>

#include "host/kinds/column.hpp"

namespace voussoir::host {
namespace {

std::set<std::string> seen;
int open_regions = 0;

TEST(Profiling, SeesThePartsOfARun) {
  Case input;
  input.kind = CaseKind::column;
  input.material = MaterialKind::linear_elastic;
  input.column.elements = 4;
  input.fingerprint = "host_profiling_test";
  const std::filesystem::path folder = "profiled_column";
  std::filesystem::remove_all(folder);

  Kokkos::Tools::Experimental::set_push_region_callback([](const char* name) {
    seen.insert(name);
    ++open_regions;
  });
  Kokkos::Tools::Experimental::set_pop_region_callback([] { --open_regions; });
  const RunStatus status = run_column(input, {.folder = folder, .command = "test"});
  Kokkos::Tools::Experimental::set_push_region_callback(nullptr);
  Kokkos::Tools::Experimental::set_pop_region_callback(nullptr);

  EXPECT_EQ(status, RunStatus::finished);
  EXPECT_EQ(seen, (std::set<std::string>{"material", "assembly", "solution", "output"}));
  EXPECT_EQ(open_regions, 0);
}

}  // namespace
}  // namespace voussoir::host
