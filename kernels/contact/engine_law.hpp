#pragma once
/// The law that the engine runs. This is the one line that a new law changes; course/choose_instance.hpp picks
/// precision, width and rolling at run time.

#include "kernels/contact/linear_law.hpp"

namespace voussoir::kernels {

template <class V, bool Rolling>
using EngineLaw = LinearContactLaw<V, Rolling>;

/// The same in double and for one RVE, with all that it knows: for what is computed about single contacts.
using PlainEngineLaw = EngineLaw<SingleLane<double>, true>;

}  // namespace voussoir::kernels
