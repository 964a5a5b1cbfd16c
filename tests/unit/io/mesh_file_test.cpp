/// Stored meshes: round trip, and what is refused.

#include "io/mesh_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "io/hdf5.hpp"
#include "tests/throws.hpp"

namespace voussoir::io {
namespace {

namespace fs = std::filesystem;

class MeshFileTest : public testing::Test {
 protected:
  MeshFileTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }

  /// Two squares side by side.
  static StoredMesh example() {
    return {.corners = {0, 0, 1, 0, 2, 0, 0, 1.0 / 3, 1, 1.0 / 3, 2, 1.0 / 3},
            .quads = {0, 1, 4, 3, 1, 2, 5, 4},
            .numbers = {{"width", 2}, {"height", 1.0 / 3}},
            .labels = {{"shape", "half_tunnel"}, {"made_by", "a test"}}};
  }
  void expect_not_saved(const std::function<void(StoredMesh&)>& change, const char* sentence) const {
    StoredMesh mesh = example();
    change(mesh);
    expect_throws<std::invalid_argument>([&] { save_mesh(folder_ / "m.h5", mesh); }, sentence);
    EXPECT_FALSE(fs::exists(folder_ / "m.h5"));
  }
  void expect_not_loaded(const char* sentence) const {
    expect_throws<std::runtime_error>([&] { static_cast<void>(load_mesh(folder_ / "m.h5")); }, sentence);
  }
  /// A file that another program has written, with the arrays given.
  void write_foreign(const std::vector<double>& corners, std::size_t columns, const std::vector<std::int64_t>& quads,
                     std::int64_t version = 1) const {
    Hdf5File file = Hdf5File::create(folder_ / "m.h5");
    file.set_attribute("/", "format", std::string("voussoir mesh"));
    file.set_attribute("/", "format_version", version);
    file.set_attribute("/", "content", std::int64_t{7});
    file.write("/corners", corners, {corners.size() / columns, columns}, "m");
    file.write("/quads", quads, {quads.size() / 4, 4}, "-");
    file.make_group("/numbers");
    file.make_group("/labels");
    file.publish();
  }

  fs::path folder_ = fs::current_path() / "meshes";
};

TEST_F(MeshFileTest, SameBitsBack) {
  const StoredMesh saved = example();
  save_mesh(folder_ / "new" / "m.h5", saved);
  const StoredMesh loaded = load_mesh(folder_ / "new" / "m.h5");
  EXPECT_EQ(loaded.corners, saved.corners);
  EXPECT_EQ(loaded.quads, saved.quads);
  EXPECT_EQ(loaded.numbers, saved.numbers);
  EXPECT_EQ(loaded.labels, saved.labels);
}

TEST_F(MeshFileTest, WhatIsNoMeshIsNotSaved) {
  expect_not_saved([](StoredMesh& m) { m.quads.clear(); }, "m.h5: has no elements");
  expect_not_saved([](StoredMesh& m) { m.quads.pop_back(); }, "its arrays differ in length");
  expect_not_saved([](StoredMesh& m) { m.corners[3] = NAN; }, "node 1 has no place");
  expect_not_saved([](StoredMesh& m) { m.quads[5] = 6; }, "element 1 has the node 6, but there are 6 nodes");
  expect_not_saved([](StoredMesh& m) { m.quads[5] = -1; }, "element 1 has the node -1");
  expect_not_saved([](StoredMesh& m) { m.corners.insert(m.corners.end(), {3, 3}); }, "node 6 belongs to no element");
  expect_not_saved([](StoredMesh& m) { std::swap(m.quads[4], m.quads[6]), std::swap(m.quads[5], m.quads[6]); },
                   "element 1 has no area, or its nodes are clockwise");
  expect_not_saved([](StoredMesh& m) { m.numbers["width"] = INFINITY; }, "the number width is not finite");
}

TEST_F(MeshFileTest, DamagedAndForeignFilesAreErrors) {
  expect_not_loaded("m.h5: cannot open the file");
  std::ofstream(folder_ / "m.h5") << "not HDF5";
  expect_not_loaded("m.h5: cannot open the file");
  save_mesh(folder_ / "m.h5", example());
  fs::resize_file(folder_ / "m.h5", fs::file_size(folder_ / "m.h5") / 2);
  expect_not_loaded("m.h5: cannot open the file");

  const StoredMesh good = example();
  write_foreign(good.corners, 2, good.quads, 2);
  expect_not_loaded("format_version");
  write_foreign(good.corners, 3, good.quads);
  expect_not_loaded("/corners must have 2 columns");
  write_foreign(good.corners, 2, {0, 1, 4, 3});
  expect_not_loaded("node 2 belongs to no element");
  write_foreign(good.corners, 2, good.quads);
  expect_not_loaded("its mesh was changed after this program had written it");
}

}  // namespace
}  // namespace voussoir::io
