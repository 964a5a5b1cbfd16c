// The functions that the program asks of libvoussoir_gpu.so.

#include "kernels/device/cuda/cuda_backend.hpp"
#include "kernels/device/cuda/instances.hpp"
#include "kernels/device/device_library.hpp"
#include "kernels/device/resident_batch.hpp"

namespace voussoir::kernels::device {

namespace {

class CudaDevice final : public Device {
 public:
  explicit CudaDevice(int number) : number_(number) {
    check_cuda(cudaSetDevice(number), "the device cannot be chosen");
    check_cuda(cudaGetDeviceProperties(&properties_, number), "the device does not say what it is");
    cudaFuncAttributes any;
    check_cuda(cudaFuncGetAttributes(&any, copy_kernel<copy_threads>), "the library has no code for this device");
  }
  [[nodiscard]] std::string name() const override {
    return std::string(properties_.name) + ", compute capability " + std::to_string(properties_.major) + "." +
           std::to_string(properties_.minor) + ", " + std::to_string(properties_.totalGlobalMem >> 20) + " MiB";
  }
  [[nodiscard]] std::unique_ptr<ResidentRves> hold(const RveSet& rves, Precision precision) override {
    check_cuda(cudaSetDevice(number_), "the device cannot be chosen");
    return choose_law(rves, precision, [&]<class Law>(Instance<Law>) { return hold_on_cuda<Law>(rves); });
  }

 private:
  int number_;
  cudaDeviceProp properties_{};
};

}  // namespace

}  // namespace voussoir::kernels::device

extern "C" {

__attribute__((visibility("default"))) std::size_t voussoir_device_interface() {
  return voussoir::kernels::device::interface_number;
}

__attribute__((visibility("default"))) std::size_t voussoir_device_count(std::string* why) {
  int driver = 0, count = 0;
  const cudaError_t error = cudaGetDeviceCount(&count);
  if (error == cudaErrorInsufficientDriver && cudaDriverGetVersion(&driver) == cudaSuccess && driver == 0) {
    *why = "there is no NVIDIA driver";
    return 0;
  }
  if (error == cudaSuccess && count > 0) return static_cast<std::size_t>(count);
  *why = error == cudaSuccess ? "the driver knows no device" : cudaGetErrorString(error);
  return 0;
}

__attribute__((visibility("default"))) voussoir::kernels::device::Device* voussoir_device_open(std::size_t number,
                                                                                               std::string* why) {
  try {
    return new voussoir::kernels::device::CudaDevice(static_cast<int>(number));
  } catch (const std::exception& error) {
    *why = error.what();
    return nullptr;
  }
}
}
