/// Every key of every kind of case at both ends of its limits, one step outside, and with values of wrong forms. What
/// there is to try comes from `keys_of`, so that a new key needs no line here.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "host/case/load_case.hpp"
#include "tests/case_with_key.hpp"

namespace voussoir::host {
namespace {

using io::KeyInfo;
using io::KeyType;

/// Whether a message names the line of the key and the key, in whichever entry of its table.
bool names_key(const std::string& said, int line, const KeyInfo& key) {
  const std::string begin = fmt::format("case.toml:{}: {}", line, key.key);
  const std::string head = said.substr(0, begin.size() + 9);
  return std::regex_replace(head, std::regex(R"(\[[0-9]\])"), "[]").starts_with(begin);
}

std::string as_value(const KeyInfo& key, const std::string& written) {
  const std::string value = key.type == KeyType::quantity && key.dimension != io::Dimension::none
                                ? "\"" + written + "\""
                                : written;
  return key.list ? "[" + value + "]" : value;
}

std::string outside(const KeyInfo& key, const std::string& limit, int direction) {
  if (key.type == KeyType::integer) return std::to_string(std::stoll(limit) + direction);
  const std::size_t space = limit.find(' ');
  const double number = std::stod(limit.substr(0, space));
  const double next = number + direction * 1e-9 * (number == 0 ? 1.0 : std::abs(number));
  return fmt::format("{}{}", next, space == std::string::npos ? "" : limit.substr(space));
}

void expect_limit(CaseKind kind, const KeyInfo& key, const std::string& limit, bool upper) {
  SCOPED_TRACE(to_string(kind) + ": " + key.key + " at " + limit);
  ASSERT_FALSE(limit.empty()) << "a number without limits may be one that no run can use";
  const std::string at = said_of(case_with(kind, key.key, as_value(key, limit)).first);
  // Relations to other keys may forbid the limit here; key_limits_long_test.py tries it with other values beside it.
  EXPECT_EQ(at.find("must be at "), std::string::npos) << at;
  const auto [text, line] = case_with(kind, key.key, as_value(key, outside(key, limit, upper ? 1 : -1)));
  const std::string said = said_of(text);
  EXPECT_TRUE(names_key(said, line, key)) << said;
  EXPECT_NE(said.find(fmt::format("must be at {} {}, is ", upper ? "most" : "least", limit)), std::string::npos)
      << said;
}

/// Values that no key of this type takes.
std::vector<std::string> wrong_forms(const KeyInfo& key) {
  std::vector<std::string> forms{"nan", "inf", "-inf", "{}", "{a = 1}", "1979-05-27", "[[[1]]]"};
  const std::string unit(key.dimension == io::Dimension::none ? "" : io::si_unit(key.dimension));
  const auto add = [&](std::initializer_list<const char*> more) {
    forms.insert(forms.end(), more.begin(), more.end());
  };
  switch (key.type) {
    case KeyType::quantity:
      add({"true", R"("")", R"(" ")", R"("x")", R"("1 parsec")", R"("1,5")", R"("1e400")", R"("1e-400")", R"("1 2")"});
      forms.push_back(key.dimension == io::Dimension::length ? R"("1 GPa")" : R"("1 mm")");
      for (const char* number : {"nan", "inf", "1e400", "0x10", "1,5", "--1"})
        forms.push_back(fmt::format(R"("{} {}")", number, unit));
      if (!unit.empty()) add({"1", "1.5"});
      break;
    case KeyType::integer:
      add({"true", R"("1")", "1.0", "1e3", "0.5", "-9223372036854775808", "9223372036854775807"});
      break;
    case KeyType::boolean:
      add({"0", "1", R"("true")", R"("")"});
      break;
    case KeyType::text:
    case KeyType::choice:
    case KeyType::path:
      add({"1", "1.5", "true", R"("a\nb")", R"("a\u0000b")", R"("\u001b[31m")"});
      forms.push_back("\"" + std::string(3000, 'x') + "\"");
      if (key.type == KeyType::choice) add({R"("")", R"("no_such_choice")", R"("Ω")"});
      if (key.type == KeyType::path) add({R"("")", R"("no_such_file")", R"(".")", R"("/dev/null")"});
      break;
    case KeyType::place:
      add({"1", "true", R"("")", R"(["1 m"])", R"(["1 m", "2 m", "3 m"])", R"([1, 2])", R"(["1 Pa", "1 m"])"});
      break;
    case KeyType::list_of_text:
      return {"1", "true", R"("x")", "[]", "[[]]", R"(["x"])", "[[1]]", R"([["x"], 1])", "{}", "nan"};
    case KeyType::value:
    case KeyType::table:
      ADD_FAILURE() << key.key << " is of a type that no case has";
      break;
  }
  for (std::string& form : forms) form = key.list ? std::string("[").append(form).append("]") : form;
  if (key.list) forms.insert(forms.end(), {"true", "{}"});
  if (key.list && (!key.or_one || key.type == KeyType::path)) forms.insert(forms.end(), {"1", R"("x")"});
  if (!key.list) forms.emplace_back("[1]");
  return forms;
}

constexpr std::array kinds{CaseKind::pack,      CaseKind::probe,  CaseKind::biaxial, CaseKind::biaxial_bvp,
                           CaseKind::calibrate, CaseKind::column, CaseKind::tunnel,  CaseKind::scene};

TEST(KeyLimits, EveryNumberHasBothAndIsRefusedOneStepOutside) {
  std::set<std::string> tried;
  for (const CaseKind kind : kinds) {
    for (const KeyInfo& key : keys_of(kind).keys) {
      if (key.type != KeyType::quantity && key.type != KeyType::integer) continue;
      // The reader of a key that a scene shares with other kinds, or a region with a scene, is the same.
      if ((!tried.insert(key.key).second && kind == CaseKind::scene) || !key.like.empty()) continue;
      expect_limit(kind, key, key.at_least, false);
      expect_limit(kind, key, key.at_most, true);
    }
  }
}

TEST(KeyLimits, ValuesOfWrongFormsAreRefusedAtTheirPlace) {
  std::set<std::string> tried;
  for (const CaseKind kind : kinds) {
    for (const KeyInfo& key : keys_of(kind).keys) {
      if (!tried.insert(key.key).second || !key.like.empty()) continue;
      for (const std::string& form : wrong_forms(key)) {
        const auto [text, line] = case_with(kind, key.key, form);
        const std::string said = said_of(text);
        EXPECT_TRUE(names_key(said, line, key)) << key.key << " = " << form.substr(0, 80) << ": \"" << said << "\"";
        EXPECT_LT(said.size(), 500U);
        EXPECT_EQ(said.find_first_of("\n\x1b"), std::string::npos) << said;
      }
    }
  }
}

TEST(KeyLimits, KeysAreThoseOfTheReaders) {
  const std::vector<KeyInfo> keys = keys_of(CaseKind::tunnel).keys;
  const auto named = [&](const char* name) {
    return *std::find_if(keys.begin(), keys.end(), [&](const KeyInfo& key) { return key.key == name; });
  };
  EXPECT_EQ(named("soil.class[].friction").at_most, "80 deg");
  EXPECT_EQ(named("volume_loss.increments").fallback, "80");
  EXPECT_EQ(named("packing.file").type, KeyType::path);
  EXPECT_FALSE(named("packing.file").required);
  EXPECT_TRUE(named("kind").required);
  EXPECT_EQ(named("material").choices, (std::vector<std::string>{"grains", "linear_elastic"}));
}

}  // namespace
}  // namespace voussoir::host
