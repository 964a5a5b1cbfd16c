#pragma once
/// The parts of a case that describe materials: grains, their packings, linear elasticity. The default of each member
/// is the default of its key.

#include <cstdint>
#include <filesystem>
#include <vector>

namespace voussoir::host {

enum class MaterialKind { grains, linear_elastic };
enum class LossGeometry { updated_lagrangian, fixed_mesh };

/// [[soil.class]] Grains up to a size, which share one material (Table 1). Where the file does not give a key, the
/// value of [soil] holds.
struct GrainClassCase {
  double size_to = 0;  ///< largest diameter of the class [m]
  double modulus = 0, stiffness_ratio = 0, friction_angle = 0, rolling_stiffness = 0, rolling_limit = 0;  ///< as in
                                                                                                          ///< SoilCase
};

/// How the entries of `passing` count grains.
enum class GradingMeasure { number, area };

/// [soil] The grains and their contacts.
struct SoilCase {
  double size_minimum = 2.0e-3;                      ///< [m]
  double size_maximum = 4.75e-3;                     ///< [m]
  std::vector<double> sizes;                         ///< [m]; empty: uniform by number in between
  std::vector<double> passing;                       ///< share of grains below each size [-]
  GradingMeasure passing_by = GradingMeasure::area;  ///< what `passing` counts
  std::vector<GrainClassCase> classes;               ///< empty: all grains are of one class
  double modulus = 3.0e9;                            ///< E [Pa]
  double stiffness_ratio = 0.5;                      ///< k_t / k_n [-]
  double friction_angle = 0.43633231299858238;       ///< [rad], 25 deg
  double rolling_stiffness = 1.0;                    ///< beta [-]
  double rolling_limit = 0.6;                        ///< eta [-]
  double damping = 0.3;                              ///< [-]
  double density = 2650.0;                           ///< [kg/m3]
  double thickness = 0.1;                            ///< t [m]
};

/// [packing] How the RVEs' packings are made.
struct PackingCase {
  int grains = 700;                 ///< of one RVE
  std::int64_t seed = 1;            ///< first seed; the candidates are seed, seed + 1, ...
  std::vector<std::int64_t> seeds;  ///< empty: seed and candidates name them
  int candidates = 1;    ///< number of seeds tried; the `variety` packings with the least |tau_xy|/sigma_yy are taken;
                         ///< without the key, as many as `variety`
  int variety = 1;       ///< number of different packings at the points of a mesh (packing/variety.hpp); without the
                         ///< key, as many as there are files
  bool mirrored = true;  ///< mirrored_batch.hpp
  /// NAME_particles.csv of packings of another code, or one packing_*.h5; empty: packings are made from the recipe.
  /// Files have grains of their own: `grains`, seeds and density are not used then.
  std::vector<std::filesystem::path> files;
  std::filesystem::path folder = "out/packings";  ///< of finished packings
  double consolidation_friction = 0.0;            ///< mu_t [-]
  bool consolidation_rolling = false;             ///< during the consolidation
  double void_ratio = 0.0;  ///< wanted at `pressure` [-]; mu_t is searched for it; 0: consolidation_friction is mu_t
  double pressure = 1.0e3;  ///< isotropic [Pa]

  /// True where the run starts from a stored state of this program.
  [[nodiscard]] bool has_state() const { return !files.empty() && files.front().extension() == ".h5"; }
};

/// [elastic] The verification material.
struct ElasticCase {
  double modulus = 50.0e6;  ///< Young's modulus E [Pa]
  double poisson = 0.3;     ///< Poisson's ratio [-]
};

}  // namespace voussoir::host
