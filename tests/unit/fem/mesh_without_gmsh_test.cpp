/// A program without Gmsh. The linker takes what this file includes, and not the generator and the reader in the
/// library.
#include "fem/mesh_without_gmsh.cpp"  // NOLINT(bugprone-suspicious-include): it is what is tested

#include <gtest/gtest.h>

#include <filesystem>

#include "fem/mesh_file.hpp"
#include "fem/mesh_grid.hpp"
#include "fem/mesh_tunnel.hpp"
#include "tests/throws.hpp"

namespace voussoir::fem {
namespace {

TEST(MeshWithoutGmsh, SaysSoWhereGmshIsNeeded) {
  const std::filesystem::path file = std::filesystem::path(VOUSSOIR_SOURCE_DIR) / "tests/meshes/trapdoor_q8.msh";
  expect_throws<std::runtime_error>(
      [&] { static_cast<void>(read_mesh_file(file, 1)); },
      "trapdoor_q8.msh cannot be read: this program was built without Gmsh, which reads mesh files");
  expect_throws<std::runtime_error>([] { static_cast<void>(make_tunnel({})); },
                                    "this program was built without Gmsh, which generates meshes");
}

TEST(MeshWithoutGmsh, MakesGridAndRing) {
  EXPECT_EQ(make_grid({.x = {{0, 1}, {3}}, .y = {{0, 1}, {2}}}).n_elements(), 6);
  EXPECT_EQ(make_ring({.columns = 4, .rows = 2}).n_elements(), 8);
}

}  // namespace
}  // namespace voussoir::fem
