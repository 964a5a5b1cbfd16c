#pragma once
/// The tables of the kinds with a mesh: [elastic], [biaxial_bvp], [ground], [column], [gravity], [volume_loss],
/// [newton], [output]. All readers throw io::InputError.

#include "host/case/case.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {

[[nodiscard]] ElasticCase read_elastic(const io::Table& table);
[[nodiscard]] BiaxialBvpCase read_biaxial_bvp(const io::Table& table);
[[nodiscard]] GroundCase read_ground(const io::Table& table, bool with_tunnel);
[[nodiscard]] ColumnCase read_column(const io::Table& table);
[[nodiscard]] GravityCase read_gravity(const io::Table& table);
[[nodiscard]] VolumeLossCase read_volume_loss(const io::Table& table);
[[nodiscard]] NewtonCase read_newton(const io::Table& table);
[[nodiscard]] OutputCase read_output(const io::Table& table);

/// The key `microstructure` of [output]. A case without a mesh has only this key there.
[[nodiscard]] kernels::MicrostructureRequest read_microstructure(const io::Table& table);

}  // namespace voussoir::host
