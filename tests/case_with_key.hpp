#pragma once
/// Cases that give one key, for tests of the keys of case files.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "host/case/load_case.hpp"
#include "host/case/scene_samples.hpp"
#include "io/input_error.hpp"
#include "io/key_reference.hpp"

namespace voussoir::host {

/// The header of a table in a file.
inline std::string header_of(const std::string& table) {
  const std::string plain = std::regex_replace(table, std::regex(R"(\[\])"), "");
  return table.ends_with("[]") ? "[[" + plain + "]]\n" : "[" + plain + "]\n";
}

/// A scene in which the key has this value in place of its own, and the line of the key. The shape is the first whose
/// sample has the key.
inline std::pair<std::string, int> scene_with(const std::string& key, const std::string& value) {
  const std::string table = io::parent_of(key), name = io::last_part(key), header = header_of(table);
  std::string text = scene_samples().front();
  const auto has = [&](const std::string& line) {
    return [line](const std::string& sample) { return sample.find("\n" + line + " = ") != std::string::npos; };
  };
  if (table == "mesh") {
    const std::map<std::string, std::string> neighbours{
        {"interfaces", "width"}, {"ratio", "radius"}, {"part", "radius"}};
    const auto near = neighbours.find(name);
    const std::vector<std::string> samples = scene_samples();
    const auto found = std::find_if(samples.begin(), samples.end(),
                                    has(near == neighbours.end() ? name : near->second));
    if (found != samples.end()) text = *found;
  }
  const std::size_t own = text.find(header);
  if (own == std::string::npos && !table.empty()) {
    const std::size_t owner = text.find("\n[[support]]");  // behind the last region, to which its tables then belong
    const std::string needed = table == "soil.class[]" ? "size_to = \"1 m\"\n" : "";
    text.insert(table.starts_with("region") ? text.find("[[region]]\nname = \"elastic\"") : owner + 1, header + needed);
  }
  const std::size_t begin = table.empty() ? 0 : text.find(header) + header.size();
  const std::size_t end = std::min(text.find("\n[", begin), text.size());
  const std::size_t there = (begin == 0 ? std::string::npos : text.find("\n" + name + " = ", begin - 1));
  if (there < end) text.erase(there + 1, text.find('\n', there + 1) - there);
  text.insert(begin, name + " = " + value + "\n");
  if (name != "kind") text = "kind = \"scene\"\n" + text;
  const std::size_t place = text.find(name + " = " + value, name == "kind" ? 0 : begin);
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n');
  return {text, static_cast<int>(line)};
}

/// A case of this kind in which the key has this value, and the line of the key.
inline std::pair<std::string, int> case_with(CaseKind kind, const std::string& key, const std::string& value) {
  const std::string table = io::parent_of(key), name = io::last_part(key);
  if (kind == CaseKind::scene) return scene_with(key, value);
  std::string text = name == "kind" ? "" : "kind = \"" + to_string(kind) + "\"\n";
  if (!table.empty()) text += header_of(table);
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
