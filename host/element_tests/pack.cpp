#include "host/element_tests/pack.hpp"

#include <cstdio>

#include "host/packing/packings.hpp"
#include "host/record/remarks.hpp"

namespace voussoir::host {

Outcome run_pack(const Case& input) {
  say_remarks(input);
  const PackingNote print = [](const std::string& line) { std::printf("%s\n", line.c_str()); };
  const std::vector<std::int64_t> seeds = seeds_of(input.packing);
  const std::size_t made = obtain_packings(input.soil, input.packing, seeds, print).size();
  if (made == seeds.size() || !input.packing.files.empty()) return Outcome::done;
  std::fprintf(stderr, "pack: %zu of %zu packings do not come to rest or are refused (see above), and are not stored\n",
               seeds.size() - made, seeds.size());
  return Outcome::no_equilibrium;
}

}  // namespace voussoir::host
