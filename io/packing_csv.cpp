/// Reads packings of other codes from NAME_particles.csv and NAME_meta.json.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/packing_file.hpp"
#include "io/packing_meta.hpp"
#include "io/text_file.hpp"

namespace voussoir::io {

namespace {

constexpr std::string_view header = "id,x_m,y_m,r_m,theta_z_rad";
constexpr std::string_view particles_ending = "_particles.csv";
constexpr std::string_view meta_ending = "_meta.json";
constexpr std::size_t most_bytes = 50'000'000;  ///< far more than the grains of one RVE need

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& sentence) {
  throw std::runtime_error(fmt::format("{}: {}", in_one_line(path.string()), sentence));
}

[[noreturn]] void fail_at(const std::filesystem::path& path, std::size_t line, const std::string& sentence) {
  fail(path, fmt::format("line {}: {}", line, sentence));
}

std::string text_of(const std::filesystem::path& path) {
  try {
    return read_text_file(path, most_bytes);
  } catch (const TextFileError& error) {
    if (error.line > 0) {
      fail_at(path, error.line, error.what());
    }
    fail(path, error.what());
  }
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t start = 0;;) {
    const std::size_t end = line.find(',', start);
    fields.push_back(trimmed(line.substr(start, end == std::string_view::npos ? end : end - start)));
    if (end == std::string_view::npos) {
      return fields;
    }
    start = end + 1;
  }
}

/// Refuses a first line that is not the header, with a hint at what the file has in its place.
void check_header(std::string_view line, const std::filesystem::path& path) {
  if (line == header) {
    return;
  }
  std::string hint;
  for (const auto& [separator, name] :
       {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}, std::pair{' ', "blanks"}}) {
    std::string other(header);
    for (char& c : other) {
      c = c == ',' ? separator : c;
    }
    if (line == other) {
      hint = fmt::format("; the columns are separated by {}, and must be separated by commas", name);
    }
  }
  if (line.find('"') != std::string_view::npos) {
    hint = "; the names must stand without quotes";
  }
  fail_at(path, 1, fmt::format("must be \"{}\", is \"{}\"{}", header, in_one_line(line, 80), hint));
}

constexpr std::array<std::string_view, 5> column_names{"id", "x_m", "y_m", "r_m", "theta_z_rad"};

/// A finite number that fills the whole field.
double parse_number(std::string_view field, std::size_t column, const std::filesystem::path& path, std::size_t line) {
  const std::string_view digits = field.starts_with('+') ? field.substr(1) : field;
  double value = 0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (failure != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value)) {
    fail_at(path, line,
            fmt::format("{} must be a finite number, is \"{}\"", column_names.at(column), in_one_line(field, 80)));
  }
  return value;
}

/// Reads the five numbers of a line.
std::array<double, 5> parse_row(std::string_view text, const std::filesystem::path& path, std::size_t line) {
  const std::vector<std::string_view> fields = split(text);
  std::array<double, 5> row{};
  if (fields.size() != row.size()) {
    const bool other = fields.size() == 1 && text.find_first_of(";\t ") != std::string_view::npos;
    fail_at(path, line,
            fmt::format("must be five numbers ({}), has {} field{}{}", header, fields.size(),
                        fields.size() == 1 ? "" : "s", other ? "; the columns must be separated by commas" : ""));
  }
  for (std::size_t k = 0; k < row.size(); ++k) {
    row[k] = parse_number(fields[k], k, path, line);
  }
  return row;
}

void add_grain(std::string_view text, const std::filesystem::path& path, std::size_t line,
               std::map<double, std::size_t>& line_of_id, Packing& packing) {
  const auto [id, x, y, radius, rotation] = parse_row(text, path, line);
  if (!(radius > 0)) {
    fail_at(path, line, fmt::format("radius must be positive, is {}", radius));
  }
  if (!(id >= 0) || id != std::floor(id) || id > 1e15) {
    fail_at(path, line, fmt::format("id must be an integer of at least 0, is {}", id));
  }
  const auto [known, is_new] = line_of_id.try_emplace(id, line);
  if (!is_new) {
    fail_at(path, line, fmt::format("has the id {} that line {} has already", id, known->second));
  }
  packing.x.push_back(x);
  packing.y.push_back(y);
  packing.radius.push_back(radius);
  packing.rotation.push_back(rotation);
}

void read_particles(const std::filesystem::path& path, Packing& packing) {
  const std::string text = text_of(path);
  if (text.find('\n') == std::string::npos && text.find('\r') != std::string::npos) {
    fail(path, "has lines that end with CR alone; they must end with LF or CR LF");
  }
  std::map<double, std::size_t> line_of_id;
  std::size_t number = 0;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    std::string_view line = std::string_view(text).substr(start, end - start);
    start = end + 1;
    line = line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
    if (++number == 1) {
      check_header(line, path);
    } else if (!trimmed(line).empty()) {
      add_grain(line, path, number, line_of_id, packing);
    }
  }
  if (packing.radius.empty()) {
    fail(path, "has no grains");
  }
}

}  // namespace

Packing load_packing_csv(const std::filesystem::path& path) {
  std::string stem = path.string();
  for (const auto ending : {particles_ending, meta_ending}) {
    if (stem.ends_with(ending)) {
      stem.resize(stem.size() - ending.size());
      Packing packing;
      read_particles(fmt::format("{}{}", stem, particles_ending), packing);
      const std::filesystem::path meta = fmt::format("{}{}", stem, meta_ending);
      const std::string fault = take_packing_meta(text_of(meta), packing);
      if (!fault.empty()) {
        fail(meta, fault);
      }
      return packing;
    }
  }
  fail(path, "must be named NAME_particles.csv or NAME_meta.json");
}

}  // namespace voussoir::io
