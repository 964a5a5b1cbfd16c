#pragma once
/// The contact network of an RVE: fabric and connectivity (eqs. 22 and 23). Each quantity is computed only where it was
/// asked for.

#include <array>
#include <span>
#include <vector>

namespace voussoir::kernels {

/// The numbers of a contact that the network needs.
struct NetworkContact {
  int i, j;                   ///< grains
  double normal_x, normal_y;  ///< unit vector along the branch; its sign does not matter
  double normal_force;        ///< f_n >= 0 [N]
};

/// Strong networks: contacts with f_n >= xi <f_n>.
inline constexpr std::array<double, 3> strong_thresholds{1.0, 2.0, 2.5};

struct MicrostructureRequest {
  bool fabric = false;
  bool coordination = false;
  bool strong_networks = false;

  [[nodiscard]] bool any() const { return fabric || coordination || strong_networks; }
};

/// Quantities that were not asked for are 0.
struct Microstructure {
  double grain_rotation = 0;           ///< mean over the grains, counter-clockwise [rad]
  double coordination = 0;             ///< 2 N_c / N_p [-]
  double fabric_anisotropy = 0;        ///< a of eq. (22) [-]; 0 without contacts
  double fabric_direction = 0;         ///< theta_a of eq. (22), from x counter-clockwise, in (-pi/2, pi/2] [rad]
  double mechanical_coordination = 0;  ///< Z_m of eq. (23) [-]; 0 where no grain has two contacts
  std::array<double, strong_thresholds.size()> strong_coordination{};  ///< Z_m of the strong networks
};

/// Writes to `out` the coordination, and those quantities of `wanted` that follow from the contacts, of a packing of
/// `grains` grains.
void describe_network(std::span<const NetworkContact> contacts, int grains, const MicrostructureRequest& wanted,
                      Microstructure& out);

}  // namespace voussoir::kernels
