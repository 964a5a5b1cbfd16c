#include "fem/material_batch.hpp"

#include <stdexcept>
#include <utility>

namespace voussoir::fem {

namespace {

class HeldBytes final : public HeldState {
 public:
  explicit HeldBytes(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}
  [[nodiscard]] std::size_t size() const override { return bytes_.size(); }
  void write(const Sink& sink) const override { sink(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace

void MaterialBatch::retire(std::span<const std::size_t> points) {
  if (!points.empty()) throw std::logic_error("this material cannot be dug out");
}

std::shared_ptr<const HeldState> MaterialBatch::hold() { return std::make_shared<HeldBytes>(state()); }

void MaterialBatch::return_to(const HeldState& held) {
  held.write([this](std::span<const std::byte> bytes) { set_state(bytes); });
}

}  // namespace voussoir::fem
