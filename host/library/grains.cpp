// Packings of grains with the soil that they are made of, as files keep both.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "host/case/load_case.hpp"
#include "host/case/made_with.hpp"
#include "host/library/grain_batch.hpp"
#include "host/packing/stored_packing.hpp"
#include "io/hash.hpp"

namespace voussoir::library {
namespace {

std::string quoted(const std::string& text) { return fmt::format("\"{}\"", text); }

/// "[2 mm, 3 mm]" as TOML: the entries are quoted. Any other value is one text.
std::string toml_value(const std::string& text) {
  if (!text.starts_with('[') || !text.ends_with(']')) return quoted(text);
  std::string out;
  for (std::size_t at = 1; at + 1 < text.size();) {
    const std::size_t end = std::min(text.find(", ", at), text.size() - 1);
    out += (out.empty() ? "" : ", ") + quoted(text.substr(at, end - at));
    at = end + 2;
  }
  return "[" + out + "]";
}

/// A case of the kind `pack` with these keys "soil.modulus", "soil.class[0].friction", ... The classes come in their
/// order.
std::string case_with(const host::KeyTexts& soil) {
  std::string root = "kind = \"pack\"\n[soil]\n";
  std::map<int, std::string> classes;
  constexpr std::string_view prefix = "soil.", class_prefix = "soil.class[";
  for (const auto& [key, text] : soil) {
    if (!key.starts_with(class_prefix)) {
      root += fmt::format("{} = {}\n", key.substr(prefix.size()), toml_value(text));
      continue;
    }
    const int number = std::atoi(key.c_str() + class_prefix.size());
    classes[number] += fmt::format("{} = {}\n", key.substr(key.find("].") + 2), toml_value(text));
  }
  for (const auto& [number, keys] : classes) root += "[[soil.class]]\n" + keys;
  return root;
}

}  // namespace

Grains grains_of(const io::Packing& file) {
  const std::string disagreement = io::disagreement_of(file);
  if (!disagreement.empty()) throw std::invalid_argument("the packing: " + disagreement);
  const host::KeyTexts keys = host::soil_keys_of(file);
  if (keys.empty()) throw std::invalid_argument("the packing does not say which soil it was made with");
  const host::SoilCase soil = host::case_of_text(case_with(keys), "soil of the packing").soil;
  std::optional<host::PackedRve> rve = host::restored_packing(file, soil);
  if (!rve) {
    throw std::invalid_argument("no complete packing of this program and its contact law: " +
                                host::fault_of_state(file));
  }
  return {*std::move(rve), soil};
}

io::Packing file_of(const Grains& grains, const std::string& recipe) {
  return host::stored_packing(grains.rve, grains.soil, recipe, recipe.empty() ? "" : io::fingerprint_of(recipe));
}

}  // namespace voussoir::library
