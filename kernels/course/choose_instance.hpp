#pragma once
/// The choice at run time between the compiled instances of the engine: precision, number of lanes side by side, and
/// whether grains resist rolling. The law itself is chosen in contact/engine_law.hpp. Lanes and devices both use this
/// choice.

#include <type_traits>

#include "kernels/contact/engine_law.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

/// Passes a type to a function as an argument.
template <class Type>
struct Instance {
  using type = Type;
};

/// Whether most RVEs have a packing of their own. Such RVEs would leave most lanes of a group empty, so that each of
/// them runs alone instead (lanes/spread_rve.hpp).
[[nodiscard]] inline bool mostly_alone(const RveBatch& batch) { return batch.size() < 2 * batch.packings.size(); }

/// Calls body(Instance<float or double>).
template <class Body>
auto choose_precision(Precision precision, const Body& body) {
  return precision == Precision::float32 ? body(Instance<float>{}) : body(Instance<double>{});
}

/// Calls body(Instance<Law>) with the law over the value type that the batch and the precision ask for. `Value<real>`
/// is SingleLane<real> for devices, and for lanes the value that holds as many RVEs as the instruction set allows.
template <template <class> class Value, class Body>
auto choose_instance(const RveBatch& batch, Precision precision, const Body& body) {
  const auto with = [&]<class V>(Instance<V>) {
    return rolls(batch.packings) ? body(Instance<EngineLaw<V, true>>{}) : body(Instance<EngineLaw<V, false>>{});
  };
  return choose_precision(precision, [&]<class real>(Instance<real>) {
    if constexpr (!std::is_same_v<Value<real>, SingleLane<real>>) {
      if (!mostly_alone(batch)) return with(Instance<Value<real>>{});
    }
    return with(Instance<SingleLane<real>>{});
  });
}

}  // namespace voussoir::kernels
