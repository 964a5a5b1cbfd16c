/// Results: round trip, kills at any moment, resume, and fields that do not fit.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <span>
#include <sstream>

#include "io/atomic_file.hpp"
#include "io/hdf5.hpp"
#include "io/result_file.hpp"
#include "tests/throws.hpp"

namespace voussoir::io {
namespace {

namespace fs = std::filesystem;

class ResultFileTest : public testing::Test {
 protected:
  ResultFileTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }

  /// Two elements side by side.
  static MeshData mesh() {
    return {.coordinates = {0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1, .5, 0, 1.5, 0, 0, .5, 1, .5, 2, .5, .5, 1, 1.5, 1},
            .connectivity = {0, 1, 4, 3, 6, 9, 11, 8, 1, 2, 5, 4, 7, 10, 12, 9},
            .boundaries = {{"top", {3, 11, 4, 12, 5}}, {"base", {0, 6, 1, 7, 2}}},
            .geometry = {{"diameter", 5.0}}};
  }
  static IncrementInfo info(int index) {
    return {.index = index,
            .stage = "gravity",
            .stage_index = index,
            .load_parameter = 0.1 * index,
            .converged = true,
            .iterations = 3,
            .evaluations = 4,
            .residual = 1e-4,
            .particle_steps = 1e9,
            .wall_s = 2.5,
            .extra = {{"crown_settlement", {0.25, "m"}}},
            .residual_history = {1, 0.1, 1e-4}};
  }
  static std::vector<double> counted(std::size_t n) {
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = static_cast<double>(i) / 3;
    return values;
  }
  static std::vector<Field> fields() {
    return {{"displacement", "m", FieldLocation::node, 2, counted(26)},
            {"stress", "Pa", FieldLocation::gauss, 3, counted(24)},
            {"void_ratio", "-", FieldLocation::gauss, 1, counted(8)},
            {"area", "m2", FieldLocation::element, 1, counted(2)},
            {"q_over_p", "-", FieldLocation::rve, 1, counted(5)}};
  }
  [[nodiscard]] std::string xdmf() const {
    std::ostringstream text;
    text << std::ifstream(folder_ / "result.xdmf").rdbuf();
    return text.str();
  }

  fs::path folder_ = fs::current_path() / "result";
  Provenance provenance_{.case_kind = "tunnel",
                         .input = "kind = \"tunnel\"\n",
                         .fingerprint = "ab",
                         .build_compiler = "GNU 12.2.0",
                         .build_type = "Release",
                         .threads = 2,
                         .ranks = 3};
};

/// A run.h5 of the first versions, which did not say what built the program and how many processes ran.
TEST_F(ResultFileTest, ProvenanceOfTheFirstVersionsIsRead) {
  fs::create_directories(folder_);
  Hdf5File file = Hdf5File::create(folder_ / "run.h5");
  file.set_attribute("/", "format", std::string("voussoir run"));
  file.set_attribute("/", "format_version", std::int64_t{1});
  file.write_text("/input", provenance_.input);
  file.make_group("/provenance");
  for (const char* name : {"case_kind", "fingerprint", "version", "git_hash", "kokkos", "command", "date"}) {
    file.set_attribute("/provenance", name, std::string("old ") + name);
  }
  file.set_attribute("/provenance", "threads", std::int64_t{4});
  file.publish();
  const Provenance read = read_provenance(folder_ / "run.h5");
  EXPECT_EQ(read.git_hash, "old git_hash");
  EXPECT_EQ(read.build_compiler, "unknown");
  EXPECT_EQ(read.build_type, "unknown");
  EXPECT_EQ(read.threads, 4);
  EXPECT_EQ(read.ranks, 1);
}

TEST_F(ResultFileTest, RegionsReadBackAndAreACellField) {
  MeshData regions = mesh();
  regions.regions = {1, 0};
  regions.region_names = {"fill", "bank"};
  ResultWriter::create(folder_, provenance_, regions).write(info(1), fields());
  EXPECT_EQ(read_mesh(folder_ / "run.h5").regions, regions.regions);
  EXPECT_EQ(read_mesh(folder_ / "run.h5").region_names, regions.region_names);
  EXPECT_NE(xdmf().find("Name=\"region\" AttributeType=\"Scalar\" Center=\"Cell\""), std::string::npos);
  EXPECT_NE(xdmf().find("run.h5:/mesh/regions"), std::string::npos);
  ResultWriter::create(folder_, provenance_, mesh()).write(info(1), fields());
  EXPECT_FALSE(Hdf5File::open(folder_ / "run.h5").has("/mesh/regions")) << "one region has no field";
  EXPECT_TRUE(read_mesh(folder_ / "run.h5").region_names.empty());
  EXPECT_EQ(xdmf().find("region"), std::string::npos);
}

TEST_F(ResultFileTest, PointsReadBack) {
  MeshData points = mesh();
  points.points = {{"crown", 4}, {"mark of the shoulder", 12}};
  ResultWriter::create(folder_, provenance_, points).write(info(1), fields());
  EXPECT_EQ(read_mesh(folder_ / "run.h5").points, points.points);
  ResultWriter::create(folder_, provenance_, mesh()).write(info(1), fields());
  EXPECT_FALSE(Hdf5File::open(folder_ / "run.h5").has("/mesh/points")) << "a mesh without points has no group of them";
  EXPECT_TRUE(read_mesh(folder_ / "run.h5").points.empty());
}

TEST_F(ResultFileTest, EverythingReadsBack) {
  ResultWriter writer = ResultWriter::create(folder_, provenance_, mesh());
  const RveSnapshot snapshot{.name = "crown",
                             .cell = {1, 2, 3, 4},
                             .thickness = 0.1,
                             .x = {1, 2},
                             .y = {3, 4},
                             .radius = {5, 6},
                             .rotation = {7, 8},
                             .contact_i = {0},
                             .contact_j = {1},
                             .branch = {0.5, 0.6},
                             .force = {-1, -2}};
  writer.write(info(1), fields(), {snapshot});

  EXPECT_EQ(read_provenance(folder_ / "run.h5").input, provenance_.input);
  EXPECT_EQ(read_provenance(folder_ / "run.h5").build_compiler, "GNU 12.2.0");
  EXPECT_EQ(read_provenance(folder_ / "run.h5").build_type, "Release");
  EXPECT_EQ(read_provenance(folder_ / "run.h5").threads, 2);
  EXPECT_EQ(read_provenance(folder_ / "run.h5").ranks, 3);
  EXPECT_EQ(read_mesh(folder_ / "run.h5").coordinates, mesh().coordinates);
  EXPECT_EQ(read_mesh(folder_ / "run.h5").connectivity, mesh().connectivity);
  EXPECT_EQ(read_mesh(folder_ / "run.h5").geometry, mesh().geometry);
  const auto increments = read_increments(folder_ / "run.h5");
  ASSERT_EQ(increments.size(), 1U);
  EXPECT_EQ(increments[0].stage, "gravity");
  EXPECT_TRUE(increments[0].converged);
  EXPECT_EQ(increments[0].wall_s, 2.5);
  ASSERT_TRUE(increments[0].extra.contains("crown_settlement"));
  EXPECT_EQ(increments[0].extra.size(), 1U);
  EXPECT_EQ(increments[0].extra.at("crown_settlement").value, 0.25);
  EXPECT_EQ(increments[0].extra.at("crown_settlement").unit, "m");
  EXPECT_EQ(increments[0].residual_history, info(1).residual_history);

  const auto loaded = read_fields(increment_path(folder_, 1));
  ASSERT_EQ(loaded.size(), fields().size());
  for (const Field& field : fields()) {
    const auto same = std::find_if(loaded.begin(), loaded.end(), [&](const Field& f) { return f.name == field.name; });
    ASSERT_NE(same, loaded.end()) << field.name;
    EXPECT_EQ(same->values, field.values) << field.name;
    EXPECT_EQ(same->unit, field.unit) << field.name;
    EXPECT_EQ(same->components, field.components) << field.name;
    EXPECT_EQ(same->location, field.location) << field.name;
  }
  const auto snapshots = read_snapshots(increment_path(folder_, 1));
  ASSERT_EQ(snapshots.size(), 1U);
  EXPECT_EQ(snapshots[0].radius, snapshot.radius);
  EXPECT_EQ(snapshots[0].force, snapshot.force);
  EXPECT_EQ(snapshots[0].cell, snapshot.cell);
}

TEST_F(ResultFileTest, ShapesTableAndLinksAreAsFormatMdSays) {
  ResultWriter writer = ResultWriter::create(folder_, provenance_, mesh());
  writer.write(info(1), fields());
  writer.write(info(2), fields(), {}, counted(26));
  const Hdf5File run = Hdf5File::open(folder_ / "run.h5");
  EXPECT_EQ(run.read_texts("/table/stage"), (std::vector<std::string>{"gravity", "gravity"}));
  EXPECT_EQ(run.read_integers("/table/index").values, (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(run.read_doubles("/table/crown_settlement").values, (std::vector{0.25, 0.25}));
  EXPECT_EQ(run.text_attribute("/table/wall_s", "unit"), "s");
  EXPECT_EQ(run.text_attribute("/table/crown_settlement", "unit"), "m");
  EXPECT_EQ(run.members("/increments"), (std::vector<std::string>{"0001", "0002"}));
  EXPECT_EQ(run.shape("/increments/0001/gauss/stress"), (std::vector<std::size_t>{2, 4, 3}));  // through the link
  const Hdf5File increment = Hdf5File::open(increment_path(folder_, 2));
  EXPECT_EQ(increment.shape("/gauss/void_ratio"), (std::vector<std::size_t>{2, 4, 1}));
  EXPECT_EQ(increment.shape("/mesh/coordinates"), (std::vector<std::size_t>{13, 2}));
  EXPECT_EQ(increment.shape("/xdmf/node/displacement"), (std::vector<std::size_t>{13, 3}));
  const auto padded = increment.read_doubles("/xdmf/node/displacement").values;
  EXPECT_EQ((std::vector(padded.begin() + 3, padded.begin() + 6)), (std::vector{2 / 3.0, 3 / 3.0, 0.0}));
  EXPECT_DOUBLE_EQ(increment.read_doubles("/xdmf/cell/stress_yy").values[1], (13 + 16 + 19 + 22) / 12.0);
  EXPECT_DOUBLE_EQ(increment.read_doubles("/xdmf/cell/void_ratio").values[0], (0 + 1 + 2 + 3) / 12.0);
}

TEST_F(ResultFileTest, KilledWriterLeavesTheLastIncrementReadable) {
  ResultWriter::create(folder_, provenance_, mesh()).write(info(1), fields());
  // Killed while writing the increment, run.h5 and result.xdmf: only temporary names exist.
  for (const char* name : {"increments/0002.h5.tmp", "run.h5.tmp", "result.xdmf.tmp"}) {
    std::ofstream(folder_ / name) << "half a file";
  }
  EXPECT_EQ(read_increments(folder_ / "run.h5").size(), 1U);
  EXPECT_EQ(read_fields(increment_path(folder_, 1)).size(), fields().size());
  EXPECT_EQ(Hdf5File::open(folder_ / "run.h5").read_integers("/table/index").values.size(), 1U);

  ResultWriter writer = ResultWriter::resume(folder_, provenance_, mesh(), 1);
  EXPECT_FALSE(fs::exists(folder_ / "increments/0002.h5.tmp"));
  EXPECT_FALSE(fs::exists(folder_ / "run.h5.tmp"));
  writer.write(info(2), fields());
  EXPECT_EQ(read_increments(folder_ / "run.h5").size(), 2U);
}

TEST_F(ResultFileTest, TemporaryFilesOfOtherLivingProcessesStay) {
  fs::create_directories(folder_);
  // A dead writer may have had the number of this process, in another container for example.
  const std::string own = fmt::format("packing.h5.{}", getpid());
  std::ofstream(folder_ / (own + ".tmp")) << "half a file of a dead writer";
  AtomicFile first(folder_ / "packing.h5");
  AtomicFile second(folder_ / "packing.h5");
  remove_leftovers(folder_);
  EXPECT_FALSE(fs::exists(folder_ / (own + ".tmp")));
  EXPECT_TRUE(fs::exists(folder_ / (own + "-1.tmp")));
  EXPECT_TRUE(fs::exists(folder_ / (own + "-2.tmp")));
  for (AtomicFile* file : {&first, &second}) {
    file->write(std::as_bytes(std::span("whole", 5)));
    file->publish();
  }
  EXPECT_EQ(fs::file_size(folder_ / "packing.h5"), 5U);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(ResultFileTest, AFileThatIsNotPublishedLeavesTheFormerOneAndNothingElse) {
  fs::create_directories(folder_);
  write_text(folder_ / "k0.csv", "former");
  {
    AtomicFile file(folder_ / "k0.csv");
    file.write(std::vector<std::byte>(1'000'000));  // more than the buffer
  }
  EXPECT_EQ(fs::file_size(folder_ / "k0.csv"), 6U);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
  fs::create_directories(folder_ / "taken");
  expect_throws<std::runtime_error>([&] { write_text(folder_ / "taken", "text"); },
                                    "cannot be written: Is a directory");
  expect_throws<std::runtime_error>([&] { write_text(folder_ / "missing/k0.csv", "text"); },
                                    "k0.csv: cannot be written: No such file or directory");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2);
}

TEST_F(ResultFileTest, ResumeDropsWhatCameAfterTheCheckpoint) {
  {
    ResultWriter writer = ResultWriter::create(folder_, provenance_, mesh());
    for (int index = 1; index <= 3; ++index) writer.write(info(index), fields());
  }
  const std::string straight = xdmf();
  ResultWriter writer = ResultWriter::resume(folder_, provenance_, mesh(), 2);
  EXPECT_EQ(writer.increments().size(), 2U);
  EXPECT_FALSE(fs::exists(increment_path(folder_, 3)));
  EXPECT_EQ(Hdf5File::open(folder_ / "run.h5").members("/increments"), (std::vector<std::string>{"0001", "0002"}));
  writer.write(info(3), fields());
  EXPECT_EQ(xdmf(), straight);
}

TEST_F(ResultFileTest, TablesStayThroughIncrementsAndResume) {
  const std::vector<TableColumn> k0{{"ratio", "-", {1, 0.4, 0.3}}, {"vertical_stress", "Pa", {1e3, 1e4, 1e5}}};
  const auto expect_k0 = [&](const char* when) {
    const Tables tables = read_tables(folder_ / "run.h5");
    ASSERT_TRUE(tables.contains("k0")) << when;
    ASSERT_EQ(tables.at("k0").size(), 2U) << when;
    for (std::size_t c = 0; c < 2; ++c) {
      EXPECT_EQ(tables.at("k0")[c].name, k0[c].name) << when;
      EXPECT_EQ(tables.at("k0")[c].unit, k0[c].unit) << when;
      EXPECT_EQ(tables.at("k0")[c].values, k0[c].values) << when;
    }
  };
  {
    ResultWriter writer = ResultWriter::create(folder_, provenance_, mesh());
    writer.write(info(1), fields());
    writer.set_table("k0", {{"ratio", "-", {0.5}}});
    writer.set_table("k0", k0);  // in place of the first
    expect_k0("once set");
    writer.write(info(2), fields());
    expect_k0("after an increment");
  }
  ResultWriter writer = ResultWriter::resume(folder_, provenance_, mesh(), 1);
  expect_k0("resumed");
  writer.write(info(2), fields());
  expect_k0("after an increment of the resumed run");
  EXPECT_EQ(Hdf5File::open(folder_ / "run.h5").shape("/tables/k0/ratio"), (std::vector<std::size_t>{3}));
  EXPECT_TRUE(read_tables(folder_ / "run.h5").size() == 1);
  static_cast<void>(ResultWriter::create(folder_, provenance_, mesh()));
  EXPECT_TRUE(read_tables(folder_ / "run.h5").empty());
}

TEST_F(ResultFileTest, TablesThatCannotBeReadBackAreRefused) {
  ResultWriter writer = ResultWriter::create(folder_, provenance_, mesh());
  const auto refuses = [&](const std::string& name, const std::vector<TableColumn>& columns) {
    expect_throws<std::invalid_argument>([&] { writer.set_table(name, columns); },
                                         "table \"" + name + "\": its names or the lengths of its columns");
  };
  refuses("a/b", {{"x", "-", {1}}});
  refuses("", {{"x", "-", {1}}});
  refuses("k0", {});
  refuses("k0", {{"", "-", {1}}});
  refuses("k0", {{"x", "-", {1}}, {"y", "-", {1, 2}}});
  EXPECT_TRUE(read_tables(folder_ / "run.h5").empty());
}

TEST_F(ResultFileTest, AnewMeansAnew) {
  ResultWriter::create(folder_, provenance_, mesh()).write(info(1), fields());
  const ResultWriter writer = ResultWriter::create(folder_, provenance_, mesh());
  EXPECT_TRUE(writer.increments().empty());
  EXPECT_TRUE(read_increments(folder_ / "run.h5").empty());
  EXPECT_EQ(xdmf().find("increments/0001.h5"), std::string::npos);
}

TEST_F(ResultFileTest, RunsWithoutAMeshHaveNoXdmf) {
  ResultWriter writer = ResultWriter::create(folder_, provenance_, {});
  writer.write(info(0), {{"q_over_p", "-", FieldLocation::rve, 1, {0.5}}});
  EXPECT_FALSE(fs::exists(folder_ / "result.xdmf"));
  EXPECT_EQ(read_mesh(folder_ / "run.h5").nodes(), 0U);
  EXPECT_EQ(read_fields(increment_path(folder_, 0)).at(0).values, std::vector{0.5});
}

TEST_F(ResultFileTest, WhatDoesNotFitIsRefusedBeforeAnythingIsWritten) {
  ResultWriter writer = ResultWriter::create(folder_, provenance_, mesh());
  const auto refuses = [&](const Field& field, const std::string& part) {
    expect_throws<std::invalid_argument>([&] { writer.write(info(1), {field}); },
                                         "field \"" + field.name + "\" has " + part);
  };
  refuses({"displacement", "m", FieldLocation::node, 2, counted(25)}, "25 values of 2 components, expected 26");
  refuses({"stress", "Pa", FieldLocation::gauss, 3, counted(6)}, "6 values of 3 components, expected 24");
  refuses({"a/b", "m", FieldLocation::element, 1, counted(2)}, "2 values of 1 components");
  refuses({"none", "m", FieldLocation::element, 0, {}}, "0 values of 0 components");
  expect_throws<std::invalid_argument>([&] { writer.write(info(1), {}, {}, counted(3)); },
                                       "1 coordinates for 13 nodes");
  EXPECT_FALSE(fs::exists(increment_path(folder_, 1)));
  writer.write(info(2), {});
  expect_throws<std::invalid_argument>([&] { writer.write(info(2), {}); }, "increment 2 does not follow");
}

TEST_F(ResultFileTest, AFolderThatWasMovedDoesNotComeUpAgain) {
  fs::remove_all(folder_);
  EXPECT_THROW(static_cast<void>(ResultWriter::create(folder_, provenance_, mesh())), std::runtime_error);
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(ResultFileTest, DamagedFilesAreErrors) {
  ResultWriter::create(folder_, provenance_, mesh()).write(info(1), fields());
  fs::resize_file(increment_path(folder_, 1), 600);
  expect_throws<std::runtime_error>([&] { static_cast<void>(read_fields(increment_path(folder_, 1))); },
                                    "0001.h5: cannot");
  expect_throws<std::runtime_error>([&] { static_cast<void>(read_increments(folder_ / "run.h5")); }, "0001.h5: cannot");
  expect_throws<std::runtime_error>([&] { static_cast<void>(read_provenance(folder_ / "none.h5")); },
                                    "none.h5: cannot");
}

}  // namespace
}  // namespace voussoir::io
