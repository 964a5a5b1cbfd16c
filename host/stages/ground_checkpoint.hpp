#pragma once
/// Ground to checkpoint and back. A checkpoint holds everything that the next increment depends on.

#include "host/stages/ground.hpp"
#include "io/checkpoint.hpp"

namespace voussoir::host {

void save(const Ground& ground, io::Checkpoint& checkpoint);
/// Throws io::InputError where the checkpoint belongs to another mesh.
void restore(Ground& ground, const io::Checkpoint& checkpoint);

}  // namespace voussoir::host
