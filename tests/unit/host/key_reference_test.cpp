/// The list of all keys against what the readers of each kind accept.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "host/case/key_reference.hpp"
#include "host/case/load_case.hpp"
#include "host/sweep/sweep_file.hpp"
#include "tests/case_with_key.hpp"

namespace voussoir::host {
namespace {

const io::ListedKey& key_named(const io::KeyReference& reference, const std::string& name) {
  const auto found = std::find_if(reference.keys.begin(), reference.keys.end(),
                                  [&](const io::ListedKey& listed) { return listed.info.key == name; });
  if (found == reference.keys.end()) throw std::out_of_range(name);
  return *found;
}

TEST(KeyReference, EachKindAcceptsTheKeysThatTheListGivesItAndNoOther) {
  const io::KeyReference all = case_reference();
  EXPECT_EQ(all.kinds.size(), case_kind_names.size());
  for (const auto& [kind, name] : case_kind_names) {
    for (const io::ListedKey& listed : all.keys) {
      if (listed.info.key == "kind" || listed.info.key == "extends") continue;
      const bool is_listed = std::find(listed.kinds.begin(), listed.kinds.end(), name) != listed.kinds.end();
      const std::string said = said_of(case_with(kind, listed.info.key, "1979-05-27").first);
      EXPECT_NE(said, "") << name << " takes a date for " << listed.info.key;
      EXPECT_EQ(said.find("unknown key") == std::string::npos, is_listed) << name << ": " << said;
    }
  }
}

TEST(KeyReference, ListsKindsAndTheDefaultsOfPresets) {
  const io::KeyReference all = case_reference();
  EXPECT_EQ(key_named(all, "volume_loss.total").kinds, (std::vector<std::string>{"tunnel"}));
  EXPECT_EQ(key_named(all, "output.microstructure").kinds.size(), 5U);
  EXPECT_EQ(key_named(all, "soil.modulus").kinds, all.kinds);
  const auto presets = key_named(all, "engine.inertial_number").other_defaults;
  ASSERT_EQ(presets.size(), 2U);
  EXPECT_EQ(presets.front(), std::pair(std::string("fast"), std::string("0.001")));
  EXPECT_TRUE(key_named(all, "soil.modulus").other_defaults.empty());
  EXPECT_EQ(case_reference(CaseKind::pack).kinds, std::vector<std::string>{"pack"});
}

TEST(KeyReference, EveryKeyAndTableHasASentence) {
  const io::KeyReference cases = case_reference(), sweeps = io::join_kinds("sweep", {{"sweep", keys_of_sweep()}});
  for (const io::KeyReference& reference : {cases, sweeps}) {
    for (const auto& listed : reference.keys) EXPECT_TRUE(listed.info.help.ends_with('.')) << listed.info.key;
    for (const auto& listed : reference.tables) EXPECT_TRUE(listed.info.help.ends_with('.')) << listed.info.key;
  }
}

TEST(KeyReference, SweepsHaveKeysWhoseNamesTheUserChooses) {
  const io::KeyReference sweeps = io::join_kinds("sweep", {{"sweep", keys_of_sweep()}});
  EXPECT_TRUE(key_named(sweeps, "grid[].\"TABLE.KEY\"").info.named_by_user);
  EXPECT_TRUE(key_named(sweeps, "grid[].NAME.POINT").info.named_by_user);
  EXPECT_FALSE(key_named(sweeps, "grid[].members").info.named_by_user);
  EXPECT_TRUE(key_named(sweeps, "run[].name").info.required);
  EXPECT_EQ(key_named(sweeps, "grid[].members").info.at_most, "1000");
}

}  // namespace
}  // namespace voussoir::host
