#pragma once
/// Vectors and 2x2 matrices of the oracle. Its own, because nothing of kernels/ may enter here.

#include <cmath>

namespace voussoir::reference {

struct Vec2 {
  double x = 0;
  double y = 0;
};

/// Row-major 2x2 matrix; as a cell its columns are the periodic vectors.
struct Mat2 {
  double xx = 0;
  double xy = 0;
  double yx = 0;
  double yy = 0;
};

inline constexpr Mat2 identity{1, 0, 0, 1};

inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
inline double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
inline double norm(Vec2 a) { return std::sqrt(dot(a, a)); }
/// a turned left by a right angle.
inline Vec2 left_of(Vec2 a) { return {-a.y, a.x}; }

inline Mat2 operator+(const Mat2& a, const Mat2& b) { return {a.xx + b.xx, a.xy + b.xy, a.yx + b.yx, a.yy + b.yy}; }
inline Mat2 operator-(const Mat2& a, const Mat2& b) { return {a.xx - b.xx, a.xy - b.xy, a.yx - b.yx, a.yy - b.yy}; }
inline Mat2 operator*(double s, const Mat2& a) { return {s * a.xx, s * a.xy, s * a.yx, s * a.yy}; }
inline Vec2 operator*(const Mat2& a, Vec2 v) { return {a.xx * v.x + a.xy * v.y, a.yx * v.x + a.yy * v.y}; }
inline Mat2 operator*(const Mat2& a, const Mat2& b) {
  return {a.xx * b.xx + a.xy * b.yx, a.xx * b.xy + a.xy * b.yy, a.yx * b.xx + a.yy * b.yx, a.yx * b.xy + a.yy * b.yy};
}
inline double det(const Mat2& a) { return a.xx * a.yy - a.xy * a.yx; }
inline Mat2 inverse(const Mat2& a) { return (1.0 / det(a)) * Mat2{a.yy, -a.xy, -a.yx, a.xx}; }
inline Mat2 transpose(const Mat2& a) { return {a.xx, a.yx, a.xy, a.yy}; }
inline Mat2 symmetric_part(const Mat2& a) { return 0.5 * (a + transpose(a)); }

/// log F = 2^k log F^(1/2^k), the latter by its power series: slow, and shares nothing with the closed form of the
/// engine.
/// @throws std::invalid_argument unless det F > 0 and no eigenvalue lies on the negative real axis
Mat2 logarithm(const Mat2& f);

/// exp(A) - I by its power series, for |A| of a few units at most.
Mat2 exponential_minus_identity(const Mat2& a);

}  // namespace voussoir::reference
