/// Packings: round trip, the cache, and packings of another code.

#include <gtest/gtest.h>

#include <fstream>

#include "io/packing_file.hpp"
#include "tests/throws.hpp"

namespace voussoir::io {
namespace {

namespace fs = std::filesystem;

class PackingFileTest : public testing::Test {
 protected:
  PackingFileTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }

  static Packing example() {
    return {.radius = {0.001, 0.002, 1.0 / 3},
            .x = {0, 0.1, 0.2},
            .y = {-0.1, 0.3, 0.5},
            .rotation = {0, 1, -7},
            .cell = {1, 0.25, 0, 2},
            .thickness = 0.2,
            .contact_i = {0, 1},
            .contact_j = {1, 2},
            .history_names = {"shear", "roll"},
            .history = {1e-9, 2e-9, 3e-9, 4e-9},
            .numbers = {{"void_ratio", 0.184}, {"pressure", 1e3}},
            .labels = {{"soil", "CPS_D"}, {"recipe_fingerprint", "00ff"}}};
  }
  /// Writes the pair of files of another code and loads it; empty text: the file is left out.
  Packing load_pair(const std::string& particles, const std::string& meta) const {
    fs::remove(folder_ / "a_meta.json");
    std::ofstream(folder_ / "a_particles.csv") << particles;
    if (!meta.empty()) std::ofstream(folder_ / "a_meta.json") << meta;
    return load_packing_csv(folder_ / "a_particles.csv");
  }
  [[nodiscard]] std::string message(const std::string& particles, const std::string& meta) const {
    try {
      static_cast<void>(load_pair(particles, meta));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path folder_ = fs::current_path() / "packings";
  std::string particles_ = "id,x_m,y_m,r_m,theta_z_rad\n0,0.01,0.02,0.002,0.5\n1,0.03,4e-2,0.001,-1\n";
  std::string meta_ = R"({"tag": "two", "Lz": 0.3, "E": 3e9, "hSize": [[0.1, 0.01, 0], [0, 0.2, 0], [0, 0, 0.1]]})";
};

TEST_F(PackingFileTest, SameBitsBack) {
  const Packing saved = example();
  save_packing(folder_ / "new" / "p.h5", saved);
  const Packing loaded = load_packing(folder_ / "new" / "p.h5");
  EXPECT_EQ(loaded.radius, saved.radius);
  EXPECT_EQ(loaded.x, saved.x);
  EXPECT_EQ(loaded.y, saved.y);
  EXPECT_EQ(loaded.rotation, saved.rotation);
  EXPECT_EQ(loaded.cell, saved.cell);
  EXPECT_EQ(loaded.thickness, saved.thickness);
  EXPECT_EQ(loaded.contact_i, saved.contact_i);
  EXPECT_EQ(loaded.contact_j, saved.contact_j);
  EXPECT_EQ(loaded.history_names, saved.history_names);
  EXPECT_EQ(loaded.history, saved.history);
  EXPECT_EQ(loaded.numbers, saved.numbers);
  EXPECT_EQ(loaded.labels, saved.labels);
}

TEST_F(PackingFileTest, NoContactsIsAPackingToo) {
  Packing loose = example();
  loose.contact_i = loose.contact_j = {};
  loose.history = {};
  save_packing(folder_ / "p.h5", loose);
  EXPECT_EQ(load_packing(folder_ / "p.h5").contacts(), 0U);
}

TEST_F(PackingFileTest, SizesThatDisagreeAreRefused) {
  Packing packing = example();
  packing.x.pop_back();
  expect_throws<std::invalid_argument>([&] { save_packing(folder_ / "p.h5", packing); },
                                       "p.h5: has 3 radii, but 2 x, 3 y, 3 rotations");
  packing = example();
  packing.history.pop_back();
  expect_throws<std::invalid_argument>([&] { save_packing(folder_ / "p.h5", packing); },
                                       "its contact arrays differ in length");
  packing = example();
  packing.contact_j[0] = 3;
  expect_throws<std::invalid_argument>([&] { save_packing(folder_ / "p.h5", packing); },
                                       "contact 0 joins grains 0 and 3, but there are 3 grains");
  packing = example();
  packing.radius[1] = -1;
  expect_throws<std::invalid_argument>([&] { save_packing(folder_ / "p.h5", packing); },
                                       "grain 1 has a radius that is not positive");
  EXPECT_FALSE(fs::exists(folder_ / "p.h5"));
}

TEST_F(PackingFileTest, CacheFindsOnlyWhatFitsTheRecipe) {
  EXPECT_FALSE(find_packing(folder_, "00ff").has_value());
  save_packing(packing_path(folder_, "00ff"), example());
  EXPECT_TRUE(find_packing(folder_, "00ff").has_value());
  fs::copy_file(packing_path(folder_, "00ff"), packing_path(folder_, "abcd"));
  EXPECT_FALSE(find_packing(folder_, "abcd").has_value());  // its label says another recipe
  fs::resize_file(packing_path(folder_, "00ff"), 1000);
  EXPECT_FALSE(find_packing(folder_, "00ff").has_value());
}

TEST_F(PackingFileTest, DamagedAndForeignFilesAreErrors) {
  expect_throws<std::runtime_error>([&] { static_cast<void>(load_packing(folder_ / "none.h5")); },
                                    "none.h5: cannot open");
  std::ofstream(folder_ / "text.h5") << "not HDF5";
  expect_throws<std::runtime_error>([&] { static_cast<void>(load_packing(folder_ / "text.h5")); },
                                    "text.h5: cannot open");
}

TEST_F(PackingFileTest, PairOfCsvAndJson) {
  const Packing packing = load_pair(particles_, meta_);
  EXPECT_EQ(packing.radius, (std::vector{0.002, 0.001}));
  EXPECT_EQ(packing.x, (std::vector{0.01, 0.03}));
  EXPECT_EQ(packing.y, (std::vector{0.02, 0.04}));
  EXPECT_EQ(packing.rotation, (std::vector{0.5, -1.0}));
  EXPECT_EQ(packing.cell, (std::array{0.1, 0.01, 0.0, 0.2}));
  EXPECT_EQ(packing.thickness, 0.3);
  EXPECT_EQ(packing.numbers.at("E"), 3e9);
  EXPECT_EQ(packing.labels.at("tag"), "two");
  EXPECT_EQ(load_packing_csv(folder_ / "a_meta.json").radius, packing.radius);
}

TEST_F(PackingFileTest, BadPairsSayWhereTheyAreBad) {
  const auto says = [&](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  says(message("id,x,y\n", meta_), "a_particles.csv: line 1: must be");
  says(message(particles_ + "2,0.1,0.2\n", meta_), "line 4: must be five numbers");
  says(message(particles_ + "2,0.1,0.2,nan,0\n", meta_), "line 4: r_m must be a finite number, is \"nan\"");
  says(message(particles_ + "2,0.1,0.2,-0.001,0\n", meta_), "line 4: radius must be positive");
  says(message("id,x_m,y_m,r_m,theta_z_rad\n", meta_), "has no grains");
  says(message(particles_, ""), "a_meta.json: cannot be read");
  says(message(particles_, "{\"Lz\": 0.1}"), "a_meta.json: ");
  says(message(particles_, "{\"Lz\": "), "a_meta.json: ");
  says(message(particles_, R"({"hSize": [[0, 0, 0], [0, 1, 0], [0, 0, 1]]})"), "positive area");
  says(message(particles_, R"({"Lz": 0, "hSize": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]})"), "thickness");
  expect_throws<std::runtime_error>([&] { static_cast<void>(load_packing_csv(folder_ / "a.csv")); },
                                    "must be named NAME_particles.csv");
}

}  // namespace
}  // namespace voussoir::io
