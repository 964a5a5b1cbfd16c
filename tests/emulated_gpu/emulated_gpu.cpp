// A library of a device as the program opens it (kernels/device/device_library.hpp), whose device is the host: what a
// program does with a GPU can be tested without one. The environment variable VOUSSOIR_EMULATED_GPUS says how many
// devices there are; without it there is one. VOUSSOIR_EMULATED_ROOM says for how many RVEs a device has memory.

#include <cstdlib>
#include <stdexcept>

#include "kernels/device/device_library.hpp"
#include "kernels/device/host_backend.hpp"
#include "kernels/device/resident_batch.hpp"

namespace voussoir::kernels::device {
namespace {

/// The number in an environment variable.
std::size_t number_in(const char* variable, std::size_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoul(text, nullptr, 10);
}

class EmulatedDevice final : public Device {
 public:
  explicit EmulatedDevice(std::size_t number) : number_(number) {}
  [[nodiscard]] std::string name() const override { return "emulated device " + std::to_string(number_); }
  [[nodiscard]] std::unique_ptr<ResidentRves> hold(const RveSet& rves, Precision precision) override {
    if (rves.packing_of.size() > number_in("VOUSSOIR_EMULATED_ROOM", rves.packing_of.size()))
      throw std::runtime_error("the device has no memory left");
    return device::hold<HostBackend>(rves, precision);
  }

 private:
  std::size_t number_;
};

}  // namespace
}  // namespace voussoir::kernels::device

extern "C" {

__attribute__((visibility("default"))) std::size_t voussoir_device_interface() {
  return voussoir::kernels::device::interface_number;
}

__attribute__((visibility("default"))) std::size_t voussoir_device_count(std::string* why) {
  const std::size_t count = voussoir::kernels::device::number_in("VOUSSOIR_EMULATED_GPUS", 1);
  if (count == 0) *why = "the driver knows no device";
  return count;
}

__attribute__((visibility("default"))) voussoir::kernels::device::Device* voussoir_device_open(std::size_t number,
                                                                                               std::string*) {
  return new voussoir::kernels::device::EmulatedDevice(number);
}
}
