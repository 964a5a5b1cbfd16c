#pragma once
/// A case is all input of a run as typed, validated values in SI units. The case file (io/case_file.hpp) knows text,
/// keys and units; the reader of a table says what its keys mean. The default of each member is the default of its key.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/case/case_parts.hpp"
#include "host/case/scene.hpp"
#include "kernels/isa/instruction_set.hpp"
#include "kernels/state/network.hpp"
#include "kernels/state/requests.hpp"

namespace voussoir::host {

enum class CaseKind { pack, probe, biaxial, biaxial_bvp, calibrate, column, tunnel, scene };

/// The key `engine.isa`; "auto" is the choice without a value.
using InstructionSetChoice = std::optional<kernels::InstructionSet>;

/// The key `engine.backend`: lanes of the processor, a GPU, or a GPU where there is one.
enum class Backend { automatic, lanes, gpu };

/// [engine] Speed and accuracy of the grain engine: a preset (engine.hpp), whose values single keys override.
/// What each key costs and buys is measured in docs/validation/trade.md. The defaults are the preset `standard`.
struct EngineCase {
  std::string preset = "standard";  ///< fast, standard or reference; only its values are part of the fingerprint
  kernels::Precision precision = kernels::Precision::float32;  ///< value type of the pair loop
  double inertial_number = 3.0e-4;                             ///< [-]
  double hold_tolerance = 1.0e-3;                              ///< [-]
  Backend backend = Backend::automatic;                        ///< where the RVEs of a mesh are advanced
  InstructionSetChoice isa = {};                               ///< of the lanes; no bit of a result depends on it
  int hold_cap = 4000;                                         ///< [steps]
  double skin = 0.1;                                           ///< over the mean diameter [-]
  int minimum_steps = 20;                                      ///< of straining
  int maximum_steps = 2000;                                    ///< of straining
  /// Error of the stress over the pressure that is asked for, from which each RVE gets its inertial number [-]; 0: the
  /// numbers above count.
  double accuracy = 0;
  double defer = 0;  ///< change of stress over pressure up to which an RVE answers by its tangent [-]; 0: never
};

/// [ground] The half domain: symmetry axis at x = 0, base at y = 0.
struct GroundCase {
  double unit_weight = 20.0e3;     ///< gamma [N/m3]
  double surcharge = 1.0e3;        ///< [Pa]
  double width = 35.0;             ///< half width [m]
  double height = 35.0;            ///< [m]
  double diameter = 5.0;           ///< D [m]
  double cover_ratio = 2.0;        ///< C/D [-]
  double mesh_size_opening = 0.6;  ///< [m]
  double mesh_size_far = 4.0;      ///< [m]

  /// A file of `voussoir mesh`, which was made for a ground of these sizes; empty: Gmsh makes the mesh.
  std::filesystem::path mesh_file;

  [[nodiscard]] double cover() const { return cover_ratio * diameter; }                   ///< C [m]
  [[nodiscard]] double axis_height() const { return height - cover() - 0.5 * diameter; }  ///< y of the axis [m]
  [[nodiscard]] double invert_height() const { return axis_height() - 0.5 * diameter; }   ///< y of the invert [m]
  [[nodiscard]] double crown_height() const { return axis_height() + 0.5 * diameter; }    ///< y of the crown [m]
};

/// [column] The oedometric column that measures K0 (sigma_yy).
struct ColumnCase {
  int elements = 20;   ///< elements along the height
  double width = 1.0;  ///< width of its single row of elements [m]
};

/// [gravity] Load increments of the column and of the gravity stage.
struct GravityCase {
  double ratio = 1.5;          ///< [-]
  double uniform_step = 0.05;  ///< of the load factor [-]
};

/// [volume_loss]
struct VolumeLossCase {
  double total = 0.20;  ///< V_l at the end [-]
  int increments = 80;
  LossGeometry geometry = LossGeometry::updated_lagrangian;
};

/// The key `tangent`: the tangent that the engine shall find. "auto" is the choice without a value, for which
/// tangent_kind (engine.hpp) chooses.
using TangentChoice = std::optional<kernels::TangentKind>;

/// [newton] The criteria of convergence (docs/explanation/method.md), and how the solver reaches them.
struct NewtonCase {
  double tolerance = 1.0e-3;               ///< of the residual [-]
  double displacement_tolerance = 1.0e-2;  ///< of the last correction [-]
  int maximum_iterations = 40;
  int anderson_depth = 5;                  ///< 0: plain Newton
  TangentChoice tangent = {};              ///< tangent of the RVEs, computed once an increment
  double tangent_strain = 1.0e-6;          ///< the strain whose secants make a loading tangent [-]
  double initial_tangent_fraction = 0.02;  ///< [-]
  double relax_below = 1.0;                ///< share of a planned step [-]
  int relax_attempts = 3;                  ///< iterates from the committed state
  double relax_near = 0.4;                 ///< residual, relative as `tolerance` [-]
  int relax_substeps = 100;                ///< 0: no increment is relaxed
  double smallest_cut = 1.0 / 64.0;        ///< share of a planned step [-]
};

/// [output]
struct OutputCase {
  int every = 1;             ///< increments of a stage between two result files; the last one of a stage always has one
  int checkpoint_every = 1;  ///< increments of a stage between two checkpoints; the last increment of a stage, and one
                             ///< after which a run stops, always have one
  std::vector<std::string> fields;                ///< names; empty: all
  std::vector<std::int64_t> rves;                 ///< numbers of Gauss points
  kernels::MicrostructureRequest microstructure;  ///< by default none
};

/// [[probe.path]] Increments that are put on the packing before it is probed, as a mesh would put them.
struct PathSegment {
  std::array<double, 4> gradient{};  ///< displacement gradient of each increment, xx xy yx yy [-]; det(1 + gradient) >
                                     ///< 0
  int increments = 1;
  bool constant_xx = false;  ///< sigma_xx is held: the gradient's xx is searched, not given; the rest must not be 0
};

/// [probe] Displacement gradients put on the packing at the path's end, each from the same state.
struct ProbeCase {
  double pressure = 1.0e5;  ///< [Pa]
  double strain = 1.0e-4;   ///< [-]
  int replicas = 1;  ///< copies of path and probes whose gradients differ by 1e-6 of their size; their answers scatter
                     ///< as chaotic motion makes them
  /// The tangent in the report (docs/explanation/tangents.md); a loading one is for `strain`.
  TangentChoice tangent = kernels::TangentKind::contact;
  std::vector<PathSegment> path;
};

/// [biaxial] Drained biaxial tests: y is compressed at a constant rate, sigma_xx is held.
struct BiaxialCase {
  std::vector<double> pressures = {1.0e5, 2.0e5, 4.0e5};  ///< [Pa]
  double strain = 0.20;                                   ///< logarithmic [-]
  double inertial_number = 1.0e-4;                        ///< [-]
  double window = 0.01;                                   ///< of axial strain [-]
  int samples = 1000;                                     ///< points of a curve
};

/// [biaxial_bvp] A biaxial test on a rectangle of elements (biaxial_bvp.hpp).
struct BiaxialBvpCase {
  double pressure = 1.0e5;      ///< [Pa]
  double width = 0.05;          ///< of the specimen [m]
  double height = 0.10;         ///< [m]
  int columns = 2;              ///< elements across
  int rows = 4;                 ///< elements upwards
  double strain = 0.10;         ///< over the height [-]
  double strain_step = 1.0e-3;  ///< over the height [-]

  [[nodiscard]] int increments() const { return static_cast<int>(std::lround(strain / strain_step)); }
};

/// A target of a calibration: the wanted value, and the difference from it that adds 1 to the misfit [rad, or -].
struct CalibrationTarget {
  double value = 0, tolerance = 0;
};

/// [calibrate] Search of the grains' open parameters for the strength that the tests of [biaxial] show.
/// A parameter whose list is empty keeps the value of [soil]; a list of one value fixes the parameter at this value.
/// Classes of grains keep their ratios to [soil].
struct CalibrateCase {
  static constexpr double degree = std::numbers::pi / 180.0;  ///< [rad]
  std::vector<double> rolling_stiffness;                      ///< beta [-]
  std::vector<double> rolling_limit;                          ///< eta [-]
  std::vector<double> thickness;                              ///< t [m]
  int rounds = 2;                                             ///< of refinement
  CalibrationTarget peak{39.1 * degree, 1.0 * degree};        ///< phi_p [rad]
  CalibrationTarget critical{33.0 * degree, 1.0 * degree};    ///< phi_cs [rad]
  CalibrationTarget dilatancy{14.0 * degree, 2.0 * degree};   ///< psi_max [rad]
  double peak_strain_minimum = 0.02;                          ///< [-]
  double peak_strain_maximum = 0.05;
  double peak_strain_tolerance = 0.01;  ///< [-]
  int confirm_grains = 700;             ///< grains of the packings on which the optimum and [soil] as given are tested
  std::vector<std::int64_t> confirm_seeds = {1, 2, 3};
  double confirm_inertial_number = 1.0e-4;  ///< [-]
};

struct Case {
  CaseKind kind = CaseKind::tunnel;
  MaterialKind material = MaterialKind::grains;
  SoilCase soil;
  PackingCase packing;
  EngineCase engine;
  GroundCase ground;
  ColumnCase column;
  GravityCase gravity;
  VolumeLossCase volume_loss;
  NewtonCase newton;
  OutputCase output;
  ElasticCase elastic;
  ProbeCase probe;
  BiaxialCase biaxial;
  BiaxialBvpCase biaxial_bvp;
  CalibrateCase calibrate;
  SceneCase scene;

  std::vector<std::string> remarks;  ///< sentences for `check` and the log: keys that are given and not used, ...
  std::string name;                  ///< title of the run: the key `title`, else the case file's folder or stem
  std::map<std::string, std::string> places;  ///< of all keys, "case.toml:12" or "--set": for later complaints
  std::string resolved;                       ///< TOML of every value after defaults and overrides
  std::string fingerprint;  ///< made of all values that decide the results, in SI to 12 digits: the same values in
                            ///< other units have the same fingerprint
};

/// True for kinds that advance in load increments on a mesh. They have checkpoints and can stop between increments.
[[nodiscard]] constexpr bool runs_on_a_mesh(CaseKind kind) {
  return kind == CaseKind::biaxial_bvp || kind == CaseKind::column || kind == CaseKind::tunnel ||
         kind == CaseKind::scene;
}

/// The names that the key `kind` of a case file accepts.
inline constexpr std::array<std::pair<CaseKind, const char*>, 8> case_kind_names{
    {{CaseKind::pack, "pack"},
     {CaseKind::biaxial, "biaxial"},
     {CaseKind::calibrate, "calibrate"},
     {CaseKind::probe, "probe"},
     {CaseKind::biaxial_bvp, "biaxial_bvp"},
     {CaseKind::column, "column"},
     {CaseKind::tunnel, "tunnel"},
     {CaseKind::scene, "scene"}}};

[[nodiscard]] std::string to_string(CaseKind kind);
[[nodiscard]] std::string to_string(MaterialKind kind);

/// The place of a key. A key that the user did not write stands where its table does, or is said with the title.
[[nodiscard]] std::string place_of(const Case& input, const std::string& key);

}  // namespace voussoir::host
