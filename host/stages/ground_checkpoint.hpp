#pragma once
/// The ground as a checkpoint holds it: everything that the next increment depends on.

#include "host/stages/ground.hpp"
#include "io/checkpoint.hpp"

namespace voussoir::host {

void save(const Ground& ground, io::Checkpoint& checkpoint);
/// Throws std::runtime_error on a checkpoint of another mesh.
void restore(Ground& ground, const io::Checkpoint& checkpoint);

}  // namespace voussoir::host
