// Parts of an increment: each is timed, and told to the listener by its name.
#include "fem/part_times.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "fem/linear_elastic.hpp"
#include "fem/mesh_rectangle.hpp"
#include "fem/newton.hpp"
#include "tests/constrain.hpp"

namespace voussoir::fem {
namespace {

std::vector<std::string> begun;
int open_parts = 0;

/// Listens as long as it lives.
struct Listening {
  Listening() {
    begun.clear();
    open_parts = 0;
    part_listener = {.begin =
                         [](const char* name) {
                           begun.emplace_back(name);
                           ++open_parts;
                         },
                     .end = [] { --open_parts; }};
  }
  ~Listening() { part_listener = {}; }
};

TEST(PartTimes, EachPartHasItsOwn) {
  PartTimes times;
  {
    const PartTimer timer(times, Part::assembly);
  }
  EXPECT_GT(times.assembly, 0.0);
  EXPECT_EQ(times.material, 0.0);
  EXPECT_EQ(times.solve, 0.0);
  times.of(Part::material) = 2;
  times.of(Part::solution) = 3;
  times.tangents = 0.5;
  PartTimes sum = times;
  sum += times;
  EXPECT_EQ(sum.material, 4.0);
  EXPECT_EQ(sum.tangents, 1.0);
  EXPECT_EQ(sum.solve, 6.0);
}

TEST(PartTimes, TheListenerHearsTheNamesOfAnIncrement) {
  const Mesh mesh = make_rectangle(1, 1, 2, 2);
  LinearElastic material(static_cast<std::size_t>(mesh.n_points()), {});
  NewtonSolver solver(mesh, material, Kinematics::fixed_mesh, {});
  const MeshState state = begin_stage(mesh, mesh.coordinates, material);
  IncrementLoad load{.external_force = Eigen::VectorXd::Zero(mesh.n_dofs()), .prescribed = {}};
  constrain(load.prescribed, mesh.node_set("base"), 0, 0.0);
  constrain(load.prescribed, mesh.node_set("base"), 1, 0.0);
  constrain(load.prescribed, mesh.node_set("top"), 1, -1e-3);
  Increment increment;
  const Listening listening;
  const NewtonReport report = solver.solve_increment(state, load, increment);
  EXPECT_EQ(report.status, NewtonStatus::converged);
  EXPECT_EQ(std::set<std::string>(begun.begin(), begun.end()),
            (std::set<std::string>{"material", "assembly", "solution"}));
  EXPECT_EQ(open_parts, 0);
  EXPECT_GT(report.times.material, 0.0);
  EXPECT_GT(report.times.assembly, 0.0);
  EXPECT_GT(report.times.solve, 0.0);
}

}  // namespace
}  // namespace voussoir::fem
