/// What a user is told of values that do not fit together, and of keys that do not exist.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/case_file.hpp"
#include "tests/throws.hpp"

namespace voussoir::io {
namespace {

const Key depth{"depth", "A depth."};
const Key sizes{"sizes", "Some sizes."};

TEST(CaseMessages, AnEntryOutOfOrderIsNamedWithTheOneBeforeIt) {
  const CaseFile file = CaseFile::of_text("sizes = [\"1 mm\",\n\"2 cm\",\n\"3 mm\",\n\"3 mm\"]", "case.toml");
  const Table root = file.root();
  const std::vector<double> values = root.quantities(sizes, Dimension::length);
  expect_throws<InputError>([&] { root.expect_order("sizes", values, Order::ascending); },
                            "case.toml:3: sizes: must ascend, but entry 3 (3 mm) is not larger than entry 2 (2 cm)");
  expect_throws<InputError>([&] { root.expect_order("sizes", values, Order::not_falling); },
                            "case.toml:3: sizes: must not fall, but entry 3 (3 mm) is smaller than entry 2 (2 cm)");
}

TEST(CaseMessages, EqualEntriesDoNotFallAndDoNotAscend) {
  const CaseFile file = CaseFile::of_text("sizes = [\"3 mm\", \"0.3 cm\"]", "case.toml");
  const Table root = file.root();
  const std::vector<double> values = root.quantities(sizes, Dimension::length);
  EXPECT_NO_THROW(root.expect_order("sizes", values, Order::not_falling));
  expect_throws<InputError>([&] { root.expect_order("sizes", values, Order::ascending); },
                            "entry 2 (0.3 cm) is not larger than entry 1 (3 mm)");
}

TEST(CaseMessages, AKeyThatIsNotInTheFileIsNamedWithItsDefault) {
  const CaseFile file = CaseFile::of_text("[ground]\nwidth = \"3 m\"", "case.toml");
  const Table ground = file.root().table({"ground", "The ground."});
  static_cast<void>(ground.quantity({"width", "A width."}, Dimension::length));
  static_cast<void>(ground.quantity(depth, Dimension::length, {.fallback = "5 m"}));
  static_cast<void>(ground.quantities(sizes, Dimension::length, {}, std::vector<std::string>{}));
  const auto said = [&](const char* key) { return std::string(ground.error(key, "is wrong").what()); };
  EXPECT_EQ(said("depth"), "case.toml:1: ground.depth: is wrong; depth is not in the file, its default is 5 m");
  EXPECT_EQ(said("width"), "case.toml:2: ground.width: is wrong");
  EXPECT_EQ(said("sizes"), "case.toml:1: ground.sizes: is wrong");
  EXPECT_EQ(said("never_read"), "case.toml:1: ground.never_read: is wrong");
  EXPECT_EQ(said(""), "case.toml:1: ground: is wrong");
}

/// A file of which all keys have been read.
CaseFile all_keys() {
  CaseFile file = CaseFile::of_text(
      "[ground]\n[[class]]\nsize = \"1 m\"\n[[grid]]\n\"a.b\" = [1]\n[grid.soft]\nx = \"y=1\"", "all keys");
  static_cast<void>(
      file.root().table({"ground", "The ground."}).quantity(depth, Dimension::length, {.fallback = "5 m"}));
  for (const Table& entry : file.root().tables({"class", "A class."}))
    static_cast<void>(entry.quantity({"size", "A size."}, Dimension::length));
  for (const Table& grid : file.root().table_or_tables({"grid", "A grid."})) {
    static_cast<void>(grid.values_as_toml({"\"TABLE.KEY\"", "An axis."}, "a.b"));
    static_cast<void>(grid.named_table({"NAME", "A named axis."}, "soft").text_or_texts({"POINT", "A point."}, "x"));
  }
  return file;
}

TEST(CaseMessages, AnUnknownKeyIsFoundInAFileThatWasNotReadToItsEnd) {
  const CaseFile known = all_keys();
  const auto expect_unknown = [&known](const std::string& text, const std::string& said) {
    const CaseFile file = CaseFile::of_text(text, "case.toml");
    expect_throws<InputError>([&] { file.finish_as(known); }, said);
  };
  expect_unknown("[ground]\ndpeth = 3", "case.toml:2: ground.dpeth: unknown key; did you mean \"depth\"?");
  expect_unknown("gruond = 3", "case.toml:1: gruond: unknown key; did you mean \"ground\"?");
  expect_unknown("[[class]]\nsize = 3\n[[class]]\nsiez = 3",
                 "case.toml:4: class[1].siez: unknown key; did you mean \"size\"?");
  expect_unknown("weather = 3", "case.toml:1: weather: unknown key");
}

TEST(CaseMessages, KnownKeysAreNotReportedWhateverTheirValues) {
  const CaseFile known = all_keys();
  for (const char* text :
       {"[ground]\ndepth = [1, 2]", "ground = 3", "[[ground]]\nfurther = 3", "[class]\nsize = 3",
        "[grid]\n\"another.axis\" = [1]\n[grid.hard]\nz = [\"y=1\", \"x.toml\"]", "[[grid]]\n\"c.d\" = 1"}) {
    const CaseFile file = CaseFile::of_text(text, "case.toml");
    EXPECT_NO_THROW(file.finish_as(known)) << text;
  }
}

}  // namespace
}  // namespace voussoir::io
