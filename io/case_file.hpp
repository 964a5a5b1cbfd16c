#pragma once
/// Case files (TOML) with checked values. Every key that is read is noted, so that unknown keys are errors and the
/// resolved case, with its defaults and overrides, can be printed and stored.
///
///     CaseFile file = CaseFile::load("case.toml", {"mesh.size=0.5 m"});
///     Table ground = file.root().table({"ground", "The half domain of ground."});
///     double depth = ground.quantity({"depth", "Depth of the base below the surface."}, Dimension::length,
///                                    {.fallback = "35 m", .positive = true});
///     file.finish();  // unknown keys are reported here

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/input_error.hpp"
#include "io/key.hpp"
#include "io/key_info.hpp"
#include "io/units.hpp"

namespace voussoir::io {

/// Limits of a quantity, written like the user's own values ("1 kPa"); without a fallback the key is required. Lists of
/// keys show `default_words` in place of the fallback, where the default follows from other keys.
struct QuantityRule {
  std::optional<std::string> fallback = {};
  std::optional<std::string> at_least = {};
  std::optional<std::string> at_most = {};
  bool positive = false;
  std::string default_words = {};
};

struct IntegerRule {
  std::optional<std::int64_t> fallback = {};
  std::optional<std::int64_t> at_least = {};
  std::optional<std::int64_t> at_most = {};
  std::string default_words = {};
};

/// A text that the regular expression (ECMAScript) must match whole; `fault` completes "KEY: ..." where it does not.
struct TextRule {
  std::string pattern = {};
  std::string fault = {};
  std::string default_words = {};
};

inline constexpr std::size_t most_list_entries = 100'000;  ///< such a list of points or seeds is still read in a second

struct ListRule {
  std::size_t least = 0;
  std::size_t most = most_list_entries;
  bool different = false;  ///< no two entries are the same
  bool or_one = false;     ///< one value may stand in place of an array of one
};

/// A place in the plane: the name of a point, or two coordinates.
struct Place {
  std::string name = {};          ///< empty: `at` counts
  std::array<double, 2> at = {};  ///< [m]
};

/// What one table does not take over from another (Table::take_over).
struct TakeOverRule {
  /// Keys that exclude one another: where a table has one of a group, it takes none of the group over.
  std::vector<std::vector<std::string_view>> alternatives = {};
  std::vector<std::string_view> without = {};  ///< keys that are never taken over
};

/// The order that the entries of a list have to keep.
enum class Order { ascending, not_falling };

class CaseFile;
struct CaseNode;   // a key of the file, its place, and the value that was read from it
struct CaseState;  // the whole file

/// A view of one table of a case file; cheap to copy. A table that the file lacks reads as an empty one, so that
/// defaults apply and required keys are reported as missing. All reading functions throw InputError.
class Table {
 public:
  /// Whether the key stands in the file or was set on the command line. This does not count as reading the key.
  [[nodiscard]] bool has(std::string_view key) const;

  /// The SI value of a text such as "5 mm"; Dimension::none takes plain numbers and "%".
  [[nodiscard]] double quantity(const Key& key, Dimension dimension, const QuantityRule& rule = {}) const;
  /// A quantity that may be left out; the rule's fallback is not used.
  [[nodiscard]] std::optional<double> optional_quantity(const Key& key, Dimension dimension,
                                                        const QuantityRule& rule = {}) const;
  [[nodiscard]] std::int64_t integer(const Key& key, const IntegerRule& rule = {}) const;
  /// An integer that may be left out; the rule's fallback is not used.
  [[nodiscard]] std::optional<std::int64_t> optional_integer(const Key& key, const IntegerRule& rule = {}) const;
  [[nodiscard]] bool boolean(const Key& key, std::optional<bool> fallback = {}) const;
  [[nodiscard]] std::string text(const Key& key, const std::optional<std::string>& fallback = {},
                                 const TextRule& rule = {}) const;
  /// A text that may be left out.
  [[nodiscard]] std::optional<std::string> optional_text(const Key& key, const TextRule& rule = {}) const;
  /// A text that is one of `choices`; the message of an error lists them.
  [[nodiscard]] std::string choice(const Key& key, const std::vector<std::string>& choices,
                                   const std::optional<std::string>& fallback = {},
                                   const std::string& default_words = {}) const;
  /// An existing file that can be read, or none where the key is left out. The name is relative to the folder of the
  /// file that says it, with --set to that of the case file.
  [[nodiscard]] std::optional<std::filesystem::path> optional_path(const Key& key) const;
  /// The same for a key that names one file or has an array of names.
  [[nodiscard]] std::vector<std::filesystem::path> optional_paths(const Key& key) const;

  /// Reads arrays. The limits of the rule hold for each entry; the rule's fallback is not used. The rule of the list
  /// holds for what the user wrote.
  [[nodiscard]] std::vector<double> quantities(const Key& key, Dimension dimension, const QuantityRule& rule = {},
                                               const std::optional<std::vector<std::string>>& fallback = {},
                                               const ListRule& list = {}) const;
  [[nodiscard]] std::vector<std::int64_t> integers(const Key& key, const IntegerRule& rule = {},
                                                   const std::optional<std::vector<std::int64_t>>& fallback = {},
                                                   const ListRule& list = {}) const;
  [[nodiscard]] std::vector<std::string> texts(const Key& key,
                                               const std::optional<std::vector<std::string>>& fallback = {},
                                               const TextRule& rule = {}, const ListRule& list = {}) const;
  /// A place, written as the name of a point or as two lengths; none where the key is left out.
  [[nodiscard]] std::optional<Place> optional_place(const Key& key, const QuantityRule& rule = {}) const;
  /// An array of places; none where the key is left out.
  [[nodiscard]] std::vector<Place> places(const Key& key, const QuantityRule& rule = {},
                                          const ListRule& list = {}) const;
  /// Texts each of which is one of `choices`; none where the key is left out.
  [[nodiscard]] std::vector<std::string> chosen(const Key& key, const std::vector<std::string>& choices) const;

  [[nodiscard]] Table table(const Key& key) const;
  /// The [[key]] tables in the order of the file; empty where there are none.
  [[nodiscard]] std::vector<Table> tables(const Key& key) const;
  /// The same, where one [key] table may stand for an array of one.
  [[nodiscard]] std::vector<Table> table_or_tables(const Key& key) const;
  /// A table, or the tables of an array, that have been read before.
  [[nodiscard]] Table known_table(std::string_view key) const;
  [[nodiscard]] std::vector<Table> known_tables(std::string_view key) const;

  /// The files that this key of the table names, read as `extends` at the top of a file reads them; none where the key
  /// is left out. The key itself decides no result: what is taken over does.
  [[nodiscard]] std::optional<CaseFile> extended(const Key& key) const;
  /// Takes over the keys that `other` was given and this table was not, with their values and places, table by table.
  /// @param origin says where they come from in the resolved case; without it, the place does
  void take_over(const Table& other, const TakeOverRule& rule, const std::string& origin = {}) const;

  /// Declares that this key, which the program has read, does not count in this case: `reason` completes the sentence
  /// "KEY is not used: ...". The key may be a path ("relax_below", "class[0].modulus") or "" for the whole table. Only
  /// keys that the user wrote are reported (CaseFile::idle_keys).
  void declare_idle(std::string_view key, const std::string& reason) const;

  /// The names of the keys that the file holds in this table, in its order, for tables whose keys the user names.
  [[nodiscard]] std::vector<std::string> names() const;
  /// Keys whose names the user chooses: `name` is the one in the file, for which the name of `key` stands in lists of
  /// keys. values_as_toml: the entries of an array, or one value for an array of one, each as TOML, for values that are
  /// handed on as overrides. An entry is a number, a text, a boolean, or an array of these.
  [[nodiscard]] std::vector<std::string> values_as_toml(const Key& key, const std::string& name) const;
  [[nodiscard]] std::vector<std::string> text_or_texts(const Key& key, const std::string& name) const;
  [[nodiscard]] Table named_table(const Key& key, const std::string& name) const;
  /// An array of arrays of texts; none where the key is not written.
  [[nodiscard]] std::vector<std::vector<std::string>> lists_of_texts(const Key& key) const;
  [[nodiscard]] bool is_table(std::string_view key) const;  ///< whether the file holds a table under the key

  /// "sweep.toml:12", where the key stands; the table's own place where the file does not hold the key.
  [[nodiscard]] std::string place(std::string_view key) const;
  /// A value that has been read, as the user wrote it, or its default: "20 cm"; for messages.
  [[nodiscard]] std::string shown(std::string_view key) const;
  /// An entry of an array that has been read: "entry 3 (20 cm)"; `index` counts from 0, the user from 1.
  [[nodiscard]] std::string entry_shown(std::string_view key, std::size_t index) const;
  /// Throws InputError, which names both entries, where an entry of an array is not larger (Order::ascending) or is
  /// smaller (Order::not_falling) than the entry before it. `values` are what `quantities` has read.
  void expect_order(std::string_view key, std::span<const double> values, Order order) const;

  /// An error at this key's place in the file, for checks that need more than one value; with an empty key one of the
  /// table itself. Where the user has not written the key, the sentence says so, with the default that holds.
  [[nodiscard]] InputError error(std::string_view key, const std::string& sentence) const;
  /// The same at the place of an entry of an array, for a sentence that names the entry.
  [[nodiscard]] InputError entry_error(std::string_view key, std::size_t index, const std::string& sentence) const;

 private:
  friend class CaseFile;
  Table(std::shared_ptr<CaseState> state, CaseNode& node) : state_(std::move(state)), node_(&node) {}
  [[nodiscard]] CaseNode* find(std::string_view key) const;
  [[nodiscard]] CaseNode& take(std::string_view key, bool has_fallback) const;
  [[nodiscard]] CaseNode& take_named(const Key& key, const std::string& name) const;
  [[nodiscard]] std::string full_key(std::string_view key) const;

  std::shared_ptr<CaseState> state_;
  CaseNode* node_;
};

class CaseFile {
 public:
  /// Reads a TOML file; each override is "table.key=value" ("stage[0].steps=4" inside an array of tables). The value is
  /// TOML, or else taken as text, so that quotes may be left out: "mesh.size=0.5 m". A table in
  /// braces is joined with the table of the file.
  /// `extends = "other.toml"` (or an array of such names, relative to the file) takes over the keys of other files:
  /// a key of a file that is named later overrides that of an earlier one, and the file's own keys override all; an
  /// array is taken over or replaced as a whole.
  /// Throws InputError: no such file, bad TOML (with its line), bad override.
  [[nodiscard]] static CaseFile load(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});
  /// A case file that is given as text; `name` stands for the file in messages.
  [[nodiscard]] static CaseFile of_text(const std::string& text, const std::string& name);

  [[nodiscard]] Table root() const;

  /// Throws InputError for the first key that the program has not read, with the nearest known name as a hint.
  void finish() const;

  /// The same for a file whose reading has failed, so that not all keys have been read: a misspelt key is often why a
  /// value is missing or wrong. `known` is a file of which all keys of this sort have been read; the entries of its
  /// arrays of tables stand for all entries, and its keys whose names the user chooses stand for all names.
  void finish_as(const CaseFile& known) const;

  /// The place of each key of a written or read table ("case.toml:12", "--set"), for checks that know only the values.
  [[nodiscard]] std::map<std::string, std::string> places() const;

  /// All keys read so far, with type, default and limits, in the order in which they were read first, table by table.
  [[nodiscard]] std::vector<KeyInfo> keys() const;
  [[nodiscard]] std::vector<KeyInfo> tables() const;  ///< the same for tables
  /// One sentence for each reason of declare_idle that holds for keys which the user wrote: "newton.relax_near,
  /// newton.relax_attempts (case.toml:8): not used, because ...".
  [[nodiscard]] std::vector<std::string> idle_keys() const;

  /// All values read so far, as TOML in the units that a user writes; origins ("default", "--set") as comments.
  [[nodiscard]] std::string resolved() const;

  /// Hash (16 hex digits) of the values read so far, in SI to 12 digits, however they were written; without the tables
  /// or keys named in `without` (those that cannot change a result, such as the number of threads).
  [[nodiscard]] std::string fingerprint(std::span<const std::string> without = {}) const;

 private:
  friend class Table;
  explicit CaseFile(std::shared_ptr<CaseState> state) : state_(std::move(state)) {}
  std::shared_ptr<CaseState> state_;
};

}  // namespace voussoir::io
