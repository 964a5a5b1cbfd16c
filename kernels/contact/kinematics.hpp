#pragma once
/// Exponential and logarithm of 2x2 matrices in closed form. With them F(t) = exp(t log F) ends exactly at F, and the
/// path to a rotation consists of rigid rotations.

#include <Kokkos_Macros.hpp>
#include <cmath>
#include <limits>

namespace voussoir::kernels {

/// Row-major 2x2 matrix in double.
struct Mat2 {
  double xx = 0, xy = 0, yx = 0, yy = 0;

  KOKKOS_INLINE_FUNCTION friend Mat2 operator*(const Mat2& a, const Mat2& b) {
    return {a.xx * b.xx + a.xy * b.yx, a.xx * b.xy + a.xy * b.yy, a.yx * b.xx + a.yy * b.yx, a.yx * b.xy + a.yy * b.yy};
  }
  KOKKOS_INLINE_FUNCTION friend Mat2 operator+(const Mat2& a, const Mat2& b) {
    return {a.xx + b.xx, a.xy + b.xy, a.yx + b.yx, a.yy + b.yy};
  }
  KOKKOS_INLINE_FUNCTION friend Mat2 operator*(double s, const Mat2& a) {
    return {s * a.xx, s * a.xy, s * a.yx, s * a.yy};
  }
  KOKKOS_INLINE_FUNCTION friend bool operator==(const Mat2& a, const Mat2& b) {
    return a.xx == b.xx && a.xy == b.xy && a.yx == b.yx && a.yy == b.yy;
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double det() const { return xx * yy - xy * yx; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double norm() const { return std::sqrt(xx * xx + xy * xy + yx * yx + yy * yy); }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION Mat2 inverse() const { return (1.0 / det()) * Mat2{yy, -xy, -yx, xx}; }
};

/// |sym A|: the strain in a velocity gradient, without its rotation.
[[nodiscard]] KOKKOS_INLINE_FUNCTION double symmetric_norm(const Mat2& a) {
  const double shear = 0.5 * (a.xy + a.yx);
  return std::sqrt(a.xx * a.xx + a.yy * a.yy + 2.0 * shear * shear);
}

inline constexpr Mat2 identity2{1, 0, 0, 1};

/// I + A, written out because device code may not refer to `identity2`.
[[nodiscard]] KOKKOS_INLINE_FUNCTION Mat2 plus_identity(const Mat2& a) { return {1.0 + a.xx, a.xy, a.yx, 1.0 + a.yy}; }

/// exp(A) - I without cancellation for small A: A = s I + B with tr B = 0, B^2 = q I, q = -det B.
[[nodiscard]] KOKKOS_INLINE_FUNCTION Mat2 exp_minus_identity(const Mat2& a) {
  const double s = 0.5 * (a.xx + a.yy);
  const Mat2 b{0.5 * (a.xx - a.yy), a.xy, a.yx, 0.5 * (a.yy - a.xx)};
  const double q = -b.det();
  const double d = std::sqrt(std::abs(q));
  const double half = q >= 0 ? std::sinh(0.5 * d) : std::sin(0.5 * d);
  const double cos_minus_one = (q >= 0 ? 2.0 : -2.0) * half * half;
  const double ratio = d < 1e-8 ? 1.0 : (q >= 0 ? std::sinh(d) : std::sin(d)) / d;
  const double es = std::exp(s);
  const double diagonal = std::expm1(s) + es * cos_minus_one;
  return Mat2{diagonal, 0, 0, diagonal} + (es * ratio) * b;
}

/// log(F) for F with positive determinant and no real negative eigenvalue; NaN entries otherwise (also for NaN input).
[[nodiscard]] inline Mat2 log_of(const Mat2& f) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const double det = f.det();
  if (!(det > 0)) return {nan, nan, nan, nan};
  const double scale = 1.0 / std::sqrt(det);
  const double c = 0.5 * scale * (f.xx + f.yy);
  const Mat2 b{0.5 * scale * (f.xx - f.yy), scale * f.xy, scale * f.yx, 0.5 * scale * (f.yy - f.xx)};
  const double q = -b.det();
  const double h = std::sqrt(std::abs(q));
  if (!(c > 0) && q >= 0) return {nan, nan, nan, nan};
  const double ratio = h < 1e-8 ? 1.0 : (q >= 0 ? std::asinh(h) : std::atan2(h, c)) / h;
  const double s = 0.5 * std::log(det);
  return Mat2{s, 0, 0, s} + ratio * b;
}

}  // namespace voussoir::kernels
