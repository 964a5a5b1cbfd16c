#pragma once
/// The law that the engine runs. A new law changes one line of this file; course/choose_instance.hpp chooses precision,
/// width and rolling at run time.

#include "kernels/contact/linear_law.hpp"

namespace voussoir::kernels {

template <class V, bool Rolling>
using EngineLaw = LinearContactLaw<V, Rolling>;

/// The same law in double for one RVE, with rolling: for computations about single contacts.
using PlainEngineLaw = EngineLaw<SingleLane<double>, true>;
/// The same without rolling: for normal forces alone.
using NormalForceLaw = EngineLaw<SingleLane<double>, false>;

}  // namespace voussoir::kernels
