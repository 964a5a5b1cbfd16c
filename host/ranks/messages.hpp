#pragma once
/// The first rank's commands and the other ranks' replies, as bytes. A message is a Command and its values; a reply is
/// `true` and its values, or `false` and a sentence that says what failed.

#include <cstdint>

#include "host/material/rve_pool.hpp"
#include "host/packing/variety.hpp"
#include "host/ranks/channel.hpp"
#include "io/byte_stream.hpp"

namespace voussoir::host {

using io::ByteReader;
using io::ByteWriter;

enum class Command : std::uint8_t {
  start,            ///< revision of the build, threads, instruction set -> host, threads, set of the lanes, its fault
  make,             ///< recipe of the pool -> committed reports
  begin_increment,  ///< ->
  evaluate,         ///< tangents or not, gradients -> seconds, particle-steps, error of deferred answers, trial reports
  commit,           ///< ->
  fields,           ///< -> number of fields, the fields
  states,           ///< first RVE, number of RVEs -> their records
  retire,           ///< points that have been dug out ->
  set_states,       ///< first RVE, records -> committed reports of all RVEs
  forget,           ///< the pool is no longer needed -> peak memory
  quit              ///< no reply
};

inline Message message_of(Command command) { return {static_cast<std::byte>(command)}; }

template <class... Values>
Message message_of(Command command, const Values&... values) {
  Message message = message_of(command);
  ByteWriter write(message);
  (write.value(values), ...);
  return message;
}

/// Writes the packing and its state, since a pool needs nothing else; the values about its making are left out.
inline void write_rve(ByteWriter& write, const PackedRve& rve) {
  write.list(rve.packing.radii);
  write.list(rve.packing.materials);
  write.list(rve.packing.class_of);
  write.value(rve.packing.thickness);
  write.value(rve.packing.local_damping);
  write.list(rve.position);
  write.list(rve.rotation);
  write.value(rve.cell);
  write.list(rve.contact_key);
  write.list(rve.contact_history);
  write.value(rve.seed);
}

inline PackedRve read_rve(ByteReader& read) {
  PackedRve rve;
  rve.packing.radii = read.list<double>();
  rve.packing.materials = read.list<kernels::GrainMaterial>();
  rve.packing.class_of = read.list<std::uint8_t>();
  rve.packing.thickness = read.value<double>();
  rve.packing.local_damping = read.value<double>();
  rve.position = read.list<double>();
  rve.rotation = read.list<double>();
  rve.cell = read.value<kernels::Mat2>();
  rve.contact_key = read.list<std::uint32_t>();
  rve.contact_history = read.list<double>();
  rve.seed = read.value<std::int64_t>();
  return rve;
}

inline void write_mix(ByteWriter& write, const PackingMix& mix) {
  write.value(static_cast<std::uint64_t>(mix.packings.size()));
  for (const PackedRve& rve : mix.packings) write_rve(write, rve);
  write.list(mix.of_point);
}

inline PackingMix read_mix(ByteReader& read) {
  PackingMix mix;
  for (auto n = read.value<std::uint64_t>(); n > 0; --n) mix.packings.push_back(read_rve(read));
  mix.of_point = read.list<int>();
  return mix;
}

/// Writes or reads the options of a pool. Every member is bound to a name here, so that a new option does not
/// compile until somebody decides whether it is sent. The preset's name is not sent, since the other members hold its
/// values; the instruction set goes with the command `start`, and each rank knows its own number.
template <class Transfer, class Options>
void transfer_options(Transfer& transfer, Options& options) {
  auto& [engine, tangent, tangent_tolerance, tangent_strain, microstructure, local_rank] = options;
  auto& [preset, precision, inertial_number, hold_tolerance, backend, isa, hold_cap, skin, minimum_steps, maximum_steps,
         accuracy, defer] = engine;
  static_cast<void>(preset);
  static_cast<void>(isa);
  static_cast<void>(local_rank);
  transfer(&precision, 1);
  transfer(&backend, 1);
  for (auto* number : {&inertial_number, &hold_tolerance, &skin, &accuracy, &defer}) transfer(number, 1);
  for (auto* count : {&hold_cap, &minimum_steps, &maximum_steps}) transfer(count, 1);
  transfer(&tangent, 1);
  transfer(&tangent_tolerance, 1);
  transfer(&tangent_strain, 1);
  transfer(&microstructure, 1);
}

}  // namespace voussoir::host
