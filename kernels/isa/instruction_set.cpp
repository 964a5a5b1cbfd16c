#include "kernels/isa/instruction_set.hpp"

#include <array>
#include <cstring>

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace voussoir::kernels {

namespace {

#if defined(__x86_64__)
/// Whether a bit of a register of the processor's identification is set.
bool says(unsigned leaf, unsigned reg, unsigned bit) {
  std::array<unsigned, 4> r{};
  return __get_cpuid(leaf, &r[0], &r[1], &r[2], &r[3]) != 0 && ((r[reg] >> bit) & 1U) != 0;
}

/// The compiler's own questions also ask whether the operating system keeps the wide registers. clang 14 knows no names
/// for the last three features.
bool has_v3() {
  constexpr unsigned ecx = 2;
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
         __builtin_cpu_supports("bmi2") && says(0x80000001U, ecx, 5) &&  // lzcnt
         says(1, ecx, 22) && says(1, ecx, 29);                           // movbe, f16c
}

bool has_v4() {
  return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#endif

InstructionSet find_processor_set() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (has_v4()) return InstructionSet::v4;
  if (has_v3()) return InstructionSet::v3;
#endif
  return InstructionSet::scalar;
}

}  // namespace

const char* name_of(InstructionSet isa) {
  switch (isa) {
    case InstructionSet::v4:
      return "v4";
    case InstructionSet::v3:
      return "v3";
    case InstructionSet::scalar:
      break;
  }
  return "scalar";
}

const char* description_of(InstructionSet isa) {
  switch (isa) {
    case InstructionSet::v4:
      return "v4 (x86-64-v4, AVX-512)";
    case InstructionSet::v3:
      return "v3 (x86-64-v3, AVX2)";
    case InstructionSet::scalar:
      break;
  }
  return "scalar (one RVE at a time)";
}

InstructionSet processor_set() {
  static const InstructionSet found = find_processor_set();
  return found;
}

std::string processor_name() {
#if defined(__x86_64__)
  std::array<unsigned, 12> words{};
  for (unsigned k = 0; k < 3; ++k) {
    unsigned* const at = &words[4 * std::size_t{k}];
    if (__get_cpuid(0x80000002U + k, at, at + 1, at + 2, at + 3) == 0) return "unknown";
  }
  std::array<char, sizeof(words) + 1> text{};
  std::memcpy(text.data(), words.data(), sizeof(words));
  std::string name(text.data());
  const auto first = name.find_first_not_of(' ');
  if (first == std::string::npos) return "unknown";
  return name.substr(first, name.find_last_not_of(' ') + 1 - first);
#else
  return "unknown";
#endif
}

}  // namespace voussoir::kernels
