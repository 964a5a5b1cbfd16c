// A Kokkos tool that counts regions and loops by their paths, "loop/region", one stack for the whole program.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace {

struct Open {
  std::string path;
  std::thread::id thread;
  bool loop;
};

struct Log {
  std::vector<Open> open;
  std::map<std::string, long> count;
  bool mixed = false;  // two threads' regions within one another
  bool unbalanced = false;

  void begin(const char* name, bool loop) {
    const std::thread::id thread = std::this_thread::get_id();
    if (!open.empty() && !open.back().loop) mixed = mixed || open.back().thread != thread;
    open.push_back({open.empty() ? name : open.back().path + "/" + name, thread, loop});
    ++count[open.back().path];
  }
  void end(bool loop) {
    if (open.empty() || open.back().loop != loop) {
      unbalanced = true;
      return;
    }
    mixed = mixed || open.back().thread != std::this_thread::get_id();
    open.pop_back();
  }
};

Log& all() {
  static Log log;
  return log;
}

}  // namespace

// The names and signatures are those of Kokkos' interface for tools.
extern "C" {
void kokkosp_init_library(int, std::uint64_t, std::uint32_t, void*) { all(); }
void kokkosp_push_profile_region(const char* name) { all().begin(name, false); }
void kokkosp_pop_profile_region() { all().end(false); }
void kokkosp_begin_parallel_for(const char* name, std::uint32_t, std::uint64_t*) { all().begin(name, true); }
void kokkosp_end_parallel_for(std::uint64_t) { all().end(true); }

void kokkosp_finalize_library() {
  const char* path = std::getenv("VOUSSOIR_REGION_LOG");
  std::FILE* file = path == nullptr ? nullptr : std::fopen(path, "w");
  if (file == nullptr) return;
  for (const auto& [name, n] : all().count) std::fprintf(file, "%s %ld\n", name.c_str(), n);
  if (all().mixed) std::fprintf(file, "mixed threads\n");
  if (all().unbalanced || !all().open.empty()) std::fprintf(file, "unbalanced\n");
  std::fclose(file);
}
}
