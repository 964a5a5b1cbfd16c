#include "tests/reference/plane.hpp"

#include <stdexcept>

namespace voussoir::reference {
namespace {

double size(const Mat2& a) { return std::abs(a.xx) + std::abs(a.xy) + std::abs(a.yx) + std::abs(a.yy); }

/// Principal square root of a 2x2 matrix: (A + sqrt(det A) I) / sqrt(tr A + 2 sqrt(det A)), from Cayley and Hamilton.
Mat2 square_root(const Mat2& a) {
  const double s = std::sqrt(det(a));
  return (1.0 / std::sqrt(a.xx + a.yy + 2.0 * s)) * (a + s * identity);
}

/// log(A) = 2 artanh((A - I)(A + I)^-1) for A near I.
Mat2 log_near_identity(const Mat2& a) {
  const Mat2 z = (a - identity) * inverse(a + identity);
  const Mat2 z2 = z * z;
  Mat2 power = z;
  Mat2 sum;
  for (int k = 1; k < 40 && size(power) > 0; k += 2) {
    sum = sum + (1.0 / k) * power;
    power = power * z2;
  }
  return 2.0 * sum;
}

}  // namespace

Mat2 logarithm(const Mat2& f) {
  if (!(det(f) > 0) || !(f.xx + f.yy + 2.0 * std::sqrt(det(f)) > 0)) {
    throw std::invalid_argument("logarithm: F has no real logarithm");
  }
  Mat2 root = f;
  double scale = 2.0;
  while (size(root - identity) > 0.25) {
    root = square_root(root);
    scale *= 2.0;
  }
  return (0.5 * scale) * log_near_identity(root);
}

Mat2 exponential_minus_identity(const Mat2& a) {
  Mat2 term = a;
  Mat2 sum;
  for (int k = 2; k < 60; ++k) {
    sum = sum + term;
    term = (1.0 / k) * (term * a);
  }
  return sum;
}

}  // namespace voussoir::reference
