/// A made-up tunnel result through the writer, read back by VTK's XDMF reader and drawn by tools/figures.py.
/// Skipped with a message where .prefix/venv (tools/setup) or VTK is missing.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numbers>

#include "io/result_file.hpp"

namespace voussoir::io {
namespace {

namespace fs = std::filesystem;

constexpr double size = 35;        // of the half domain [m]
constexpr double diameter = 5;     // [m]
constexpr double axis_y = 22.5;    // C/D = 2
constexpr double weight = 20e3;    // [N/m3]
constexpr double surcharge = 1e3;  // [Pa]

/// Point at `around` (0 to 3, one per straight side, from the base's axis of symmetry to the top's) and `across` (0 at
/// the opening, 1 at the outer boundary).
std::array<double, 2> ring_point(double around, double across) {
  const int side = std::min(static_cast<int>(around), 2);
  const double t = around - side;
  const double x = side == 0 ? size * t : side == 1 ? size : size * (1 - t);
  const double y = side == 0 ? 0 : side == 1 ? size * t : size;
  const double angle = std::atan2(y - axis_y, x);
  const double s = across * across;  // finer at the opening
  return {(1 - s) * diameter / 2 * std::cos(angle) + s * x,
          (1 - s) * (axis_y + diameter / 2 * std::sin(angle)) + s * y};
}

/// Q8 mesh of the half domain around the opening.
MeshData ring_mesh(int elements_around, int elements_across) {
  MeshData mesh{.geometry = {{"diameter", diameter},
                             {"axis_depth", size - axis_y},
                             {"surface_y", size},
                             {"unit_weight", weight},
                             {"surcharge", surcharge}}};
  std::map<std::pair<int, int>, std::int64_t> number;
  std::map<std::string, std::vector<std::int64_t>> boundaries;
  for (int j = 0; j <= 2 * elements_around; ++j) {
    for (int i = 0; i <= 2 * elements_across; ++i) {
      if (i % 2 == 1 && j % 2 == 1) continue;
      const auto node = static_cast<std::int64_t>(mesh.nodes());
      number[{i, j}] = node;
      const auto [x, y] = ring_point(1.5 * j / elements_around, 0.5 * i / elements_across);
      mesh.coordinates.insert(mesh.coordinates.end(), {x, y});
      if (i == 0) boundaries["tunnel"].push_back(node);
      if (y > size - 1e-9) boundaries["top"].push_back(node);
      if (y < 1e-9) boundaries["base"].push_back(node);
      if (x < 1e-9) boundaries["left"].push_back(node);
      if (x > size - 1e-9) boundaries["right"].push_back(node);
    }
  }
  for (int j = 0; j < elements_around; ++j) {
    for (int i = 0; i < elements_across; ++i) {
      const auto at = [&](int di, int dj) { return number.at({2 * i + di, 2 * j + dj}); };
      mesh.connectivity.insert(mesh.connectivity.end(),
                               {at(0, 0), at(2, 0), at(2, 2), at(0, 2), at(1, 0), at(2, 1), at(1, 2), at(0, 1)});
    }
  }
  mesh.boundaries.assign(boundaries.begin(), boundaries.end());
  return mesh;
}

/// A Gauss trough whose width grows from the axis upwards; the ground below the invert hardly moves.
std::array<double, 2> displacement(double x, double y, double volume_loss) {
  const double depth = size - y;
  const double above = size - axis_y - depth;  // height above the axis [m]
  const double width = 0.35 * std::max(above, 0.0) + diameter / 2;
  const double lost = volume_loss * std::numbers::pi * diameter * diameter / 8;
  const double fade = above > 0 ? 1 : std::exp(above / 2);
  const double settlement = fade * lost / (width * std::sqrt(2 * std::numbers::pi)) * 2 *
                            std::exp(-x * x / (2 * width * width));
  return {-settlement * x / (std::abs(above) + diameter), -settlement};
}

struct Point {
  double x = 0, y = 0;
};

/// Gauss points, precise enough for pictures: bilinear in the corners.
std::vector<Point> gauss_points(const MeshData& mesh) {
  std::vector<Point> points;
  const double g = 1 / std::sqrt(3.0);
  constexpr std::array<std::array<double, 2>, 4> corners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t e = 0; e < mesh.elements(); ++e) {
    for (const auto& at : corners) {
      Point point;
      for (std::size_t c = 0; c < 4; ++c) {
        const double share = (1 + g * at[0] * corners[c][0]) * (1 + g * at[1] * corners[c][1]) / 4;
        const auto node = static_cast<std::size_t>(mesh.connectivity[8 * e + c]);
        point.x += share * mesh.coordinates[2 * node];
        point.y += share * mesh.coordinates[2 * node + 1];
      }
      points.push_back(point);
    }
  }
  return points;
}

std::vector<Field> fields(const MeshData& mesh, double volume_loss) {
  Field moved{"displacement", "m", FieldLocation::node, 2, {}};
  for (std::size_t n = 0; n < mesh.nodes(); ++n) {
    const auto u = displacement(mesh.coordinates[2 * n], mesh.coordinates[2 * n + 1], volume_loss);
    moved.values.insert(moved.values.end(), u.begin(), u.end());
  }
  Field stress{"stress", "Pa", FieldLocation::gauss, 3, {}};
  Field shear{"deviatoric_strain", "-", FieldLocation::gauss, 1, {}};
  Field voids{"void_ratio", "-", FieldLocation::gauss, 1, {}};
  Field rotation{"grain_rotation", "rad", FieldLocation::gauss, 1, {}};
  for (const Point& p : gauss_points(mesh)) {
    const double near = std::exp(-std::pow((std::hypot(p.x, p.y - axis_y) - diameter / 2) / 3, 2));
    const double vertical = (weight * (size - p.y) + surcharge) * (1 - near * (0.02 + 2 * volume_loss));
    const double ratio = 0.3 + 0.7 / (1 + vertical / 1e4);
    stress.values.insert(stress.values.end(), {-ratio * vertical, -vertical, 0.0});
    shear.values.push_back(volume_loss * near);
    voids.values.push_back(0.18 + 0.2 * volume_loss * near);
    rotation.values.push_back(volume_loss * near * std::sin(2 * std::atan2(p.y - axis_y, p.x)));
  }
  return {moved, stress, shear, voids, rotation};
}

/// Gravity in 6 increments, the state at rest that the loss starts from, then a volume loss of 20 % in 8.
void write_result(const fs::path& folder) {
  const MeshData mesh = ring_mesh(18, 6);
  fs::create_directories(folder);
  ResultWriter writer = ResultWriter::create(folder, {.case_kind = "tunnel"}, mesh);
  for (int k = 1; k <= 15; ++k) {
    const bool gravity = k <= 6;
    const double loss = gravity ? 0 : 0.025 * (k - 7);
    IncrementInfo info{.index = k, .stage = gravity ? "gravity" : "volume_loss", .stage_index = gravity ? k : k - 7};
    info.load_parameter = gravity ? k / 6.0 : loss;
    info.extra["volume_loss"] = {loss, "-"};
    info.converged = true;
    info.iterations = 3 + k % 4;
    info.evaluations = info.iterations + (k == 9 ? 6 : 1);
    info.residual = 2e-4 * (1 + k % 3);
    info.wall_s = 2.0 + k;
    writer.write(info, fields(mesh, loss));
  }
}

class Tools : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(python_)) GTEST_SKIP() << python_ << " is missing: run tools/setup";
    fs::remove_all(folder_);
    write_result(folder_);
  }
  /// Exit status of a tool applied to the result.
  [[nodiscard]] int run(const std::string& tool) const {
    const std::string log = (folder_ / "log.txt").string();
    const std::string command = python_.string() + " " + (root_ / "tools" / tool).string() + " " + folder_.string() +
                                " >" + log + " 2>&1";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string log() const {
    std::ifstream file(folder_ / "log.txt");
    return {std::istreambuf_iterator<char>(file), {}};
  }

  [[nodiscard]] int skipped() const {
    const std::string text = log();
    int count = 0;
    for (std::size_t at = text.find("skipped "); at != std::string::npos; at = text.find("skipped ", at + 1)) ++count;
    return count;
  }

  fs::path root_ = VOUSSOIR_SOURCE_DIR;
  fs::path python_ = root_ / ".prefix/venv/bin/python";
  fs::path folder_ = fs::current_path() / "io_tools";
};

TEST_F(Tools, VtkReadsEveryTimeAndField) {
  const int status = run("xdmf_check.py");
  if (status == 77) GTEST_SKIP() << log();
  EXPECT_EQ(status, 0) << log();
  EXPECT_NE(log().find("15 times, all fields agree"), std::string::npos) << log();
  EXPECT_NE(log().find("node displacement"), std::string::npos) << log();
  EXPECT_NE(log().find("cell stress_yy"), std::string::npos) << log();
}

TEST_F(Tools, FiguresAreDrawn) {
  EXPECT_EQ(run("figures.py"), 0) << log();
  EXPECT_EQ(skipped(), 4) << log();  // what only grains have: paths, networks and chains of RVEs, K0
  for (const char* name : {"settlement_troughs", "displacement", "deviatoric_strain", "void_ratio", "grain_rotation",
                           "ground_reaction", "geostatic_stress", "convergence"}) {
    EXPECT_GT(fs::file_size(folder_ / (std::string(name) + ".png")), 10000U) << name;
  }
}

}  // namespace
}  // namespace voussoir::io
