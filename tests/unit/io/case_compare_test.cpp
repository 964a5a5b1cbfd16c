// Two resolved cases are compared key by key, by what their values mean; keys that do not count are said.
#include "io/case_compare.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "io/case_file.hpp"
#include "tests/throws.hpp"

namespace voussoir::io {
namespace {

TEST(CaseCompare, EqualQuantitiesAreEqualHoweverTheyAreWritten) {
  EXPECT_TRUE(same_value("5 mm", "0.005 m"));
  EXPECT_TRUE(same_value("20 %", "0.2"));
  EXPECT_TRUE(same_value("[1 kPa, 2 kPa]", "[1000 Pa, 2 kPa]"));
  EXPECT_FALSE(same_value("3 GPa", "300 MPa"));
  EXPECT_FALSE(same_value("3 GPa", "3 m"));
  EXPECT_FALSE(same_value("[1 kPa]", "[1 kPa, 2 kPa]"));
  EXPECT_FALSE(same_value("float", "double"));
}

TEST(CaseCompare, DifferencesNameTheKeyAndBothValues) {
  const std::string ours =
      "kind = \"tunnel\"\n[soil]\nmodulus = \"300 MPa\"\ndamping = 0.3\n[[soil.class]]\nsize_to = \"5 mm\"\n"
      "[output]\nevery = 2\n";
  const std::string theirs =
      "kind = \"tunnel\"\n[soil]\nmodulus = \"3 GPa\"\ndamping = 0.30\nold = 1\n[[soil.class]]\n"
      "size_to = \"6 mm\"\n[output]\nevery = 1\n";
  const std::array<std::string, 1> without{"output"};
  const auto found = differences(ours, theirs, without);
  ASSERT_EQ(found.size(), 3U);
  const std::string text = describe(found, "the run");
  for (const char* part : {"soil.modulus: this case has 300 MPa, the run was made with 3 GPa",
                           "soil.class[0].size_to: this case has 5 mm, the run was made with 6 mm",
                           "soil.old: this case has nothing, the run was made with 1"}) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  }
  EXPECT_TRUE(differences(ours, ours).empty());
  EXPECT_EQ(differences(ours, theirs).size(), 4U);
  expect_throws<std::runtime_error>([&] { static_cast<void>(differences(ours, "no = ")); }, "no TOML");
}

TEST(CaseCompare, IdleKeysAreSaidOnceForAReason) {
  const auto path = std::filesystem::current_path() / "idle.toml";
  std::ofstream(path) << "[newton]\nnear = 0.1\nattempts = 3\n[soil]\nmodulus = \"1 GPa\"\nsizes = [1, 2]\n";
  const CaseFile file = CaseFile::load(path);
  const Table newton = file.root().table({"newton", "A table."}), soil = file.root().table({"soil", "A table."});
  for (const Key& key : {Key{"near", "A key."}, Key{"attempts", "A key."}, Key{"left_out", "A key."}})
    static_cast<void>(newton.quantity(key, Dimension::none, {.fallback = "1"}));
  static_cast<void>(soil.quantity({"modulus", "A key."}, Dimension::pressure));
  static_cast<void>(soil.quantities({"sizes", "A key."}, Dimension::none));
  EXPECT_TRUE(file.idle_keys().empty());
  for (const char* key : {"near", "attempts", "left_out"}) newton.declare_idle(key, "nothing is relaxed");
  soil.declare_idle("", "there are no grains");
  newton.declare_idle("near", "a later reason does not count");
  const auto lines = file.idle_keys();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_NE(lines[0].find("newton.near, newton.attempts ("), std::string::npos) << lines[0];
  EXPECT_NE(lines[0].find("idle.toml:2): not used, because nothing is relaxed"), std::string::npos) << lines[0];
  EXPECT_NE(lines[1].find("soil.modulus, soil.sizes ("), std::string::npos) << lines[1];
  expect_throws<std::logic_error>([&] { newton.declare_idle("never_read", "of a slip"); }, "was never read");
}

}  // namespace
}  // namespace voussoir::io
