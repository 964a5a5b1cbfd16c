#include "host/process/threads.hpp"

#include <omp.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <limits>
#include <type_traits>

namespace voussoir::host {
namespace {

/// A positive number, or such numbers with commas between them, of which the first counts (OpenMP: for the outermost
/// parallel regions). Nothing where the text is anything else.
std::optional<int> first_number(const std::string& text) {
  std::optional<int> first;
  const char* at = text.c_str();
  for (;;) {
    while (std::isspace(static_cast<unsigned char>(*at)) != 0) ++at;
    if (std::isdigit(static_cast<unsigned char>(*at)) == 0) return {};
    char* end = nullptr;
    const unsigned long long number = std::strtoull(at, &end, 10);
    if (number == 0) return {};
    constexpr int most = std::numeric_limits<int>::max();
    if (!first) first = number > static_cast<unsigned long long>(most) ? most : static_cast<int>(number);
    at = end;
    while (std::isspace(static_cast<unsigned char>(*at)) != 0) ++at;
    if (*at == 0) return first;
    if (*at++ != ',') return {};
  }
}

/// A variable's value for a line of the log: short and printable.
std::string printable(const char* value) {
  constexpr std::size_t most = 40;
  std::string text(value);
  if (text.size() > most) text = text.substr(0, most) + "...";
  for (char& c : text) {
    if (std::isprint(static_cast<unsigned char>(c)) == 0) c = '?';
  }
  return text;
}

/// What the variables say about other things than the number.
std::string binding(const Environment& environment) {
  std::string text;
  for (const char* name : {"OMP_PROC_BIND", "OMP_PLACES", "GOMP_CPU_AFFINITY"}) {
    if (const char* value = environment(name))
      text += fmt::format("; {}={} ties threads to cores", name, printable(value));
  }
  const char* dynamic = environment("OMP_DYNAMIC");
  if (dynamic != nullptr && (*dynamic == 't' || *dynamic == 'T' || *dynamic == '1'))
    text += fmt::format("; OMP_DYNAMIC={} is not obeyed", printable(dynamic));
  return text;
}

}  // namespace

ThreadChoice choose_threads(int asked, const Cores& cores, const ThreadLimits& limits, const Environment& environment) {
  std::string reason = "one for each core";
  std::string further;
  int count = cores.usable();
  if (asked > 0) {
    count = asked;
    reason = "--threads";
  } else {
    for (const char* name : {"KOKKOS_NUM_THREADS", "OMP_NUM_THREADS"}) {
      const char* value = environment(name);
      if (value == nullptr) continue;
      if (const std::optional<int> number = first_number(value)) {
        count = *number;
        reason = fmt::format("{}={}", name, printable(value));
        break;
      }
      further += fmt::format("; {}={} is no number of threads and is not used", name, printable(value));
    }
  }
  const int wanted = count;
  count = std::min({count, limits.pool, limits.openmp});
  if (count < wanted && limits.openmp == count) further += fmt::format("; OMP_THREAD_LIMIT allows only {}", count);
  if (count < wanted && limits.pool == count) further += fmt::format("; Kokkos' pool holds only {}", count);
  if (count > cores.usable()) further += "; the threads take turns on the cores, which is slower";
  return {count, fmt::format("threads: {} ({}); {}{}{}", count, reason, cores.text(), further, binding(environment))};
}

int most_threads() {
#ifdef KOKKOS_ENABLE_OPENMP
  if constexpr (std::is_same_v<Kokkos::DefaultHostExecutionSpace, Kokkos::OpenMP>)
    return Kokkos::Impl::OpenMPTraits::MAX_THREAD_COUNT;  // Kokkos itself does not look at it and writes beyond its
                                                          // array
#endif
  return 1;
}

KokkosSession::KokkosSession(int threads)
    : choice_(choose_threads(threads, cores_of_this_process(), {most_threads(), omp_get_thread_limit()},
                             [](const char* name) -> const char* { return std::getenv(name); })) {
  // The pool counts on the number of threads that it was started with, which OpenMP must not lower by itself.
  omp_set_dynamic(0);
  // Kokkos ends the process where one of its variables holds something else than it expects. The number of threads has
  // been read above. The variables about devices are left where there is one.
  for (const char* name :
       {"KOKKOS_NUM_THREADS", "KOKKOS_PRINT_CONFIGURATION", "KOKKOS_DISABLE_WARNINGS", "KOKKOS_TUNE_INTERNALS"})
    unsetenv(name);
  if constexpr (std::is_same_v<Kokkos::DefaultExecutionSpace, Kokkos::DefaultHostExecutionSpace>) {
    for (const char* name : {"KOKKOS_DEVICE_ID", "KOKKOS_MAP_DEVICE_ID_BY", "KOKKOS_VISIBLE_DEVICES"}) unsetenv(name);
  }
  Kokkos::InitializationSettings settings;
  settings.set_disable_warnings(true);
  settings.set_num_threads(choice_.count);
  kokkos_.emplace(settings);
  // CHOLMOD takes the same number.
  omp_set_num_threads(choice_.count);
}

}  // namespace voussoir::host
