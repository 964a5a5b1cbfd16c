#include "host/packing/packing_check.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "host/packing/grading.hpp"
#include "host/packing/law_range.hpp"
#include "host/packing/stored_packing.hpp"
#include "kernels/contact/cell.hpp"
#include "kernels/state/requests.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::host {

namespace {

constexpr double mm = 1e-3;           ///< [m]
constexpr double other_unit = 30.0;   ///< ratio of sizes from which a file is taken to have another unit of length
constexpr double dense_share = 0.85;  ///< share of the cell that grains fill in a dense packing of one size [-]
constexpr double least_filled = 0.2;  ///< shares of the cell that the grains of a packing can fill [-]
constexpr double most_filled = 1.3;
constexpr double farthest_image = 1e4;  ///< cells between a grain and the cell at the origin, from which digits get
                                        ///< lost

double solid_area(const std::vector<double>& radii) {
  return std::accumulate(radii.begin(), radii.end(), 0.0,
                         [](double sum, double r) { return sum + std::numbers::pi * r * r; });
}

double mean_diameter(const std::vector<double>& radii) {
  return 2.0 * std::accumulate(radii.begin(), radii.end(), 0.0) / static_cast<double>(radii.size());
}

/// The width of cell that nearest images need, see kernels::wide_enough [m].
double least_width(const std::vector<double>& radii, double skin) {
  const double largest = *std::max_element(radii.begin(), radii.end());
  return 2.0 * (2.0 * largest + std::max(skin, kernels::EngineSettings{}.skin) * mean_diameter(radii));
}

/// A ratio for a message: "1000", "1/1000".
std::string ratio_text(double ratio) {
  return ratio >= 1 ? fmt::format("{:.0f}", ratio) : fmt::format("1/{:.0f}", 1 / ratio);
}

std::string unit_hint(double ratio) {
  if (ratio > 300 && ratio < 3e3) return "are the file's units millimetres?";
  if (ratio > 30 && ratio < 300) return "are the file's units centimetres?";
  if (ratio > 3e5 && ratio < 3e6) return "are the file's units micrometres?";
  return "is the file's unit of length the metre?";
}

void check_sizes(const std::vector<double>& radii, const SoilCase& soil) {
  constexpr double widest = 40;  // as for the sizes of [soil]
  const auto [least, most] = std::minmax_element(radii.begin(), radii.end());
  if (!(*most <= widest * *least)) {
    throw std::runtime_error(fmt::format(
        "the largest grain is {:.4g} times as large as the smallest one: an RVE can hold grains that differ by "
        "a factor of {:.0f}",
        *most / *least, widest));
  }
  const double ratio = 2.0 * (*least + *most) / (soil.size_minimum + soil.size_maximum);
  if (ratio > other_unit || ratio < 1 / other_unit) {
    throw std::runtime_error(fmt::format(
        "grain sizes are {} times those of [soil]: diameters of {:.4g} to {:.4g} mm, where [soil] has {:.4g} to {:.4g} "
        "mm; {}",
        ratio_text(ratio), 2 * *least / mm, 2 * *most / mm, soil.size_minimum / mm, soil.size_maximum / mm,
        unit_hint(ratio)));
  }
}

void check_cell(const io::Packing& file, double skin) {
  const kernels::Mat2 h{file.cell[0], file.cell[1], file.cell[2], file.cell[3]};
  const double filled = solid_area(file.radius) / h.det();
  if (!(filled > least_filled && filled < most_filled)) {
    throw std::runtime_error(fmt::format(
        "the grains fill {:.3g} times the area of the cell, where a packing fills 0.5 to 1 times of it; does the cell "
        "belong to these grains, in the same unit of length?",
        filled));
  }
  const kernels::Cell cell(kernels::reduced_lattice(h));
  const double width = std::min(cell.height(0), cell.height(1)), least = least_width(file.radius, skin);
  if (!(width > least)) {
    throw std::runtime_error(fmt::format(
        "the cell is {:.4g} mm wide; it is too narrow for its grains, whose largest one needs {:.4g} mm (two "
        "diameters, and the skin of the neighbour lists)",
        width / mm, least / mm));
  }
  for (std::size_t i = 0; i < file.grains(); ++i) {
    const double a = std::abs(cell.inverse.xx * file.x[i] + cell.inverse.xy * file.y[i]);
    const double b = std::abs(cell.inverse.yx * file.x[i] + cell.inverse.yy * file.y[i]);
    if (!(std::max(a, b) < farthest_image)) {
      throw std::runtime_error(
          fmt::format("grain {} (counted from 0) lies {:.3g} cells away from the origin", i, std::max(a, b)));
    }
  }
}

/// The pair of grains that lie deepest in one another, and their overlap over the sum of their radii.
struct DeepestPair {
  std::size_t i = 0, j = 0;
  double overlap = 0;
};

/// Grains are sorted into bins as wide as the largest contact distance, so that the time is in proportion to their
/// number; images make the cell periodic.
DeepestPair deepest_pair(const io::Packing& file) {
  const kernels::Cell cell(kernels::reduced_lattice({file.cell[0], file.cell[1], file.cell[2], file.cell[3]}));
  const double reach = 2.0 * *std::max_element(file.radius.begin(), file.radius.end());
  const auto bins = [&](int axis) { return std::clamp(static_cast<int>(cell.height(axis) / reach), 1, 1000); };
  const int nx = bins(0), ny = bins(1);
  std::map<std::pair<int, int>, std::vector<std::size_t>> members;
  std::vector<std::pair<int, int>> bin_of(file.grains());
  for (std::size_t i = 0; i < file.grains(); ++i) {
    double x = file.x[i], y = file.y[i];
    cell.wrap(x, y);
    const auto slot = [](double part, int n) { return std::clamp(static_cast<int>(part * n), 0, n - 1); };
    bin_of[i] = {slot(cell.inverse.xx * x + cell.inverse.xy * y, nx),
                 slot(cell.inverse.yx * x + cell.inverse.yy * y, ny)};
    members[bin_of[i]].push_back(i);
  }
  DeepestPair deepest;
  for (std::size_t i = 0; i < file.grains(); ++i) {
    for (int k = 0; k < 9; ++k) {
      const std::pair near{(bin_of[i].first + k % 3 - 1 + nx) % nx, (bin_of[i].second + k / 3 - 1 + ny) % ny};
      const auto found = members.find(near);
      if (found == members.end()) continue;
      for (const std::size_t j : found->second) {
        if (j <= i) continue;
        double dx = file.x[j] - file.x[i], dy = file.y[j] - file.y[i];
        cell.nearest(dx, dy);
        const double overlap = 1.0 - std::hypot(dx, dy) / (file.radius[i] + file.radius[j]);
        if (overlap > deepest.overlap) deepest = {i, j, overlap};
      }
    }
  }
  return deepest;
}

void check_overlaps(const io::Packing& file) {
  const double most = most_single_overlap;
  const DeepestPair deepest = deepest_pair(file);
  if (deepest.overlap < most) return;
  throw std::runtime_error(
      fmt::format("the grains {} and {} (counted from 0) overlap by {:.3g} % of the sum of their radii, where at most "
                  "{:.0f} % can be "
                  "computed",
                  deepest.i, deepest.j, 100 * deepest.overlap, 100 * most));
}

}  // namespace

void check_grains(const io::Packing& file, const SoilCase& soil, double skin) {
  if (file.grains() < 2 || file.grains() > kernels::max_grains) {
    throw std::runtime_error(
        fmt::format("has {} grains, where a packing has 2 to {}", file.grains(), kernels::max_grains));
  }
  check_sizes(file.radius, soil);
  if (!(file.thickness >= 1e-3 && file.thickness <= 100)) {  // the limits of soil.thickness
    throw std::runtime_error(fmt::format("the thickness must be 1 mm to 100 m, is {:g} m", file.thickness));
  }
  check_cell(file, skin);
  check_overlaps(file);
}

void check_packing_files(const SoilCase& soil, const PackingCase& recipe, double skin) {
  for (const std::filesystem::path& name : recipe.files) {
    const io::Packing file = io::load_any_packing(name);
    try {
      check_grains(file, soil, skin);
    } catch (const std::runtime_error& fault) {
      throw std::runtime_error(name.string() + ": " + fault.what());
    }
    if (!recipe.has_state()) continue;
    if (const std::string fault = fault_of_state(file); !fault.empty()) {
      throw std::runtime_error(name.string() +
                               " is not a complete packing of this program and its contact law: " + fault);
    }
  }
}

int least_grains(const SoilCase& soil, double coarsest) {
  constexpr int many = 20000;
  const std::vector<double> radii = sample_radii(soil, many, 0);
  const double whole = solid_area(radii);
  double area = 0;
  double count = 0;
  for (const double r : radii) {
    const double own = std::numbers::pi * r * r;
    count += std::min(1.0, (coarsest * whole - area) / own);
    area += own;
    if (area >= coarsest * whole) break;
  }
  return static_cast<int>(std::ceil(many / count));
}

void check_recipe(const SoilCase& soil, int grains, double skin) {
  if (const int least = least_grains(soil, 0.2); grains < least) {
    throw std::runtime_error(fmt::format(
        "is {}, but this grading needs at least {} grains, so that the coarsest fifth of the soil has one grain",
        grains, least));
  }
  const std::vector<double> radii = sample_radii(soil, grains, 0);
  const double width = std::sqrt(solid_area(radii) / dense_share), needed = least_width(radii, skin);
  if (width > needed) return;
  throw std::runtime_error(fmt::format(
      "is {}: their cell of about {:.3g} mm is too narrow for the largest of them, which needs {:.3g} mm (two "
      "diameters, and the skin of the neighbour lists)",
      grains, width / mm, needed / mm));
}

std::string missing_coarse_grains(const SoilCase& soil, int grains) {
  const int enough = least_grains(soil, 0.1);
  if (grains >= enough) return {};
  return fmt::format("packing.grains is {}: packings of fewer than {} grains lack the coarsest tenth of this grading",
                     grains, enough);
}

}  // namespace voussoir::host
