#pragma once
/// The tables of a case file, one function each. The defaults are those of the structs' members.

#include "host/case/case.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {

[[nodiscard]] SoilCase read_soil(const io::Table& table);
[[nodiscard]] PackingCase read_packing(const io::Table& table);
[[nodiscard]] EngineCase read_engine(const io::Table& table, bool on_a_mesh);
[[nodiscard]] ProbeCase read_probe(const io::Table& table);
[[nodiscard]] BiaxialCase read_biaxial(const io::Table& table);
[[nodiscard]] CalibrateCase read_calibrate(const io::Table& table, const SoilCase& soil);
[[nodiscard]] ElasticCase read_elastic(const io::Table& table);
[[nodiscard]] BiaxialBvpCase read_biaxial_bvp(const io::Table& table);
[[nodiscard]] GroundCase read_ground(const io::Table& table, bool with_tunnel);
[[nodiscard]] ColumnCase read_column(const io::Table& table);
[[nodiscard]] GravityCase read_gravity(const io::Table& table);
[[nodiscard]] VolumeLossCase read_volume_loss(const io::Table& table);
[[nodiscard]] NewtonCase read_newton(const io::Table& table);
[[nodiscard]] OutputCase read_output(const io::Table& table);
/// The key `microstructure` of [output], the only one there of a case without a mesh.
[[nodiscard]] kernels::MicrostructureRequest read_microstructure(const io::Table& table);

/// The key `tangent`.
[[nodiscard]] TangentChoice read_tangent(const io::Table& table, TangentChoice otherwise);

/// Reads a key into `member`, whose value before is the key's default. Throws io::InputError.
void read_quantity(const io::Table& table, const char* key, io::Dimension dimension, double& member,
                   io::QuantityRule rule = {});
void read_integer(const io::Table& table, const char* key, int& member, io::IntegerRule rule);

}  // namespace voussoir::host
