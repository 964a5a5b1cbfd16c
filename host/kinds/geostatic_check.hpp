#pragma once
/// Comparison of the ground after gravity with the state at rest.

#include <array>
#include <string>
#include <vector>

#include "host/case/case.hpp"
#include "host/record/columns.hpp"
#include "host/stages/ground.hpp"

namespace voussoir::host {

/// A level band of the ground after gravity. Means are taken over its points, weighted by their volume.
struct GeostaticRow {
  double depth = 0;       ///< depth of the band's middle [m]
  double vertical = 0;    ///< vertical stress, compression positive, corrected to this depth by the unit weight [Pa]
  double error = 0;       ///< mean of vertical stress - (unit weight * depth + surcharge) [Pa]
  double scatter = 0;     ///< standard deviation of the same difference [Pa]
  double k0 = 0;          ///< horizontal over vertical stress [-]
  double deflection = 0;  ///< angle of the principal axis from the vertical, without sign [rad]
};

/// How near the ground after gravity is to the state at rest. Gauss points within D/2 of the opening do not count.
/// Where several packings are mixed, neighbours of unequal stiffness share the load unequally, so that single points
/// are off by more than the bounds below, which hold for one packing; the bound on the means of rows holds in any case.
struct GeostaticCheck {
  double vertical_error = 0;  ///< largest |sigma_yy - (unit weight * depth + surcharge)| [Pa]
  double vertical_ratio = 0;  ///< the same error over (5 % of the expected stress + 1 kPa) [-]; at most 1 with one
                              ///< packing
  double row_ratio = 0;    ///< largest |error| of a row over (2 % of the expected stress + 0.5 kPa) [-]; it should be
                           ///< at most 1
  double row_scatter = 0;  ///< largest scatter of a row over its vertical stress [-]
  double k0_minimum = 1;   ///< least horizontal over vertical stress [-]
  double k0_maximum = 0;   ///< largest horizontal over vertical stress [-]
  double deflection_mean = 0;      ///< angle of the principal axis from the vertical, mean [rad]
  double deflection_max = 0;       ///< the largest angle [rad]
  double deflection_deep = 0;      ///< largest angle from a vertical stress of 100 kPa on [rad]; at most 1 deg with one
                                   ///< packing
  std::vector<GeostaticRow> rows;  ///< from the surface down; rows without points are left out
};
[[nodiscard]] GeostaticCheck check_geostatic(const Ground& ground, const GroundCase& soil);

/// The check in one sentence for the log.
[[nodiscard]] std::string describe(const GeostaticCheck& check);

/// Table `geostatic_check` of docs/reference/files.md.
inline constexpr auto geostatic_columns = std::to_array<Column<GeostaticCheck>>({
    {"vertical_error", "Pa", &GeostaticCheck::vertical_error},
    {"vertical_ratio", "-", &GeostaticCheck::vertical_ratio},
    {"row_ratio", "-", &GeostaticCheck::row_ratio},
    {"row_scatter", "-", &GeostaticCheck::row_scatter},
    {"k0_minimum", "-", &GeostaticCheck::k0_minimum},
    {"k0_maximum", "-", &GeostaticCheck::k0_maximum},
    {"deflection_mean", "rad", &GeostaticCheck::deflection_mean},
    {"deflection_max", "rad", &GeostaticCheck::deflection_max},
    {"deflection_deep", "rad", &GeostaticCheck::deflection_deep},
});

/// Table `geostatic_rows` of docs/reference/files.md.
inline constexpr auto geostatic_row_columns = std::to_array<Column<GeostaticRow>>({
    {"depth", "m", &GeostaticRow::depth},
    {"vertical_stress", "Pa", &GeostaticRow::vertical},
    {"error", "Pa", &GeostaticRow::error},
    {"scatter", "Pa", &GeostaticRow::scatter},
    {"ratio", "-", &GeostaticRow::k0},
    {"deflection", "rad", &GeostaticRow::deflection},
});

}  // namespace voussoir::host
