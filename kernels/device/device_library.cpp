#include "kernels/device/device_library.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace voussoir::kernels::device {

namespace {

constexpr const char* file_name = "libvoussoir_gpu.so";

/// The file that holds this code: the program, or a module in the program of an interpreter.
std::filesystem::path own_file() {
  Dl_info info{};
  if (::dladdr(static_cast<const void*>(&file_name), &info) != 0 && info.dli_fname != nullptr) {
    const std::filesystem::path file = info.dli_fname;
    if (file.extension() == ".so") return file;
  }
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error);
}

std::vector<std::filesystem::path> places() {
  if (const char* const given = std::getenv("VOUSSOIR_GPU_LIBRARY"); given != nullptr) return {given};
  const std::filesystem::path file = own_file();
  if (file.empty()) return {};
  const std::filesystem::path folder = file.parent_path(), above = folder / ".." / "..";
  return {folder / file_name, folder / ".." / "lib" / file_name, above / "cuda" / file_name,
          above / ".." / "cuda" / file_name};  // the last one: build/openmp/python/voussoir
}

/// An opened library. It stays open, because its devices need its code.
struct Library {
  std::string path, why;
  CountFunction count = nullptr;
  OpenFunction open = nullptr;
};

void take_functions(void* handle, Library& to) {
  const auto interface = reinterpret_cast<InterfaceFunction>(::dlsym(handle, interface_symbol));
  if (interface == nullptr || interface() != interface_number) {
    to.why = "the library " + to.path + " belongs to another version of the program";
    return;
  }
  to.count = reinterpret_cast<CountFunction>(::dlsym(handle, count_symbol));
  to.open = reinterpret_cast<OpenFunction>(::dlsym(handle, open_symbol));
  if (to.count == nullptr || to.open == nullptr) {
    to.why = "the library " + to.path + " lacks functions";
    to.count = nullptr;
    to.open = nullptr;
  }
}

Library open_library() {
  Library out;
  const std::vector<std::filesystem::path> tried = places();
  for (const std::filesystem::path& place : tried) {
    std::error_code error;
    if (!std::filesystem::exists(place, error)) continue;
    out.path = place.lexically_normal().string();
    if (void* const handle = ::dlopen(out.path.c_str(), RTLD_NOW | RTLD_LOCAL); handle != nullptr) {
      take_functions(handle, out);
    } else {
      out.why = std::string("the library cannot be opened: ") + ::dlerror();
    }
    return out;
  }
  out.why = "there is no " + (tried.empty() ? std::string(file_name) : tried.front().lexically_normal().string());
  return out;
}

const Library& library() {
  static const Library opened = open_library();
  return opened;
}

}  // namespace

DeviceSearch find_devices() {
  const Library& from = library();
  DeviceSearch out{.library = from.path, .names = {}, .why_none = from.why};
  if (from.count == nullptr) return out;
  const std::size_t count = from.count(&out.why_none);
  for (std::size_t k = 0; k < count; ++k) {
    std::string why;
    const std::unique_ptr<Device> device(from.open(k, &why));
    out.names.push_back(device ? device->name() : "cannot be used: " + why);
  }
  return out;
}

std::size_t count_devices(std::string& why) {
  const Library& from = library();
  why = from.why;
  return from.count == nullptr ? 0 : from.count(&why);
}

std::shared_ptr<Device> open_device(std::size_t number, std::string& why) {
  const Library& from = library();
  const std::size_t count = count_devices(why);
  if (count == 0) return nullptr;
  if (number >= count) {
    why = "there is no device of the number " + std::to_string(number);
    return nullptr;
  }
  return std::shared_ptr<Device>(from.open(number, &why));
}

}  // namespace voussoir::kernels::device
