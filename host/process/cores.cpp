#include "host/process/cores.hpp"

#include <omp.h>
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

namespace voussoir::host {
namespace {

namespace fs = std::filesystem;

/// A mounted hierarchy of control groups: the folder `root` of the hierarchy is seen at `mount`.
struct Hierarchy {
  bool unified = false;  ///< version 2
  std::string root;
  std::string mount;
};

bool has_word(const std::string& list, const std::string& word) {
  std::istringstream words(list);
  for (std::string one; std::getline(words, one, ',');) {
    if (one == word) return true;
  }
  return false;
}

/// Mounted hierarchies that can limit the processor, from lines of mountinfo such as
/// "31 23 0:28 / /sys/fs/cgroup/cpu rw,relatime - cgroup cgroup rw,cpu".
std::vector<Hierarchy> hierarchies(const fs::path& root) {
  std::vector<Hierarchy> found;
  std::ifstream file(root / "proc/self/mountinfo");
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    std::string number, parent, device, type, source, options;
    Hierarchy one;
    fields >> number >> parent >> device >> one.root >> one.mount;
    for (std::string word; fields >> word && word != "-";) {
    }
    fields >> type >> source >> options;
    one.unified = type == "cgroup2";
    if (one.unified || (type == "cgroup" && has_word(options, "cpu"))) found.push_back(one);
  }
  return found;
}

/// Path of this process in a hierarchy, from lines of /proc/self/cgroup such as "4:cpu,cpuacct:/docker/ab12" and, for
/// version 2, "0::/user.slice".
std::optional<std::string> path_in(const Hierarchy& hierarchy, const fs::path& root) {
  std::ifstream file(root / "proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (hierarchy.unified ? controllers.empty() : has_word(controllers, "cpu")) return line.substr(second + 1);
  }
  return {};
}

/// The share that one group grants. A file that is missing or holds something else sets no limit.
std::optional<double> quota_of(const fs::path& group, bool unified) {
  std::string quota, period;
  if (unified) {
    std::ifstream(group / "cpu.max") >> quota >> period;
  } else {
    std::ifstream(group / "cpu.cfs_quota_us") >> quota;
    std::ifstream(group / "cpu.cfs_period_us") >> period;
  }
  char* end = nullptr;
  const double time = std::strtod(quota.c_str(), &end);
  if (quota.empty() || *end != 0) return {};  // "max"
  const double of = std::strtod(period.c_str(), &end);
  if (period.empty() || *end != 0 || !(time > 0) || !(of > 0) || !std::isfinite(time / of)) return {};
  return time / of;
}

}  // namespace

std::optional<double> cpu_quota(const fs::path& root) {
  std::optional<double> least;
  for (const Hierarchy& hierarchy : hierarchies(root)) {
    const std::optional<std::string> path = path_in(hierarchy, root);
    if (!path) continue;
    // A container may see only its own part of the hierarchy, while the path is that of the whole; and a path that does
    // not begin there ("/../other") belongs to a group above the container's, of which nothing is seen.
    fs::path below = *path;
    if (hierarchy.root != "/") below = fs::path(*path).lexically_relative(hierarchy.root);
    below = below.relative_path().lexically_normal();
    if (below.empty() || *below.begin() == "..") below = ".";
    const fs::path mount = root / fs::path(hierarchy.mount).relative_path();
    fs::path group = mount;
    auto look = [&] {
      const std::optional<double> here = quota_of(group, hierarchy.unified);
      if (here && (!least || *here < *least)) least = here;
    };
    look();
    for (const fs::path& part : below) {
      if (part == "." || part.empty()) continue;
      group /= part;
      look();
    }
  }
  return least;
}

Cores cores_of_this_process() {
  Cores cores;
  cores.machine = std::max(1, static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)));
  // OpenMP has read the affinity before it tied this thread to one place, where OMP_PROC_BIND asks for that.
  cores.allowed = std::max(1, omp_get_num_procs());
  cores.quota = cpu_quota();
  return cores;
}

int Cores::usable() const {
  if (!quota || *quota >= allowed) return allowed;
  return std::max(1, static_cast<int>(std::ceil(*quota)));
}

std::string Cores::text() const {
  std::string text = usable() == 1 ? std::string("1 core is available")
                                   : fmt::format("{} cores are available", usable());
  std::string why;
  if (allowed != machine) why += fmt::format(", the process may run on {}", allowed);
  if (quota && *quota < allowed) why += fmt::format(", its control group grants {:.3g}", *quota);
  if (!why.empty()) text += fmt::format(" (the machine has {}{})", machine, why);
  return text;
}

}  // namespace voussoir::host
