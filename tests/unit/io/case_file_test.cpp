/// Case files: what is read, and the one line that each kind of mistake gives.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "io/case_file.hpp"
#include "tests/throws.hpp"

namespace voussoir::io {
namespace {

const std::string valid = R"(kind = "tunnel"
steps = 4
[soil]
radius = "5 mm"       # line 4
weight = "20 kN/m3"
friction = 0.5
kept = true
shape = "disc"
[[stage]]
name = "gravity"
targets = ["5 %", 0.1]
[[stage]]
name = "loss"
seeds = [1, 2]
)";

std::filesystem::path write(const std::string& text) {
  const auto path = std::filesystem::current_path() / "case.toml";
  std::ofstream(path) << text;
  return path;
}

/// Reads every key of `valid`, as a host would.
void read_all(const CaseFile& file) {
  const Table root = file.root();
  static_cast<void>(root.choice({"kind", "A key."}, {"tunnel", "pack"}));
  static_cast<void>(root.integer({"steps", "A key."}, {.at_least = 1}));
  const Table soil = root.table({"soil", "A table."});
  static_cast<void>(soil.quantity({"radius", "A key."}, Dimension::length, {.positive = true}));
  static_cast<void>(
      soil.quantity({"weight", "A key."}, Dimension::unit_weight, {.at_least = "0 N/m3", .at_most = "30 kN/m3"}));
  static_cast<void>(soil.quantity({"friction", "A key."}, Dimension::none));
  static_cast<void>(soil.boolean({"kept", "A key."}));
  static_cast<void>(soil.text({"shape", "A key."}));
  static_cast<void>(soil.quantity({"thickness", "A key."}, Dimension::length, {.fallback = "0.1 m"}));
  for (const Table& stage : root.tables({"stage", "A table."})) {
    static_cast<void>(stage.text({"name", "A key."}));
    static_cast<void>(
        stage.quantities({"targets", "A key."}, Dimension::none, {.positive = true}, std::vector<std::string>{"1 %"}));
    static_cast<void>(stage.integers({"seeds", "A key."}, {.at_least = 1}, std::vector<std::int64_t>{7}));
  }
  file.finish();
}

/// The error's line with the folder cut off, or "no error".
std::string message(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read_all(CaseFile::load(write(text), overrides));
  } catch (const InputError& error) {
    const std::string line = error.what();
    const std::string folder = (std::filesystem::current_path() / "").string();
    const auto at = line.find(folder);
    return at == std::string::npos ? line : std::string(line).erase(at, folder.size());
  }
  return "no error";
}

std::string changed(const std::string& from, const std::string& to) {
  std::string text = valid;
  return text.replace(text.find(from), from.size(), to);
}

TEST(CaseFile, ValuesAreSi) {
  const CaseFile file = CaseFile::load(write(valid));
  read_all(file);
  const Table soil = file.root().table({"soil", "A table."});
  EXPECT_EQ(soil.quantity({"radius", "A key."}, Dimension::length), 0.005);
  EXPECT_EQ(soil.quantity({"weight", "A key."}, Dimension::unit_weight), 2e4);
  EXPECT_EQ(soil.quantity({"thickness", "A key."}, Dimension::length, {.fallback = "0.1 m"}), 0.1);
  EXPECT_EQ(file.root().tables({"stage", "A table."}).at(0).quantities({"targets", "A key."}, Dimension::none),
            (std::vector<double>{0.05, 0.1}));
  EXPECT_EQ(file.root().tables({"stage", "A table."}).at(1).integers({"seeds", "A key."}),
            (std::vector<std::int64_t>{1, 2}));
  EXPECT_FALSE(soil.has("thickness"));
}

TEST(CaseFile, EachMistakeGivesOneLineWithItsPlace) {
  EXPECT_EQ(message(valid), "no error");
  EXPECT_EQ(message(changed("radius", "raduis")), "case.toml:3: soil.radius: is missing");
  EXPECT_EQ(message(changed("kept = true", "kept = true\nfrictoin = 1")),
            "case.toml:8: soil.frictoin: unknown key; did you mean \"friction\"?");
  EXPECT_EQ(message(changed("[soil]", "radius = 1\n[soil]")),
            "case.toml:3: radius: unknown key; did you mean \"soil.radius\"?");
  EXPECT_EQ(message(changed("\"5 mm\"", "\"-5 mm\"")), "case.toml:4: soil.radius: must be positive, is -5 mm");
  EXPECT_EQ(message(changed("\"5 mm\"", "\"5 kPa\"")),
            "case.toml:4: soil.radius: \"5 kPa\" is a pressure, expected length in m, cm, mm, km, um");
  EXPECT_EQ(message(changed("\"5 mm\"", "5")),
            "case.toml:4: soil.radius: \"5\" has no unit, expected length in m, cm, mm, km, um");
  EXPECT_EQ(message(changed("\"5 mm\"", "true")),
            "case.toml:4: soil.radius: must be a quantity in quotes, such as \"1 m\", is true or false");
  EXPECT_EQ(message(changed("20 kN", "31 kN")), "case.toml:5: soil.weight: must be at most 30 kN/m3, is 31 kN/m3");
  EXPECT_EQ(message(changed("20 kN", "-1 kN")), "case.toml:5: soil.weight: must be at least 0 N/m3, is -1 kN/m3");
  EXPECT_EQ(message(changed("0.5", "nan")), "case.toml:6: soil.friction: \"nan\" is not finite");
  EXPECT_EQ(message(changed("true", "1")), "case.toml:7: soil.kept: must be true or false, is an integer");
  EXPECT_EQ(message(changed("4\n", "4.5\n")), "case.toml:2: steps: must be an integer, is a number");
  EXPECT_EQ(message(changed("4\n", "0\n")), "case.toml:2: steps: must be at least 1, is 0");
  EXPECT_EQ(message(changed("\"tunnel\"", "\"tunel\"")), "case.toml:1: kind: must be one of tunnel, pack, is tunel");
  EXPECT_EQ(message(changed("[1, 2]", "[1, -2]")), "case.toml:14: stage[1].seeds[1]: must be at least 1, is -2");
  EXPECT_EQ(message(changed("[soil]", "[sand]")), "case.toml:1: soil.radius: is missing");
  EXPECT_EQ(message("stage = 3\n" + valid.substr(0, valid.find("[[stage]]"))),
            "case.toml:1: stage: must be an array, is an integer");
}

TEST(CaseFile, BadTomlNamesItsLine) {
  EXPECT_TRUE(message(changed("weight = \"20 kN/m3\"", "weight = 20 kN/m3")).starts_with("case.toml:5: "))
      << message(changed("weight = \"20 kN/m3\"", "weight = 20 kN/m3"));
  const std::string open_quote = message(changed("radius = \"5 mm\"", "radius = \"5 mm"));
  EXPECT_TRUE(open_quote.starts_with("case.toml:4: ")) << open_quote;
  EXPECT_EQ(open_quote.find('\n'), std::string::npos) << open_quote;
}

TEST(CaseFile, MissingFilesAreErrors) {
  expect_throws<InputError>([&] { static_cast<void>(CaseFile::load("no/such/case.toml")); },
                            "no/such/case.toml: cannot be read");
  expect_throws<InputError>([&] { static_cast<void>(CaseFile::load(std::filesystem::current_path())); },
                            ": cannot be read");
  const auto path = write("packing = \"none.h5\"\nself = \"case.toml\"\n");
  const CaseFile file = CaseFile::load(path);
  EXPECT_EQ(file.root().optional_path({"self", "A key."}), path);
  try {
    static_cast<void>(file.root().optional_path({"packing", "A key."}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              path.string() + ":1: packing: " + (path.parent_path() / "none.h5").string() + " does not exist");
  }
}

TEST(CaseFile, OverridesReplaceAddAndAreChecked) {
  const CaseFile file = CaseFile::load(write(valid), {"soil.radius=7 mm", "steps=9", "soil.thickness=0.2 m",
                                                      "stage[1].name=late", "stage[0].targets=[1, \"2 %\"]"});
  read_all(file);
  EXPECT_EQ(file.root().table({"soil", "A table."}).quantity({"radius", "A key."}, Dimension::length), 0.007);
  EXPECT_EQ(file.root().integer({"steps", "A key."}), 9);
  EXPECT_EQ(file.root().table({"soil", "A table."}).quantity({"thickness", "A key."}, Dimension::length), 0.2);
  EXPECT_EQ(file.root().tables({"stage", "A table."}).at(1).text({"name", "A key."}), "late");
  EXPECT_EQ(file.root().tables({"stage", "A table."}).at(0).quantities({"targets", "A key."}, Dimension::none),
            (std::vector<double>{1, 0.02}));

  EXPECT_EQ(message(valid, {"soil.radius=-7 mm"}), "--set soil.radius: must be positive, is -7 mm");
  EXPECT_EQ(message(valid, {"soil.radios=7 mm"}), "--set soil.radios: unknown key; did you mean \"radius\"?");
  EXPECT_EQ(message(valid, {"water.depth=7 m"}), "--set water: unknown key");
  EXPECT_EQ(message(valid, {"stage[2].name=x"}), "--set stage: has no entry [2]");
  EXPECT_EQ(message(valid, {"steps"}), "--set: \"steps\" is not of the form table.key=value");
  EXPECT_EQ(message(valid, {"=3"}), "--set: \"=3\" is not of the form table.key=value");
  EXPECT_EQ(message(valid, {"soil..radius=3"}), "--set: \"soil..radius=3\" is not of the form table.key=value");
}

TEST(CaseFile, ExtendedFilesAreTakenOverKeyByKey) {
  const auto here = std::filesystem::current_path();
  std::filesystem::create_directories(here / "extended");
  std::ofstream(here / "extended" / "whole.toml") << valid;
  std::ofstream(here / "extended" / "soil.toml") << "[soil]\nfriction = 0.7\nkept = false\n";
  const auto load = [&](const std::string& text) { return CaseFile::load(write(text)); };

  const CaseFile file = load(R"(extends = ["extended/whole.toml", "extended/soil.toml"]
[soil]
kept = true
[[stage]]
name = "only"
)");
  read_all(file);
  EXPECT_EQ(file.root().table({"soil", "A table."}).quantity({"radius", "A key."}, Dimension::length),
            0.005);  // of whole.toml
  EXPECT_EQ(file.root().table({"soil", "A table."}).quantity({"friction", "A key."}, Dimension::none),
            0.7);                                                                    // soil.toml
                                                                                     // is the
                                                                                     // later
                                                                                     // one
  EXPECT_TRUE(file.root().table({"soil", "A table."}).boolean({"kept", "A key."}));  // the file itself
  EXPECT_EQ(file.root().tables({"stage", "A table."}).size(), 1U);                   // an array is replaced
  EXPECT_EQ(file.resolved().find("extends"), std::string::npos);

  const CaseFile same = load("extends = \"extended/whole.toml\"");
  read_all(same);
  const CaseFile plain = load(valid);
  read_all(plain);
  EXPECT_EQ(same.fingerprint(), plain.fingerprint());
}

TEST(CaseFile, WrongExtensionsAreOneLine) {
  const auto here = std::filesystem::current_path();
  std::filesystem::create_directories(here / "extended");
  std::ofstream(here / "extended" / "bad.toml") << "steps = 1\n[soil]\nradius = \"-1 mm\"\n";
  EXPECT_EQ(message("extends = \"extended/bad.toml\"\nkind = \"pack\""),
            "extended/bad.toml:3: soil.radius: must be positive, is -1 mm");
  const std::string nowhere = message("steps = 1\nextends = \"nowhere.toml\"");
  EXPECT_TRUE(nowhere.starts_with("case.toml:2: extends: ")) << nowhere;
  EXPECT_TRUE(nowhere.ends_with("nowhere.toml does not exist")) << nowhere;
  EXPECT_EQ(message("extends = 3"), "case.toml:1: extends: must be the name of a case file, or an array of such names");
  EXPECT_EQ(message("extends = \"case.toml\""),
            "case.toml:1: extends: the files extend one another in a circle, or more than eight deep");
}

TEST(CaseFile, PathsBeginWhereTheyAreWritten) {
  const auto here = std::filesystem::current_path();
  std::filesystem::create_directories(here / "extended");
  std::ofstream(here / "extended" / "data.csv") << "1\n";
  std::ofstream(here / "extended" / "path.toml") << "file = \"data.csv\"\n";
  const auto file = write("extends = \"extended/path.toml\"");
  EXPECT_TRUE(std::filesystem::equivalent(CaseFile::load(file).root().optional_path({"file", "A key."}).value(),
                                          here / "extended" / "data.csv"));
  EXPECT_TRUE(std::filesystem::equivalent(
      CaseFile::load(file, {"file=extended/data.csv"}).root().optional_path({"file", "A key."}).value(),
      here / "extended" / "data.csv"));
}

TEST(CaseFile, ATableOfTheCommandLineLeavesTheOtherKeysOfTheFile) {
  for (const char* table : {"soil={}", "soil={radius = \"7 mm\"}"}) {
    const CaseFile file = CaseFile::load(write(valid), {table});
    read_all(file);
    EXPECT_EQ(file.root().table({"soil", "A table."}).quantity({"weight", "A key."}, Dimension::unit_weight), 20e3)
        << table;
  }
  const CaseFile changed = CaseFile::load(write(valid), {"soil={radius = \"7 mm\", kept = false}"});
  EXPECT_EQ(changed.root().table({"soil", "A table."}).quantity({"radius", "A key."}, Dimension::length), 7e-3);
  EXPECT_FALSE(changed.root().table({"soil", "A table."}).boolean({"kept", "A key."}));
  EXPECT_EQ(message(valid, {"soil={radios = 1}"}), "--set soil.radios: unknown key; did you mean \"radius\"?");
}

TEST(CaseFile, OneNameOrAListOfNamesOfFiles) {
  const auto here = std::filesystem::current_path();
  for (const char* name : {"a.csv", "b.csv"}) std::ofstream(here / name) << "1\n";
  using Paths = std::vector<std::filesystem::path>;
  EXPECT_EQ(CaseFile::load(write("file = \"a.csv\"")).root().optional_paths({"file", "A key."}), Paths{here / "a.csv"});
  const CaseFile both = CaseFile::load(write("file = [\"a.csv\", \"b.csv\"]"));
  EXPECT_EQ(both.root().optional_paths({"file", "A key."}), (Paths{here / "a.csv", here / "b.csv"}));
  EXPECT_NE(both.resolved().find("file = [\"a.csv\", \"b.csv\"]"), std::string::npos) << both.resolved();
  EXPECT_TRUE(CaseFile::load(write("x = 1")).root().optional_paths({"file", "A key."}).empty());
  for (const char* wrong : {"file = []", "file = [\"a.csv\", \"none.csv\"]", "file = [1]", "file = [[\"a.csv\"]]"}) {
    EXPECT_THROW(static_cast<void>(CaseFile::load(write(wrong)).root().optional_paths({"file", "A key."})), InputError)
        << wrong;
  }
}

TEST(CaseFile, ResolvedCaseReadsBackAsTheSameCase) {
  const CaseFile file = CaseFile::load(write(valid), {"soil.radius=7 mm"});
  read_all(file);
  const std::string resolved = file.resolved();
  EXPECT_NE(resolved.find("radius = \"7 mm\"  # --set\n"), std::string::npos) << resolved;
  EXPECT_NE(resolved.find("thickness = \"0.1 m\"  # default\n"), std::string::npos) << resolved;
  EXPECT_NE(resolved.find("seeds = [7]  # default\n"), std::string::npos) << resolved;

  const CaseFile again = CaseFile::load(write(resolved));
  read_all(again);
  EXPECT_EQ(again.fingerprint(), file.fingerprint());
}

TEST(CaseFile, FingerprintFollowsTheValuesThatCount) {
  const std::vector<std::string> without{"steps", "stage"};
  const auto fingerprint = [&](const std::vector<std::string>& overrides, std::span<const std::string> left_out) {
    const CaseFile file = CaseFile::load(write(valid), overrides);
    read_all(file);
    return file.fingerprint(left_out);
  };
  EXPECT_NE(fingerprint({"steps=5"}, {}), fingerprint({}, {}));
  EXPECT_NE(fingerprint({"soil.friction=0.6"}, without), fingerprint({}, without));
  EXPECT_EQ(fingerprint({"steps=5", "stage[1].seeds=[3]"}, without), fingerprint({}, without));
  EXPECT_EQ(fingerprint({"soil.thickness=0.1 m"}, {}), fingerprint({}, {}));  // a default, written out
}

TEST(CaseFile, FingerprintDoesNotFollowHowAValueIsWritten) {
  const auto fingerprint = [&](const std::vector<std::string>& overrides) {
    const CaseFile file = CaseFile::load(write(valid), overrides);
    read_all(file);
    return file.fingerprint();
  };
  const std::string base = fingerprint({"soil.radius=7 mm", "stage[0].targets=[1, \"2 %\"]"});
  for (const char* same : {"7.0 mm", "0.7 cm", "0.007 m", "7e-3 m"}) {
    EXPECT_EQ(fingerprint({fmt::format("soil.radius={}", same), "stage[0].targets=[1.0, 0.02]"}), base) << same;
  }
  EXPECT_NE(fingerprint({"soil.radius=7.0001 mm", "stage[0].targets=[1, \"2 %\"]"}), base);
  EXPECT_NE(fingerprint({"soil.radius=7 mm", "stage[0].targets=[1, \"2.1 %\"]"}), base);
  EXPECT_NE(fingerprint({"soil.radius=7 mm", "stage[0].targets=[\"2 %\", 1]"}), base);
}

TEST(CaseFile, ChecksOfTheHostCarryThePlace) {
  const CaseFile file = CaseFile::load(write(valid));
  const std::string line = file.root().table({"soil", "A table."}).error("weight", "does not fit the radius").what();
  EXPECT_TRUE(line.ends_with("case.toml:5: soil.weight: does not fit the radius")) << line;
}

TEST(CaseFile, ListsHaveLimitsOfTheirLength) {
  const auto said = [](const std::string& text, const ListRule& rule) {
    const CaseFile file = CaseFile::of_text(text, "case.toml");
    try {
      static_cast<void>(file.root().integers({"list", "A key."}, {}, {}, rule));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(said("list = [1, 2]", {.least = 2, .most = 2, .different = true}), "");
  EXPECT_EQ(said("list = [1]", {.least = 2}), "case.toml:1: list: must have at least 2 entries, has 1");
  EXPECT_EQ(said("list = []", {.least = 1}), "case.toml:1: list: must have at least 1 entry, has 0");
  EXPECT_EQ(said("list = [1, 2]", {.most = 1}), "case.toml:1: list: must have at most 1 entry, has 2");
  EXPECT_EQ(said("list = [1]", {.least = 4, .most = 4}), "case.toml:1: list: must have 4 entries, has 1");
  EXPECT_EQ(said("list = [3, 3]", {.different = true}), "case.toml:1: list: names 3 twice");
}

TEST(CaseFile, TextsMatchTheirPattern) {
  const TextRule rule{.pattern = "[a-z]+", .fault = "must be small letters"};
  const CaseFile file = CaseFile::of_text("good = \"abc\"\nbad = \"abC\"", "case.toml");
  EXPECT_EQ(file.root().text({"good", "A key."}, {}, rule), "abc");
  EXPECT_EQ(file.root().optional_text({"none", "A key."}, rule), std::nullopt);
  expect_throws<InputError>([&] { static_cast<void>(file.root().optional_text({"bad", "A key."}, rule)); },
                            "case.toml:2: bad: must be small letters");
}

TEST(CaseFile, KeysAndTablesKeepTheirSentences) {
  const CaseFile file = CaseFile::of_text("[[grid]]\n\"a.b\" = [1]\n[grid.soft]\nx = \"y=1\"", "case.toml");
  for (const Table& grid : file.root().table_or_tables({"grid", "A grid."})) {
    static_cast<void>(grid.values_as_toml({"\"TABLE.KEY\"", "An axis."}, "a.b"));
    static_cast<void>(grid.named_table({"NAME", "A named axis."}, "soft").text_or_texts({"POINT", "A point."}, "x"));
    EXPECT_EQ(grid.optional_integer({"members", "Runs."}), std::nullopt);
  }
  const std::vector<KeyInfo> keys = file.keys(), tables = file.tables();
  ASSERT_EQ(keys.size(), 4U);
  EXPECT_EQ(keys[0].key, "extends");
  EXPECT_EQ(keys[1].key, "grid[].\"TABLE.KEY\"");
  EXPECT_EQ(keys[2].key, "grid[].NAME.POINT");
  EXPECT_EQ(keys[2].help, "A point.");
  EXPECT_EQ(keys[3].key, "grid[].members");
  ASSERT_EQ(tables.size(), 2U);
  EXPECT_EQ(tables[0].help, "A grid.");
  EXPECT_EQ(tables[1].key, "grid[].NAME");
  EXPECT_EQ(file.root().known_tables("grid").size(), 1U);
  EXPECT_THROW(static_cast<void>(file.root().known_table("never_read")), std::logic_error);
}

}  // namespace
}  // namespace voussoir::io
