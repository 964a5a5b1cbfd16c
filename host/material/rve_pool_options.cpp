#include "host/case/engine.hpp"
#include "host/material/rve_pool.hpp"

namespace voussoir::host {
namespace {

/// Tolerance of the static tangents with which Newton iterates: they are off by 1 % at most, as their error is
/// estimated. A smaller tolerance does not save evaluations (docs/explanation/tangents.md).
constexpr double newton_tangent_tolerance = 0.1;

}  // namespace

PoolOptions options_for_newton(const EngineCase& engine, TangentChoice tangent, double tangent_strain) {
  PoolOptions options{.engine = engine, .tangent = tangent_kind(tangent), .tangent_strain = tangent_strain};
  // With a tolerance of a tenth, a loading tangent would hardly differ from the elastic tangent that it starts from.
  if (options.tangent != kernels::TangentKind::loading) options.tangent_tolerance = newton_tangent_tolerance;
  return options;
}

}  // namespace voussoir::host
