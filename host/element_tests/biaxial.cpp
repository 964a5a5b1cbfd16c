#include "host/element_tests/biaxial.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "io/input_error.hpp"
#include "kernels/course/drives.hpp"

namespace voussoir::host {

namespace {

/// See BiaxialCurve::mean_overlap. A test that failed has no report of its end; its packing's overlap stands in.
double largest_overlap(const BiaxialCurve& curve, const PackedRve& start, const kernels::RveReport& end) {
  double most = 0;
  for (const BiaxialPoint& point : curve.points) most = std::max(most, point.p());
  const bool has_end = end.mean_overlap > 0 && end.pressure() > 0;
  const double overlap = has_end ? end.mean_overlap : start.mean_overlap;
  const double pressure = has_end ? end.pressure() : start.pressure;
  return pressure > 0 ? overlap * std::max(most, pressure) / pressure : overlap;
}

}  // namespace

std::vector<BiaxialCurve> biaxial_tests(std::span<const PackedRve> rves, double strain, double inertial_number,
                                        int samples, const kernels::EngineSettings& settings,
                                        const kernels::MicrostructureRequest& microstructure) {
  kernels::RveBatch batch = batch_of(rves);
  std::vector<std::vector<kernels::ServoSample>> traces(rves.size());
  std::vector<kernels::ServoRequest> requests;
  std::vector<BiaxialCurve> curves(rves.size());
  for (std::size_t k = 0; k < rves.size(); ++k) {
    const double pressure = rves[k].pressure;
    const double limit = kernels::largest_rate(rves[k].packing, settings);
    const double rate = std::min(inertial_number / rves[k].packing.inertial_time(pressure), limit);
    if (!(strain / rate < 1e9))
      throw io::InputError("biaxial", "inertial_number", "asks for a rate at which a test takes more than 1e9 steps");
    const int steps = static_cast<int>(std::ceil(strain / rate));
    requests.push_back({.x = {.stress_controlled = true, .target = -pressure},
                        .y = {.stress_controlled = false, .target = -rate},
                        .max_rate = 3.0 * rate,  // dilation is slower than the axial rate
                        .max_steps = 2 * steps,
                        .end_strain_y = strain,
                        .trace = &traces[k],
                        .trace_interval = std::max(1, steps / samples),
                        .microstructure = microstructure});
    curves[k].seed = rves[k].seed;
    curves[k].pressure = pressure;
    curves[k].void_ratio = void_ratio(rves[k].cell.det(), rves[k].packing.solid_area());
    curves[k].inertial_number = rate * rves[k].packing.inertial_time(pressure);
  }
  std::vector<kernels::RveReport> reports(rves.size());
  kernels::advance(batch, std::span<const kernels::ServoRequest>(requests), settings, reports);
  for (std::size_t k = 0; k < rves.size(); ++k) {
    curves[k].status = reports[k].status;
    for (const kernels::ServoSample& s : traces[k]) {
      curves[k].points.push_back(
          {-s.strain_y, -s.strain_x, -s.stress_xx, -s.stress_yy, -s.stress_xy, s.unbalanced, s.microstructure});
    }
    curves[k].mean_overlap = largest_overlap(curves[k], rves[k], reports[k]);
  }
  return curves;
}

}  // namespace voussoir::host
