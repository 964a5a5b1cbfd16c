/// What is made of a list of keys: values, a page, a schema.

#include "io/key_reference.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "io/near_names.hpp"

namespace voussoir::io {
namespace {

const KeyInfo kind{.key = "kind", .type = KeyType::choice, .required = true, .choices = {"a", "b"}, .help = "What."};
const KeyInfo depth{.key = "ground.depth",
                    .type = KeyType::quantity,
                    .dimension = Dimension::length,
                    .fallback = "\"5 m\"",
                    .at_least = "1 m",
                    .at_most = "9 m",
                    .help = "Depth, \"D\"; docs/validation/trade.md tells its price."};
const KeyInfo ground{.key = "ground", .type = KeyType::table, .help = "The ground."};
const KeyInfo share{.key = "share",
                    .type = KeyType::quantity,
                    .list = true,
                    .fallback = "[]",
                    .at_least = "0",
                    .at_most = "1",
                    .most_entries = 3,
                    .help = "A share."};

KeyReference reference() { return join_kinds("case", {{"a", {{kind, share, depth}, {ground}}}, {"b", {{kind}, {}}}}); }

void expect_in(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
}

TEST(KeyReference, PartsOfKeys) {
  EXPECT_EQ(parent_of("kind"), "");
  EXPECT_EQ(last_part("kind"), "kind");
  EXPECT_EQ(parent_of("soil.class[].size_to"), "soil.class[]");
  EXPECT_EQ(last_part("soil.class[].size_to"), "size_to");
  EXPECT_EQ(parent_of("grid[].\"TABLE.KEY\""), "grid[]");
  EXPECT_EQ(last_part("grid[].\"TABLE.KEY\""), "\"TABLE.KEY\"");
  EXPECT_EQ(as_parent({.key = "soil.class", .list = true}), "soil.class[]");
}

TEST(KeyReference, KindsAreJoinedAndMustAgree) {
  const KeyReference joined = reference();
  ASSERT_EQ(joined.keys.size(), 3U);
  EXPECT_EQ(joined.keys[0].kinds, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(joined.keys[2].kinds, (std::vector<std::string>{"a"}));
  KeyInfo other = depth;
  other.at_most = "8 m";
  EXPECT_THROW(static_cast<void>(join_kinds("case", {{"a", {{depth}, {}}}, {"b", {{other}, {}}}})), std::logic_error);
}

TEST(KeyReference, ValuesOfATable) {
  const std::string table = key_table({reference()});
  expect_in(table, "key,type,dimension,default,at_least,at_most,choices,help,kinds\n");
  expect_in(table, "kind,choice,,(required),,,a|b,What.,a|b\n");
  expect_in(table, "ground.depth,quantity,length,5 m,1 m,9 m,,\"Depth, \"\"D\"\"; docs/validation/trade.md");
}

TEST(KeyReference, APartHasTheKeyOrTheTableOfItsName) {
  KeyInfo size{.key = "soil.class[].size_to", .type = KeyType::quantity, .help = "A size."};
  const KeyInfo list{.key = "soil.class", .type = KeyType::table, .list = true, .help = "A class."};
  const KeyReference all = join_kinds("case", {{"a", {{kind, depth, size}, {ground, list}}}});
  for (const char* name : {"soil", "soil.class", "soil.class[]", "[[soil.class]]", "soil.class[3].size_to"}) {
    const KeyReference part = part_named(all, name);
    ASSERT_EQ(part.keys.size(), 1U) << name;
    EXPECT_EQ(part.keys[0].info.key, size.key);
    ASSERT_EQ(part.tables.size(), 1U) << name;
    EXPECT_EQ(part.tables[0].info.key, "soil.class");
  }
  EXPECT_EQ(part_named(all, "kind").keys.size(), 1U);
  for (const char* name : {"ground.dep", "depth", "soi", "", "[]", "."})
    EXPECT_TRUE(part_named(all, name).keys.empty());
  EXPECT_EQ(plain_names(all),
            (std::vector<std::string>{"ground", "soil.class", "kind", "ground.depth", "soil.class.size_to"}));
}

TEST(KeyReference, NearNamesAreThoseOfKeysAndOfTheirLastParts) {
  const std::vector<std::string> known{"soil.thickness", "calibrate.thickness", "soil.friction", "tunnel", "tunnel"};
  EXPECT_EQ(near_names("thicknes", known), (std::vector<std::string>{"soil.thickness", "calibrate.thickness"}));
  EXPECT_EQ(near_names("soil.thicknes", known), (std::vector<std::string>{"soil.thickness"}));
  EXPECT_EQ(near_names("tunel", known), (std::vector<std::string>{"tunnel"}));
  EXPECT_EQ(near_names("thickness_of_discs", known), near_names("thickness", known));
  EXPECT_EQ(near_names("soil.thick", known), (std::vector<std::string>{"soil.thickness"}));
  EXPECT_TRUE(near_names("weather", known).empty());
  EXPECT_EQ(nearest_name({"modulus", "friction", "damping"}, "friction_angle"), "friction");
  EXPECT_EQ(nearest_name({"friction_angles", "friction"}, "friction_angle"), "friction_angles");
  // A letter that is missing or wrong is likelier than a word that is missing.
  const std::vector<std::string> sieve{"passing", "passing_by", "sizes", "size_minimum", "size_maximum"};
  EXPECT_EQ(nearest_name(sieve, "size"), "sizes");
  EXPECT_EQ(nearest_name(sieve, "passin"), "passing");
  EXPECT_EQ(nearest_name(sieve, "size_max"), "size_maximum");
  EXPECT_EQ(near_names("size", {"soil.size_minimum", "soil.sizes", "soil.size_maximum"}),
            (std::vector<std::string>{"soil.sizes", "soil.size_minimum", "soil.size_maximum"}));
  EXPECT_TRUE(near_names(std::string(1000, 'x'), {std::string(1000, 'x')}).empty());
  EXPECT_EQ(near_names("a", {"b", "c", "d", "e", "f", "g", "h"}).size(), 5U);
}

TEST(KeyReference, ThePageHasASectionForEachTableAndLinks) {
  const std::string page = key_page({reference()});
  expect_in(page, "### `[ground]`\n\nThe ground. Used by kind `a`.\n");
  expect_in(page,
            "| `depth` | `5 m` | length, 1 m to 9 m | Depth, \"D\"; "
            "[docs/validation/trade.md](../validation/trade.md) tells its price. |");
  expect_in(page, "| `kind` | must be given | `a`, `b` | What. |");
  expect_in(page, "| `share` | empty list | list: number, 0 to 1; at most 3 entries | Only kind `a`. A share. |");
}

TEST(KeyReference, TheSchemaHasTypesLimitsAndWhatAKindRefuses) {
  std::string schema = key_schema(reference());
  std::erase_if(schema, [](char c) { return c == ' ' || c == '\n'; });
  expect_in(schema, R"("enum":["a","b"])");
  expect_in(schema, R"("default":"5m")");
  expect_in(schema, R"([\\t]*(m|cm|mm|km|um)");
  expect_in(schema, R"("minimum":0.0,"maximum":1.0)");
  expect_in(schema, R"("maxItems":3)");
  expect_in(schema, R"("additionalProperties":false)");
  expect_in(schema, R"("then":{"required":["kind"]})");
  expect_in(schema,
            R"({"kind":{"const":"b"}},"required":["kind"]},"then":{"properties":{"share":false,"ground":false}})");
  EXPECT_EQ(schema.find(R"("const":"a")"), std::string::npos) << "kind a refuses nothing";
}

}  // namespace
}  // namespace voussoir::io
