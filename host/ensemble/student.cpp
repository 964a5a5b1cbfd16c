#include "host/ensemble/student.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace voussoir::host {
namespace {

/// The probability that |T| <= t = sqrt(degrees) tan(angle): the finite sums for whole degrees of freedom in
/// Abramowitz and Stegun, eqs. 26.7.3 (odd) and 26.7.4 (even).
double probability_within(double angle, int degrees) {
  const bool odd = degrees % 2 == 1;
  const double cosine = std::cos(angle);
  double term = odd ? cosine : 1.0;
  double sum = degrees > 1 ? term : 0.0;
  for (int k = odd ? 3 : 2; k <= degrees - 2; k += 2) {
    term *= cosine * cosine * (k - 1) / k;
    sum += term;
  }
  sum *= std::sin(angle);
  return odd ? 2 / std::numbers::pi * (angle + sum) : sum;
}

}  // namespace

double student_two_sided(double confidence, int degrees) {
  if (!(confidence > 0) || !(confidence < 1) || degrees < 1)
    throw std::invalid_argument("Student's t needs a probability between 0 and 1 and a degree of freedom");
  double low = 0;
  double high = 0.5 * std::numbers::pi;
  for (;;) {  // the probability rises with the angle; the halves end where two neighbouring numbers are reached
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return std::sqrt(static_cast<double>(degrees)) * std::tan(low);
    (probability_within(middle, degrees) < confidence ? low : high) = middle;
  }
}

}  // namespace voussoir::host
