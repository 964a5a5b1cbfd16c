// main of every GoogleTest program: Kokkos lives from before the first test until after the last.
#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);  // first: it takes its own arguments out, Kokkos reads what is left
  const Kokkos::ScopeGuard kokkos(argc, argv);
  return RUN_ALL_TESTS();
}
