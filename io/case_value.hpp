#pragma once
/// Reading of single values of a case file: a node, its rule, the value. Private to io. All functions throw InputError.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "io/case_file.hpp"
#include "io/case_node.hpp"

namespace voussoir::io {

[[noreturn]] void fail(const CaseNode& node, const std::string& sentence);
void expect(const CaseNode& node, CaseNode::Kind kind);

/// A default as TOML: without quotes where it is a plain number.
[[nodiscard]] std::string quantity_as_toml(const std::string& written);

/// Each reads one value and notes it in the node as TOML; `fallback` stands in for a node that the user did not write.
double read_quantity(CaseNode& node, Dimension dimension, const QuantityRule& rule,
                     const std::optional<std::string>& fallback);
std::int64_t read_integer(CaseNode& node, const IntegerRule& rule, const std::optional<std::int64_t>& fallback);
/// Control characters are refused: a text becomes a name of a file, or a part of a line of the log.
std::string read_text(CaseNode& node, const std::optional<std::string>& fallback);
std::string read_choice(CaseNode& node, const std::vector<std::string>& choices,
                        const std::optional<std::string>& fallback);
/// The name of a point, or an array of two lengths within the limits of the rule.
Place read_place(CaseNode& node, const QuantityRule& rule);
/// An existing file. A path that is written with --set is relative to `folder_of_case`.
std::filesystem::path read_path(CaseNode& node, const std::filesystem::path& folder_of_case);

/// The fallback of a key that the user did not write; Table::take has refused such a key where there is none.
template <class T>
const T& given(const std::optional<T>& fallback) {
  // NOLINTNEXTLINE(bugprone-unchecked-optional-access): value() itself checks, and throws.
  return fallback.value();
}

}  // namespace voussoir::io
