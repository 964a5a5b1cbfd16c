#pragma once
/// Reading of single keys of a case file. The value that a member has before it is read is the default of its key.

#include "io/case_file.hpp"

namespace voussoir::host {

/// Reads a key into `member`. Both throw io::InputError.
void read_quantity(const io::Table& table, const io::Key& key, io::Dimension dimension, double& member,
                   io::QuantityRule rule = {});
void read_integer(const io::Table& table, const io::Key& key, int& member, io::IntegerRule rule);

}  // namespace voussoir::host
