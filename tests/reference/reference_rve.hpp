#pragma once
/// The oracle: one periodic packing, computed the plain way. Serial, double, every pair looked at in every step,
/// positions advanced directly, real square roots. The equations are those of docs/explanation/contact_law.md and
/// engine.md; no line of kernels/ is used. Tension positive, Voigt order (xx, yy, xy) with engineering shear strain;
/// velocities and spins are per step (dt = 1).

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "tests/reference/plane.hpp"

namespace voussoir::reference {

/// One class of grains and the thickness of the packing.
struct Material {
  double modulus = 3.0e9;          ///< contact modulus E [Pa]
  double stiffness_ratio = 0.5;    ///< k_t/k_n [-]
  double friction = 0.466307658;   ///< tan(friction angle) [-]
  double rolling_stiffness = 1.0;  ///< beta [-]
  double rolling_limit = 0.6;      ///< eta [-]
  double damping = 0.3;            ///< lambda, Cundall's local damping [-]
  double thickness = 0.1;          ///< out of plane [m]
  double step_safety = 0.9;        ///< c of the mobilities [-]
};

struct History {
  double tangential = 0;  ///< f_t [N]
  double moment = 0;      ///< m [N m]
};

/// Keyed by (i, j), i < j.
using Histories = std::map<std::pair<int, int>, History>;

/// State of a packing. Brace-initialise what is known; `velocities` and `spins` may be left empty (at rest).
struct Rve {
  std::vector<Vec2> positions;    ///< centres, wrapped or not [m]
  std::vector<double> radii;      ///< [m]
  std::vector<double> rotations;  ///< absolute, the sum of W + theta; may be left empty (zero) [rad]
  Mat2 cell;                      ///< columns are the periodic vectors [m]
  Material material;
  Histories histories;
  std::vector<Vec2> velocities;  ///< w, relative to the affine field [m per step]
  std::vector<double> spins;     ///< theta, relative to the affine field [rad per step]
};

struct Contact {
  int i, j;
  Vec2 normal;                                    ///< from i to j
  double distance;                                ///< |b|, length of the branch [m]
  double overlap;                                 ///< > 0 [m]
  double normal_stiffness, tangential_stiffness;  ///< k_n, k_t [N/m]
  double normal_force, tangential_force, moment;  ///< f_n, f_t, m as they act on i [N, N, N m]
};

using Voigt = std::array<double, 3>;
using VoigtMatrix = std::array<std::array<double, 3>, 3>;

/// k_n [N/m], k_t [N/m], k_r [N m/rad] of a pair.
struct PairStiffness {
  double normal, tangential, rolling;
};
PairStiffness pair_stiffness(const Material& material, double radius_i, double radius_j);

/// a = dt^2/m [m/N] and a_r = dt^2/I [rad/(N m)] of a grain: mass scaling, docs/explanation/engine.md.
struct Mobility {
  double translation, rotation;
};
/// A small grain that rolls on the packing's largest one is the stiffest rotation.
Mobility mobility(const Material& material, double radius, double largest_radius);

/// Contacts at the current positions with the law called once with zero motion (as at the end of an evaluation); the
/// state is not changed. Ordered by (i, j).
std::vector<Contact> contacts(const Rve& rve);

/// Love-Weber stress, eq. (3), before symmetrisation [Pa].
Mat2 love_weber(const Rve& rve, const std::vector<Contact>& contacts);
/// The same, symmetrised, Voigt [Pa].
Voigt stress(const Rve& rve);
/// Contact tangent, eq. (4), minor symmetries imposed, no spin terms [Pa].
VoigtMatrix tangent(const Rve& rve);
/// p = -tr(sigma)/2 [Pa].
double pressure(const Voigt& stress);
/// 2 N_c / N, grains without a contact counted.
double coordination_number(const Rve& rve);
double mean_rotation(const Rve& rve);
/// Kinetic energy of the motion relative to the affine field plus the elastic energy of the three springs [J].
double energy(const Rve& rve);

/// What one step saw: its forces belong to the positions and velocities before the grains were accelerated.
struct StepTrace {
  Voigt stress;             ///< [Pa]
  double unbalanced_ratio;  ///< rms|f| / (max(p, 0.1 kPa) t d_mean)
  int contact_count;
};

/// One time step. Cell and grains move by E = exp(rate) - I and by the velocities, the law acts with D = sym(rate),
/// grains are accelerated, and their velocities turned for the coming motion, W = skew(next_rate). Rates are velocity
/// gradients per step.
/// @throws std::invalid_argument when sizes do not match or a grain could touch two images of another
StepTrace step(Rve& rve, const Mat2& rate, const Mat2& next_rate);

/// How an evaluation runs: n strain steps with exp(n rate) = F, then at most `hold_steps` steps of rest, left when the
/// unbalanced ratio, looked at in every `look_every`-th of them, is below `tolerance` (0: never).
struct StrainOptions {
  int steps = 1000;
  int hold_steps = 0;
  double tolerance = 0;
  int look_every = 16;
  bool keep_trace = false;
};

struct StrainReport {
  int steps = 0;  ///< strain and hold together
  bool met_tolerance = false;
  double unbalanced_ratio = 0;   ///< of the last step
  std::vector<StepTrace> trace;  ///< one per step, empty unless asked for
};

/// Deforms the packing by `f` and holds it, then commits: last positions reached, law called once with zero motion,
/// histories of open contacts dropped, velocities zeroed.
StrainReport strain(Rve& rve, const Mat2& f, const StrainOptions& options);

/// The end of an evaluation alone, see `strain`.
void commit(Rve& rve);

}  // namespace voussoir::reference
