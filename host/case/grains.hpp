#pragma once
/// The tables of the grains: [soil], [packing]. All readers throw io::InputError.

#include "host/case/case.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {

[[nodiscard]] SoilCase read_soil(const io::Table& table);
[[nodiscard]] PackingCase read_packing(const io::Table& table);

}  // namespace voussoir::host
