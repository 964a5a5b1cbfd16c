/// The process that reads mesh files: each end that it may come to, and damaged files of which Gmsh crashed, or took
/// all memory and hung.

#include "fem/mesh_gmsh_child.hpp"

#include <gtest/gtest.h>
#include <omp.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <new>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>

#include "fem/mesh_file.hpp"
#include "tests/throws.hpp"

namespace voussoir::fem {
namespace {

constexpr ChildLimits usual{.seconds = 60, .bytes = std::size_t{1} << 30U};

class GmshChild : public testing::Test {
 protected:
  /// No process is left, not even a zombie.
  void TearDown() override {
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
  }
};

void expect_refused(const std::function<std::string()>& work, const std::string& sentence, double seconds = 60) {
  expect_throws<std::runtime_error>(
      [&] { static_cast<void>(in_child(work, {.seconds = seconds, .bytes = usual.bytes})); }, sentence);
}

TEST_F(GmshChild, HandsOverWhatItMakes) {
  EXPECT_EQ(in_child([] { return std::string(); }, usual), "");
  std::string large;
  large.resize(10'000'000, 'x');  // far more than a pipe holds
  large[5] = '\0';
  EXPECT_EQ(in_child([&] { return large; }, usual), large);
}

TEST_F(GmshChild, SaysHowItEnded) {
  expect_refused([]() -> std::string { throw std::runtime_error("Could not read nodes"); }, "Could not read nodes");
  for (const int signal : {SIGSEGV, SIGABRT, SIGKILL})
    expect_refused([=] { return std::to_string(std::raise(signal)); },
                   "Gmsh ended by signal " + std::to_string(signal) + " while it read the file");
  expect_refused([]() -> std::string { std::exit(0); }, "Gmsh ended with the status 1 while it read the file");
  expect_refused([]() -> std::string { throw std::bad_alloc(); },
                 "Gmsh needed more than 1024 MB of memory while it read the file");
}

TEST_F(GmshChild, IsEndedAfterItsTime) {
  const auto start = std::chrono::steady_clock::now();
  const auto hangs = []() -> std::string {
    while (true) std::this_thread::sleep_for(std::chrono::seconds(1));
  };
  expect_refused(hangs, "Gmsh did not come to an end within 1 s", 0.6);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST_F(GmshChild, WorksBesideTheThreadsOfARun) {
#ifdef _OPENMP  // the build with sanitizers has no OpenMP
  int threads = 0;
#pragma omp parallel num_threads(3) reduction(+ : threads)
  ++threads;
  EXPECT_EQ(threads, 3);
#endif
  const std::filesystem::path path = std::filesystem::path(VOUSSOIR_SOURCE_DIR) / "tests/meshes/trapdoor_q8.msh";
  EXPECT_EQ(read_mesh_file(path, 1).mesh.n_elements(), 84);
}

/// The text with one to four other bytes.
std::string damaged(std::string text, unsigned seed) {
  std::mt19937 random(seed);
  for (unsigned n = 1 + random() % 4; n > 0; --n) {
    const std::size_t at = random() % text.size();
    const auto value = static_cast<unsigned>(random());
    text[at] = static_cast<char>(value % 2 == 0 ? '0' + (value >> 8U) % 10 : value >> 8U);
  }
  return text;
}

/// Reads a stored file with the damage of each seed, and returns how many of them Gmsh did not bear.
int read_damaged(const std::string& name, std::initializer_list<unsigned> seeds) {
  std::ifstream file(std::filesystem::path(VOUSSOIR_SOURCE_DIR) / "tests/meshes" / name, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::filesystem::path own = "damaged_" + std::to_string(getpid()) + ".msh";
  int not_borne = 0;
  for (const unsigned seed : seeds) {
    SCOPED_TRACE(testing::Message() << name << " with seed " << seed);
    std::ofstream(own, std::ios::binary) << damaged(text, seed);
    try {
      static_cast<void>(read_mesh_file(own, 1, 5));
    } catch (const std::runtime_error& fault) {
      const std::string sentence = fault.what();
      EXPECT_FALSE(sentence.empty());
      not_borne += sentence.find("cannot be read: Gmsh ") == std::string::npos ? 0 : 1;
    }
  }
  std::filesystem::remove(own);
  return not_borne;
}

// How Gmsh ends depends on its version, on the compiler and on where its memory lies; that it does, on none of them.
TEST_F(GmshChild, DamagedFilesEndInASentence) {
  int not_borne = read_damaged("trapdoor_q8_v22.msh", {70, 206, 298, 299});
  not_borne += read_damaged("trapdoor_q8_bin.msh", {3,   4,   22,  49,  53,  68,  115, 138, 147, 148, 178,
                                                    189, 204, 221, 231, 237, 240, 257, 286, 291, 292});
  not_borne += read_damaged("trapdoor_q8.msh", {11, 12, 13, 14, 15});
  std::printf("Gmsh did not bear %d of 30 damaged files\n", not_borne);
}

TEST_F(GmshChild, AnElementWithEndlesslyManyTagsEnds) {
  const std::filesystem::path own = "tags_" + std::to_string(getpid()) + ".msh";
  std::ofstream(own) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n"
                        "1 3 999999999999999 7 1 1 1 1 1\n$EndElements\n";
  expect_throws<std::runtime_error>([&] { static_cast<void>(read_mesh_file(own, 1, 5)); }, "");
  std::filesystem::remove(own);
}

}  // namespace
}  // namespace voussoir::fem
