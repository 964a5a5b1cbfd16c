#include "host/case/keys.hpp"

#include "io/units.hpp"

namespace voussoir::host {

void read_quantity(const io::Table& table, const io::Key& key, io::Dimension dimension, double& member,
                   io::QuantityRule rule) {
  rule.fallback = io::format_quantity(member, dimension);
  member = table.quantity(key, dimension, rule);
}

void read_integer(const io::Table& table, const io::Key& key, int& member, io::IntegerRule rule) {
  rule.fallback = member;
  member = static_cast<int>(table.integer(key, rule));
}

}  // namespace voussoir::host
