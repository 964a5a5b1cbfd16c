#pragma once
/// Ground to checkpoint and back. A checkpoint holds everything that the next increment depends on.

#include <cstddef>
#include <string>

#include "host/stages/ground.hpp"
#include "io/checkpoint.hpp"

namespace voussoir::host {

void save(const Ground& ground, io::Checkpoint& checkpoint);
/// Throws io::InputError where the checkpoint belongs to another mesh.
void restore(Ground& ground, const io::Checkpoint& checkpoint);

/// A vector under a name; get_vector throws io::InputError where it has another size.
void put_vector(io::Checkpoint& checkpoint, const std::string& name, const Eigen::VectorXd& values);
[[nodiscard]] Eigen::VectorXd get_vector(const io::Checkpoint& checkpoint, const std::string& name, std::size_t size);

}  // namespace voussoir::host
