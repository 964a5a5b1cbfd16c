/// The number of threads and its reason, for everything that may be said about it.

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "host/process/threads.hpp"

namespace voussoir::host {
namespace {

constexpr ThreadLimits wide{512, 1 << 20};

ThreadChoice choose(int asked, const Cores& cores, const std::map<std::string, std::string>& variables = {},
                    ThreadLimits limits = wide) {
  return choose_threads(asked, cores, limits, [&variables](const char* name) -> const char* {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  });
}

bool says(const ThreadChoice& choice, const std::string& part) { return choice.note.find(part) != std::string::npos; }

TEST(ThreadsTest, OneForEachCoreThatIsAvailable) {
  EXPECT_EQ(choose(0, {8, 8, {}}).note, "threads: 8 (one for each core); 8 cores are available");
  EXPECT_EQ(choose(0, {64, 16, 3.5}).count, 4);
  EXPECT_EQ(choose(0, {64, 64, 0.2}).count, 1);
}

TEST(ThreadsTest, AMachineLargerThanThePool) {
  const ThreadChoice choice = choose(0, {768, 768, {}});
  EXPECT_EQ(choice.count, 512);
  EXPECT_TRUE(says(choice, "Kokkos' pool holds only 512")) << choice.note;
}

TEST(ThreadsTest, TheOptionComesBeforeTheVariables) {
  const std::map<std::string, std::string> both{{"OMP_NUM_THREADS", "3"}, {"KOKKOS_NUM_THREADS", "5"}};
  EXPECT_EQ(choose(2, {8, 8, {}}, both).count, 2);
  EXPECT_EQ(choose(0, {8, 8, {}}, both).count, 5);
  EXPECT_EQ(choose(0, {8, 8, {}}, {{"OMP_NUM_THREADS", "3"}}).count, 3);
  EXPECT_TRUE(says(choose(0, {8, 8, {}}, {{"OMP_NUM_THREADS", "3"}}), "OMP_NUM_THREADS=3"));
}

TEST(ThreadsTest, TheFirstOfAListCounts) { EXPECT_EQ(choose(0, {8, 8, {}}, {{"OMP_NUM_THREADS", " 4 , 2"}}).count, 4); }

TEST(ThreadsTest, VariablesThatAreNoNumberAreNotUsedAndNamed) {
  for (const char* text : {"", "abc", "0", "-3", "4x", "4,", "4,abc", ",4", "1e3", "0x10"}) {
    const ThreadChoice choice = choose(0, {8, 8, {}}, {{"OMP_NUM_THREADS", text}});
    EXPECT_EQ(choice.count, 8) << text;
    EXPECT_TRUE(says(choice, "is no number of threads")) << choice.note;
  }
  EXPECT_EQ(choose(0, {8, 8, {}}, {{"KOKKOS_NUM_THREADS", "x"}, {"OMP_NUM_THREADS", "3"}}).count, 3);
}

TEST(ThreadsTest, MoreThanThePoolHolds) {
  for (const char* text : {"600", "99999999999999999999999999"}) {
    const ThreadChoice choice = choose(0, {2, 2, {}}, {{"OMP_NUM_THREADS", text}});
    EXPECT_EQ(choice.count, 512);
    EXPECT_TRUE(says(choice, "Kokkos' pool holds only 512")) << choice.note;
  }
}

TEST(ThreadsTest, TheLimitOfOpenMP) {
  const ThreadChoice choice = choose(8, {8, 8, {}}, {}, {512, 3});
  EXPECT_EQ(choice.count, 3);
  EXPECT_TRUE(says(choice, "OMP_THREAD_LIMIT allows only 3")) << choice.note;
}

TEST(ThreadsTest, OversubscriptionIsObeyedAndSaid) {
  const ThreadChoice choice = choose(7, {8, 2, {}});
  EXPECT_EQ(choice.count, 7);
  EXPECT_TRUE(says(choice, "2 cores are available")) << choice.note;
  EXPECT_TRUE(says(choice, "take turns")) << choice.note;
  EXPECT_FALSE(says(choose(2, {8, 2, {}}), "take turns"));
}

TEST(ThreadsTest, OtherVariablesAreNamedInPrintableForm) {
  const ThreadChoice choice = choose(
      0, {2, 2, {}}, {{"OMP_PROC_BIND", "true\n"}, {"OMP_DYNAMIC", "true"}, {"OMP_PLACES", std::string(99, 'p')}});
  EXPECT_TRUE(says(choice, "OMP_PROC_BIND=true?")) << choice.note;
  EXPECT_TRUE(says(choice, "OMP_DYNAMIC=true is not obeyed")) << choice.note;
  EXPECT_TRUE(says(choice, std::string(40, 'p') + "...")) << choice.note;
  EXPECT_FALSE(says(choice, std::string(41, 'p'))) << choice.note;
}

}  // namespace
}  // namespace voussoir::host
