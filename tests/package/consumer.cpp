// A foreign program that uses the installed library: it makes a packing, reads its file, deforms two RVEs and compares
// their answers with what must hold for any material. Arguments: a case file and a folder for packings.
#include <cstdio>
#include <vector>

#include "host/library/rves.hpp"
#include "io/input_error.hpp"
#include "io/packing_file.hpp"

namespace {

int failures = 0;

void check(bool holds, const char* sentence) {
  if (!holds) std::printf("FAILED: %s\n", sentence);
  failures += holds ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const voussoir::library::Session session(1);
  const std::vector<std::string> settings = {std::string("packing.folder=") + argv[2]};

  const auto files = voussoir::library::make_packings(argv[1], settings);
  const voussoir::io::Packing packing = voussoir::io::load_packing(files.at(0));
  std::printf("%zu grains, void ratio %.4f\n", packing.grains(), packing.numbers.at("void_ratio"));
  check(packing.grains() == 100, "the packing has the grains that the case asks for");

  // The first RVE keeps its shape, the second one is compressed by 1e-5 in y.
  const auto rves = voussoir::library::make_rves(argv[1], 2, settings);
  std::vector<voussoir::fem::Gradient> gradients(2, voussoir::fem::Gradient::Zero());
  gradients[1](1, 1) = -1.0e-5;
  std::vector<voussoir::fem::Stress> before(2), after(2);
  std::vector<voussoir::fem::Tangent> tangents(2);
  rves->committed(before, {});
  rves->begin_increment();
  const voussoir::fem::BatchReport report = rves->evaluate(gradients, after, tangents);
  check(report.usable, report.message.c_str());
  for (const auto& stress : after) std::printf("stress [Pa] %.2f %.2f %.2f\n", stress[0], stress[1], stress[2]);

  const double pressure = -0.5 * (before[0][0] + before[0][1]);
  const voussoir::fem::Stress foretold = before[1] + tangents[1] * voussoir::fem::Stress(0, -1.0e-5, 0);
  check(std::abs(pressure / 100.0e3 - 1) < 0.01, "the RVEs begin under the pressure of the case");
  check((after[0] - before[0]).norm() < 1.0e-4 * pressure, "without strain the stress stays");
  check(after[1][1] < before[1][1], "compression makes the stress more compressive");
  check((after[1] - foretold).norm() < 0.3 * (foretold - before[1]).norm(), "the tangent foretells the stress");
  check(tangents[1] == tangents[1].transpose(), "the tangent is symmetric");

  rves->commit();
  rves->committed(before, {});
  check(before[1] == after[1], "the committed stress is that of the last evaluation");
  try {
    static_cast<void>(voussoir::library::make_rves(argv[1], 1, {"packing.grain=5"}));
    check(false, "a wrong key is refused");
  } catch (const voussoir::io::InputError& fault) {
    std::printf("refused: %s\n", fault.what());
  }
  return failures == 0 ? 0 : 1;
}
