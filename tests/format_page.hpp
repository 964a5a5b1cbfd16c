#pragma once
/// The tables of docs/reference/files.md, for tests that compare the page with the tables of the program.

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace voussoir {

/// What is said of a column or a field, by its name.
using Descriptions = std::map<std::string, std::string>;

inline std::vector<std::string> split(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end - begin));
    if (end == std::string::npos) return parts;
    begin = end + separator.size();
  }
}

/// "`a`" without its quotes.
inline std::string unquoted(const std::string& name) { return name.substr(1, name.size() - 2); }

/// The rows of the page's table with this head, cell by cell.
inline std::vector<std::vector<std::string>> rows_below(const std::string& head) {
  std::ostringstream page;
  page << std::ifstream(std::string(VOUSSOIR_SOURCE_DIR) + "/docs/reference/files.md").rdbuf();
  const std::string text = page.str();
  std::vector<std::vector<std::string>> rows;
  const std::size_t at = text.find(head);
  if (at == std::string::npos) return rows;
  std::istringstream lines(text.substr(at));
  std::string line;
  std::getline(lines, line);  // the head
  std::getline(lines, line);  // the line below it
  while (std::getline(lines, line) && line.starts_with("| ")) rows.push_back(split(line.substr(2), " | "));
  return rows;
}

/// A line for each name of which the page and the program do not say the same; empty where they agree.
inline std::string disagreements(const Descriptions& page, const Descriptions& program) {
  std::string lines;
  for (const auto& [name, said] : page) {
    const auto found = program.find(name);
    if (found == program.end()) lines.append(name).append(": docs/reference/files.md alone has it\n");
    if (found != program.end() && found->second != said)
      lines.append(name)
          .append(": docs/reference/files.md says ")
          .append(said)
          .append(", the program ")
          .append(found->second) += '\n';
  }
  for (const auto& [name, said] : program) {
    if (!page.contains(name))
      lines.append(name).append(": docs/reference/files.md lacks it, the program says ").append(said) += '\n';
  }
  return lines;
}

}  // namespace voussoir
