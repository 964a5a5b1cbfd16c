#pragma once
/// The requests that a caller makes of the engine, and the cost of an answer.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "kernels/contact/kinematics.hpp"
#include "kernels/state/network.hpp"

namespace voussoir::kernels {

enum class Precision { float32, float64 };

/// `contact`: the contact tangent of eq. (4). `elastic`, `static_`: the packing's own stiffness with its grains free to
/// move (tangents/static_tangent.hpp), with every contact stuck or without the springs that have yielded. `loading`:
/// the response to a small strain that goes on as the last motion did, while contacts reach their caps
/// (tangents/loading_tangent.hpp).
enum class TangentKind { contact, elastic, static_, loading };

/// Numerical settings of a run. The case file's [engine] table sets them for a mesh; packings are made with the
/// defaults.
struct EngineSettings {
  Precision precision = Precision::float32;
  double skin = 0.08;             ///< list skin / mean diameter [-]
  double hold_tolerance = 1e-3;   ///< unbalanced ratio that ends a hold [-]
  double pressure_floor = 100.0;  ///< ratios use max(p, floor) [Pa]
  /// Overlap / (r_i + r_j) of a single contact at which an RVE is given up [-]: at 1 the contact has no normal. Whether
  /// stresses count as those of grains is judged at far smaller overlaps (host/packing/law_range.hpp).
  double overlap_limit = 0.95;
  int look_interval = 16;    ///< steps between looks at stress and unbalanced force
  int list_interval = 8;     ///< steps between looks at displacements
  int guard_interval = 256;  ///< steps between looks at overlaps while straining
  TangentKind tangent = TangentKind::contact;
  double tangent_tolerance = 2e-3;  ///< error of the grains' motion under which a static tangent's iterations end, in
                                    ///< the norm of the energy; the tangent's own error is its square [-]
  int tangent_iterations = 800;     ///< most iterations of a static tangent
  double tangent_strain = 1e-6;     ///< strain over which a loading tangent is the secant; negative: against the last
                                    ///< motion [-]
};

/// The motion that is given to one RVE: it reaches F_rel in `strain_steps` equal steps, then rests for at most
/// `hold_cap` steps.
struct StrainRequest {
  Mat2 f_rel = identity2;
  int strain_steps = 0;
  int hold_cap = 0;
};

/// One axis of a stress-controlled cell.
struct ServoAxis {
  bool stress_controlled = true;
  double target = 0;  ///< stress, tension positive [Pa], or rate per step [-] when not stress controlled
};

/// State of a stress-controlled cell at one step.
struct ServoSample {
  int step;
  double strain_x, strain_y;               ///< logarithmic since the request's start, extension positive [-]
  double stress_xx, stress_yy, stress_xy;  ///< tension positive [Pa]
  double unbalanced;                       ///< [-]
  Microstructure microstructure = {};      ///< as far as the request asks for it; rotation since the request's start
};

/// Rectangular cell whose axes follow a stress (PI control) or a rate.
struct ServoRequest {
  ServoAxis x, y;
  double max_rate = 1e-5;          ///< largest |strain| per step [-]
  double stress_tolerance = 1e-3;  ///< |sigma - target| / max(|target|, floor) that counts as reached [-]
  int max_steps = 100000;          ///< the request then ends as step_limit
  int settle_steps = 200;          ///< steps that stress and unbalanced ratio must stay within tolerance
  double end_strain_y = std::numeric_limits<double>::infinity();  ///< |strain_y| at which the request is done [-]
  std::vector<ServoSample>* trace = nullptr;  ///< owned by the caller, one per RVE; samples are appended
  int trace_interval = 100;                   ///< steps between samples
  MicrostructureRequest microstructure = {};  ///< of the samples; nothing is computed unless asked for
};

/// Steps that a request is expected to take: RVEs of similar work advance together.
[[nodiscard]] inline int predicted_steps(const StrainRequest& r, int last) { return std::max(r.strain_steps, last); }
[[nodiscard]] inline int predicted_steps(const ServoRequest& r, int) { return r.max_steps; }

/// The work of one call of the engine.
struct Work {
  std::size_t particle_steps = 0;  ///< executed steps x grains, of the RVEs that ran
  std::size_t lane_steps = 0;  ///< as particle_steps, with the lanes that were empty or had ended: the hardware's work
  double tangent_seconds = 0;  ///< time of static and loading tangents, summed over the workers [s]
  std::size_t workers = 0;     ///< threads that shared these tangents

  /// The work of two calls that ran at the same time, on workers of their own.
  Work& operator+=(const Work& other) {
    particle_steps += other.particle_steps;
    lane_steps += other.lane_steps;
    tangent_seconds += other.tangent_seconds;
    workers += other.workers;
    return *this;
  }
  /// Time of the tangents as a part of the call's wall time: the mean over the workers [s].
  [[nodiscard]] double tangent_time() const {
    return workers > 0 ? tangent_seconds / static_cast<double>(workers) : 0.0;
  }
};

}  // namespace voussoir::kernels
