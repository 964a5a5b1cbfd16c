#include "tests/reference/reference_rve.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace voussoir::reference {
namespace {

struct Forces {
  std::vector<Vec2> force;
  std::vector<double> torque;
  std::vector<Contact> contacts;
};

void complete(Rve& rve) {
  const std::size_t n = rve.positions.size();
  if (rve.rotations.empty()) rve.rotations.assign(n, 0.0);
  if (rve.velocities.empty()) rve.velocities.assign(n, Vec2{});
  if (rve.spins.empty()) rve.spins.assign(n, 0.0);
  if (rve.radii.size() != n || rve.rotations.size() != n || rve.velocities.size() != n || rve.spins.size() != n) {
    throw std::invalid_argument("Rve: arrays of unequal length");
  }
}

/// While the largest contact distance is below half of both heights of the cell, a grain has at most one image of
/// another within reach, and rounding the fractional coordinates finds it (all of |f| < 1/2), however sheared the cell
/// is.
void check_cell(const Rve& rve) {
  const double radius = *std::max_element(rve.radii.begin(), rve.radii.end());
  const double area = det(rve.cell);
  const double longest = std::max(norm({rve.cell.xx, rve.cell.yx}), norm({rve.cell.xy, rve.cell.yy}));
  if (!(2.0 * radius < 0.5 * area / longest)) {
    throw std::invalid_argument("Rve: the cell is too small for its grains, or inverted");
  }
}

Vec2 nearest_image(const Mat2& cell, const Mat2& inverse_cell, Vec2 difference) {
  const Vec2 f = inverse_cell * difference;
  return cell * Vec2{f.x - std::round(f.x), f.y - std::round(f.y)};
}

double clamped(double value, double bound) { return std::max(-bound, std::min(value, bound)); }

/// The law, docs/explanation/contact_law.md, for one touching pair whose motion in this step is D, w and theta of
/// `rve`.
Contact call_law(const Rve& rve, const Mat2& d, int i, int j, Vec2 branch, History& history) {
  const Material& material = rve.material;
  const double ri = rve.radii[i];
  const double rj = rve.radii[j];
  const double distance = norm(branch);
  const Vec2 n = (1.0 / distance) * branch;
  const Vec2 t = left_of(n);
  const PairStiffness k = pair_stiffness(material, ri, rj);
  const double overlap = ri + rj - distance;
  const double fn = k.normal * overlap;
  const double translation = dot(d * branch + rve.velocities[j] - rve.velocities[i], t);
  const double sliding = (ri + rj) / distance * translation - (ri * rve.spins[i] + rj * rve.spins[j]);
  history.tangential = clamped(history.tangential + k.tangential * sliding, material.friction * fn);
  const double rolling = rve.spins[j] - rve.spins[i];
  history.moment = clamped(history.moment + k.rolling * rolling, material.rolling_limit * std::min(ri, rj) * fn);
  return {i, j, n, distance, overlap, k.normal, k.tangential, fn, history.tangential, history.moment};
}

void add_contact(Forces& sum, const Contact& c, double ri, double rj) {
  const Vec2 p = -c.normal_force * c.normal + c.tangential_force * left_of(c.normal);
  sum.force[c.i] = sum.force[c.i] + p;
  sum.force[c.j] = sum.force[c.j] - p;
  sum.torque[c.i] += (ri - 0.5 * c.overlap) * c.tangential_force + c.moment;
  sum.torque[c.j] += (rj - 0.5 * c.overlap) * c.tangential_force - c.moment;
  sum.contacts.push_back(c);
}

/// One pass over all pairs: histories are advanced, those of open pairs dropped.
Forces pass(Rve& rve, const Mat2& d) {
  const int n = static_cast<int>(rve.positions.size());
  const Mat2 inverse_cell = inverse(rve.cell);
  Forces sum{std::vector<Vec2>(n), std::vector<double>(n, 0.0), {}};
  Histories kept;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      const Vec2 branch = nearest_image(rve.cell, inverse_cell, rve.positions[j] - rve.positions[i]);
      if (!(norm(branch) < rve.radii[i] + rve.radii[j])) continue;
      const auto old = rve.histories.find({i, j});
      History history = old == rve.histories.end() ? History{} : old->second;
      add_contact(sum, call_law(rve, d, i, j, branch, history), rve.radii[i], rve.radii[j]);
      kept.emplace_hint(kept.end(), std::pair{i, j}, history);
    }
  }
  rve.histories = std::move(kept);
  return sum;
}

/// Cundall's local damping of one force component; `velocity` is that before the step, `a` the mobility.
double damped(double force, double velocity, double a, double lambda) {
  const double sign = velocity + 0.5 * a * force < 0 ? -1.0 : 1.0;
  return force - lambda * std::abs(force) * sign;
}

void accelerate(Rve& rve, const Forces& sum, double rigid_spin) {
  const double lambda = rve.material.damping;
  const double largest = *std::max_element(rve.radii.begin(), rve.radii.end());
  for (std::size_t i = 0; i < rve.positions.size(); ++i) {
    const auto [a, ar] = mobility(rve.material, rve.radii[i], largest);
    const Vec2 f = sum.force[i];
    const double torque = sum.torque[i];
    Vec2& w = rve.velocities[i];
    const Vec2 turn = rigid_spin * left_of(w);
    w = w + a * Vec2{damped(f.x, w.x, a, lambda), damped(f.y, w.y, a, lambda)} + turn;
    rve.spins[i] += ar * damped(torque, rve.spins[i], ar, lambda);
    // Torque counts: in a symmetric packing forces may cancel to the last bit while the contacts are loaded.
    if (f.x == 0.0 && f.y == 0.0 && torque == 0.0) {
      w = 0.9 * w;
      rve.spins[i] *= 0.9;
    }
  }
}

double mean_diameter(const Rve& rve) {
  double sum = 0;
  for (const double r : rve.radii) sum += 2.0 * r;
  return sum / static_cast<double>(rve.radii.size());
}

Voigt voigt(const Mat2& s) { return {s.xx, s.yy, 0.5 * (s.xy + s.yx)}; }

StepTrace trace_of(const Rve& rve, const Forces& sum) {
  StepTrace trace{voigt(love_weber(rve, sum.contacts)), 0, static_cast<int>(sum.contacts.size())};
  double square = 0;
  for (const Vec2 f : sum.force) square += dot(f, f);
  const double scale = std::max(pressure(trace.stress), 100.0) * rve.material.thickness * mean_diameter(rve);
  trace.unbalanced_ratio = std::sqrt(square / static_cast<double>(sum.force.size())) / scale;
  return trace;
}

double spin_of(const Mat2& rate) { return 0.5 * (rate.yx - rate.xy); }

void move(Rve& rve, const Mat2& rate) {
  const Mat2 increment = exponential_minus_identity(rate);
  for (std::size_t i = 0; i < rve.positions.size(); ++i) {
    rve.positions[i] = rve.positions[i] + increment * rve.positions[i] + rve.velocities[i];
    rve.rotations[i] += spin_of(rate) + rve.spins[i];
  }
  rve.cell = rve.cell + increment * rve.cell;
}

void stop(Rve& rve) {
  std::fill(rve.velocities.begin(), rve.velocities.end(), Vec2{});
  std::fill(rve.spins.begin(), rve.spins.end(), 0.0);
}

}  // namespace

PairStiffness pair_stiffness(const Material& material, double radius_i, double radius_j) {
  const double kn = 2.0 * material.modulus * radius_i * radius_j / (radius_i + radius_j);
  const double kt = material.stiffness_ratio * kn;
  return {kn, kt, material.rolling_stiffness * kt * radius_i * radius_j};
}

Mobility mobility(const Material& material, double radius, double largest_radius) {
  const double kn = material.modulus * radius;
  const double kt = material.stiffness_ratio * kn;
  const double c2 = material.step_safety * material.step_safety;
  const double worst_rolling = pair_stiffness(material, radius, largest_radius).rolling;  // beta kt r^2 against its
                                                                                          // like
  return {4.0 * c2 / (6.0 * kn + 12.0 * kt), 4.0 * c2 / (24.0 * kt * radius * radius + 12.0 * worst_rolling)};
}

std::vector<Contact> contacts(const Rve& rve) {
  Rve copy = rve;
  complete(copy);
  check_cell(copy);
  stop(copy);
  return pass(copy, Mat2{}).contacts;
}

Mat2 love_weber(const Rve& rve, const std::vector<Contact>& contacts) {
  Mat2 s;
  for (const Contact& c : contacts) {
    const Vec2 p = -c.normal_force * c.normal + c.tangential_force * left_of(c.normal);
    const Vec2 b = c.distance * c.normal;
    s = s + Mat2{p.x * b.x, p.x * b.y, p.y * b.x, p.y * b.y};
  }
  return (1.0 / (det(rve.cell) * rve.material.thickness)) * s;
}

Voigt stress(const Rve& rve) { return voigt(love_weber(rve, contacts(rve))); }

double pressure(const Voigt& stress) { return -0.5 * (stress[0] + stress[1]); }

VoigtMatrix tangent(const Rve& rve) {
  VoigtMatrix d{};
  const double volume = det(rve.cell) * rve.material.thickness;
  for (const Contact& c : contacts(rve)) {
    const Vec2 n = c.normal;
    const Vec2 t = left_of(n);
    const Voigt nn{n.x * n.x, n.y * n.y, n.x * n.y};
    const Voigt tn{t.x * n.x, t.y * n.y, 0.5 * (t.x * n.y + t.y * n.x)};
    const double b2 = c.distance * c.distance / volume;
    for (int p = 0; p < 3; ++p) {
      for (int q = 0; q < 3; ++q) {
        d[p][q] += b2 * (c.normal_stiffness * nn[p] * nn[q] + c.tangential_stiffness * tn[p] * tn[q]);
      }
    }
  }
  return d;
}

double coordination_number(const Rve& rve) {
  return 2.0 * static_cast<double>(contacts(rve).size()) / static_cast<double>(rve.radii.size());
}

double mean_rotation(const Rve& rve) {
  double sum = 0;
  for (const double angle : rve.rotations) sum += angle;
  return sum / static_cast<double>(rve.radii.size());
}

double energy(const Rve& rve) {
  double sum = 0;
  for (const Contact& c : contacts(rve)) {
    const double kr = pair_stiffness(rve.material, rve.radii[c.i], rve.radii[c.j]).rolling;
    sum += 0.5 * c.normal_stiffness * c.overlap * c.overlap;
    sum += 0.5 * c.tangential_force * c.tangential_force / c.tangential_stiffness;
    if (kr > 0) sum += 0.5 * c.moment * c.moment / kr;
  }
  const double largest = *std::max_element(rve.radii.begin(), rve.radii.end());
  for (std::size_t i = 0; i < rve.velocities.size(); ++i) {
    const auto [a, ar] = mobility(rve.material, rve.radii[i], largest);
    sum += 0.5 * dot(rve.velocities[i], rve.velocities[i]) / a + 0.5 * rve.spins[i] * rve.spins[i] / ar;
  }
  return sum;
}

StepTrace step(Rve& rve, const Mat2& rate, const Mat2& next_rate) {
  complete(rve);
  move(rve, rate);
  check_cell(rve);
  const Forces sum = pass(rve, symmetric_part(rate));
  const StepTrace trace = trace_of(rve, sum);
  accelerate(rve, sum, spin_of(next_rate));
  return trace;
}

StrainReport strain(Rve& rve, const Mat2& f, const StrainOptions& options) {
  if (options.steps < 1) throw std::invalid_argument("strain: at least one step");
  const Mat2 rate = (1.0 / options.steps) * logarithm(f);
  StrainReport report;
  for (int k = 0; k < options.steps + options.hold_steps && !report.met_tolerance; ++k) {
    const int held = k - options.steps + 1;
    const StepTrace trace = step(rve, held > 0 ? Mat2{} : rate, held >= 0 ? Mat2{} : rate);
    if (options.keep_trace) report.trace.push_back(trace);
    report.unbalanced_ratio = trace.unbalanced_ratio;
    report.met_tolerance = held > 0 && held % options.look_every == 0 && trace.unbalanced_ratio < options.tolerance;
    report.steps = k + 1;
  }
  commit(rve);
  return report;
}

void commit(Rve& rve) {
  complete(rve);
  move(rve, Mat2{});
  check_cell(rve);
  stop(rve);
  pass(rve, Mat2{});
}

}  // namespace voussoir::reference
