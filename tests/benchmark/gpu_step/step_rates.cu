/// Rates of lists and steps on a graphics card (README.md).
/// usage: step_rates [--rves 1,64,3344] [--steps 400] [--only TEXT] [--once] [--float | --double] PACKING...

#include <cstdlib>
#include <exception>

#include "tests/benchmark/gpu_step/rates.hpp"

namespace voussoir::gpu_step {
namespace {

using enum Gather;

/// Threads / blocks that a multiprocessor shall hold.
void list_lines(const Batch<float>& b, const Run& run) {
  list_line<float, 128, 8, 4>("list 128/4, 8 lanes", b, run);
  list_line<float, 128, 8, 8>("list 128/8, 8 lanes", b, run);
  list_line<float, 256, 1, 2>("list 256/2, 1 lane", b, run);
  list_line<float, 256, 4, 2>("list 256/2, 4 lanes", b, run);
  list_line<float, 256, 8, 2>("list 256/2, 8 lanes", b, run);
  list_line<float, 256, 4, 4>("list 256/4, 4 lanes", b, run);
  list_line<float, 256, 8, 4>("list 256/4, 8 lanes", b, run);
  list_line<float, 512, 4, 2>("list 512/2, 4 lanes", b, run);
  list_line<float, 512, 8, 2>("list 512/2, 8 lanes", b, run);
  list_line<float, 512, 16, 2>("list 512/2, 16 lanes", b, run);
}
void list_lines(const Batch<double>& b, const Run& run) { list_line<double, 256, 8, 4>("list 256/4, 8 lanes", b, run); }

/// Threads x pair slots x grain slots / blocks that a multiprocessor shall hold.
void step_lines(const Batch<float>& b, const Run& run) {
  if (b.grains() <= 384) {
    step_line<Instance<float, 128, 6, 3, 4, two_loops, true>>("128x6x3/4 as designed", b, run);
    step_line<Instance<float, 128, 6, 3, 6, one_list>>("128x6x3/6 list", b, run);
    step_line<Instance<float, 128, 6, 3, 4, in_registers>>("128x6x3/4 registers", b, run);
    step_line<Instance<float, 160, 5, 2, 4, in_registers>>("160x5x2/4 registers", b, run);
    step_line<Instance<float, 160, 5, 2, 4, in_registers, false, true, Look::peeled>>("160x5x2/4 registers, peeled", b,
                                                                                      run);
    step_line<Instance<float, 160, 5, 2, 4, in_registers, false, true, Look::called>>("160x5x2/4 registers, called", b,
                                                                                      run);
    evaluation_line<Instance<float, 160, 5, 2, 4, in_registers, false, true, Look::peeled>>(
        "evaluation, 160x5x2/4 registers", b, run);
  } else if (b.grains() <= 768) {
    step_line<Instance<float, 256, 7, 3, 2, two_loops, true>>("256x7x3/2 as designed", b, run);
    step_line<Instance<float, 512, 4, 2, 2, two_loops, true>>("512x4x2/2 as designed", b, run);
    step_line<Instance<float, 192, 9, 4, 3, one_list>>("192x9x4/3 list", b, run);
    step_line<Instance<float, 192, 9, 4, 3, one_list, false, true, Look::called>>("192x9x4/3 list, called", b, run);
    step_line<Instance<float, 256, 7, 3, 3, one_list>>("256x7x3/3 list", b, run);
    step_line<Instance<float, 256, 7, 3, 3, one_list, false, true, Look::peeled>>("256x7x3/3 list, peeled", b, run);
    step_line<Instance<float, 256, 7, 3, 3, one_list, false, true, Look::called>>("256x7x3/3 list, called", b, run);
    step_line<Instance<float, 256, 7, 3, 2, in_registers>>("256x7x3/2 registers", b, run);
    step_line<Instance<float, 256, 7, 3, 2, in_registers, false, true, Look::peeled>>("256x7x3/2 registers, peeled", b,
                                                                                      run);
    step_line<Instance<float, 256, 7, 3, 2, in_registers, false, true, Look::called>>("256x7x3/2 registers, called", b,
                                                                                      run);
    step_line<Instance<float, 256, 7, 3, 2, in_registers, false, false>>("256x7x3/2 registers, no rolling", b, run);
    step_line<Instance<float, 1024, 2, 1, 1, in_registers>>("1024x2x1/1 registers", b, run);
    evaluation_line<Instance<float, 256, 7, 3, 3, one_list, false, true, Look::peeled>>("evaluation, 256x7x3/3 list", b,
                                                                                        run);
    evaluation_line<Instance<float, 256, 7, 3, 2, in_registers, false, true, Look::peeled>>(
        "evaluation, 256x7x3/2 registers", b, run);
  } else {
    step_line<Instance<float, 512, 7, 3, 1, two_loops, true>>("512x7x3/1 as designed", b, run);
    step_line<Instance<float, 512, 7, 3, 2, one_list>>("512x7x3/2 list", b, run);
    step_line<Instance<float, 512, 7, 3, 2, one_list, false, true, Look::peeled>>("512x7x3/2 list, peeled", b, run);
    step_line<Instance<float, 512, 7, 3, 2, one_list, false, true, Look::called>>("512x7x3/2 list, called", b, run);
    evaluation_line<Instance<float, 512, 7, 3, 2, one_list, false, true, Look::peeled>>("evaluation, 512x7x3/2 list", b,
                                                                                        run);
  }
}

void step_lines(const Batch<double>& b, const Run& run) {
  if (b.grains() <= 384) {
    step_line<Instance<double, 128, 6, 3, 4, one_list>>("128x6x3/4 list", b, run);
  } else if (b.grains() <= 768) {
    step_line<Instance<double, 256, 7, 3, 2, one_list>>("256x7x3/2 list", b, run);
    step_line<Instance<double, 256, 7, 3, 2, one_list, false, true, Look::peeled>>("256x7x3/2 list, peeled", b, run);
    step_line<Instance<double, 256, 7, 3, 2, one_list, false, true, Look::called>>("256x7x3/2 list, called", b, run);
  }
}

std::vector<int> numbers(std::string text) {
  std::vector<int> result;
  for (std::size_t comma = 0; comma != std::string::npos; text = text.substr(comma + 1)) {
    comma = text.find(',');
    result.push_back(std::stoi(text.substr(0, comma)));
    if (comma == std::string::npos) break;
  }
  return result;
}

struct Options {
  Run run;
  std::vector<int> rves{1, 64, 264, 1056, 3344, 8192};
  bool in_float = true, in_double = true;
  std::vector<std::string> packings;
};

Options options(int argc, char** argv) {
  Options o;
  for (int k = 1; k < argc; ++k) {
    const std::string text = argv[k];
    const auto value = [&] {
      return k + 1 < argc ? std::string(argv[++k]) : throw std::runtime_error(text + " what?");
    };
    if (text == "--rves") {
      o.rves = numbers(value());
    } else if (text == "--steps") {
      o.run.steps = std::stoi(value());
    } else if (text == "--only") {
      o.run.only = value();
    } else if (text == "--once") {
      o.run.times = false;
    } else if (text == "--float") {
      o.in_double = false;
    } else if (text == "--double") {
      o.in_float = false;
    } else {
      o.packings.push_back(text);
    }
  }
  if (o.packings.empty()) throw std::runtime_error("which packing? (README.md)");
  return o;
}

template <class Real>
void table(const Rve& packing, int rves, const Run& run) {
  const Batch<Real> batch(packing, rves);
  list_lines(batch, run);
  step_lines(batch, run);
}

}  // namespace
}  // namespace voussoir::gpu_step

int main(int argc, char** argv) {
  using namespace voussoir::gpu_step;
  try {
    const Options o = options(argc, argv);
    cudaDeviceProp card{};
    check(cudaGetDeviceProperties(&card, 0));
    std::printf("%s, %d multiprocessors\n", card.name, card.multiProcessorCount);
    for (const std::string& name : o.packings) {
      const Rve packing = read_packing(name);
      for (const int rves : o.rves) {
        if (o.in_float) table<float>(packing, rves, o.run);
        if (o.in_double) table<double>(packing, rves, o.run);
      }
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "step_rates: %s\n", e.what());
    return 1;
  }
  return 0;
}
