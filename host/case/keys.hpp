#pragma once
/// Keys of a case file whose default is a struct's own: what a member holds before is the key's default.

#include "io/case_file.hpp"

namespace voussoir::host {

/// Reads a key into `member`. Both throw io::InputError.
void read_quantity(const io::Table& table, const char* key, io::Dimension dimension, double& member,
                   io::QuantityRule rule = {});
void read_integer(const io::Table& table, const char* key, int& member, io::IntegerRule rule);

}  // namespace voussoir::host
