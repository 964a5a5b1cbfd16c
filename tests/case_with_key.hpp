#pragma once
/// Cases that give one key, for tests of the keys of case files.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "host/case/load_case.hpp"
#include "io/input_error.hpp"
#include "io/key_reference.hpp"

namespace voussoir::host {

/// A case of this kind in which the key has this value, and the line of the key.
inline std::pair<std::string, int> case_with(CaseKind kind, const std::string& key, const std::string& value) {
  const std::string table = io::parent_of(key), name = io::last_part(key);
  std::string text = name == "kind" ? "" : "kind = \"" + to_string(kind) + "\"\n";
  if (!table.empty())
    text += table.ends_with("[]") ? "[[" + table.substr(0, table.size() - 2) + "]]\n" : "[" + table + "]\n";
  if (table == "soil.class[]" && name != "size_to") text += "size_to = \"1 m\"\n";
  if (table == "probe.path[]" && name != "gradient") text += "gradient = [0, 0, 0, 0]\n";
  if (table == "calibrate" && name != "rolling_stiffness") text += "rolling_stiffness = [0.1, 0.2]\n";
  const auto line = 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  text += name + " = " + value + "\n";
  if (kind == CaseKind::calibrate && table != "calibrate") text += "[calibrate]\nrolling_stiffness = [0.1, 0.2]\n";
  return {text, line};
}

/// What load_case says of the text; empty where it takes the case.
inline std::string said_of(const std::string& text) {
  std::filesystem::remove("case.toml");  // a file written over is synced by some file systems, which takes longer than
                                         // all else
  std::ofstream("case.toml") << text;
  try {
    static_cast<void>(load_case("case.toml"));
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace voussoir::host
