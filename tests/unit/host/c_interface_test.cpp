// The C interface (voussoir.h) beside the C++ interface, and the mistakes that only a program in C++ can make.
// tests/package/c/consumer.c has all others.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "host/library/rves.hpp"
#include "host/library/voussoir.h"
#include "tests/same_bits.hpp"

namespace voussoir::library {
namespace {

constexpr int n = 3;
const std::string case_file = std::string(VOUSSOIR_SOURCE_DIR) + "/tests/package/grains.toml";
const std::vector<std::string> settings{"packing.folder=packings", "packing.grains=60", "packing.variety=2",
                                        "packing.candidates=2"};

/// RVEs made by the C interface.
class Rves {
 public:
  Rves() {
    std::string lines;
    for (const std::string& setting : settings) lines += setting + "\n";
    EXPECT_EQ(voussoir_start(0), voussoir_ok) << voussoir_last_error();
    EXPECT_EQ(voussoir_create(case_file.c_str(), n, lines.c_str(), nullptr, nullptr, &handle_), voussoir_ok)
        << voussoir_last_error();
  }
  ~Rves() { voussoir_destroy(handle_); }
  Rves(const Rves&) = delete;
  Rves& operator=(const Rves&) = delete;
  [[nodiscard]] VoussoirRves* get() const { return handle_; }

  [[nodiscard]] std::vector<std::byte> state() const {
    std::int64_t size = 0;
    EXPECT_EQ(voussoir_state_size(handle_, &size), voussoir_ok);
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    EXPECT_EQ(voussoir_get_state(handle_, bytes.data(), size), voussoir_ok) << voussoir_last_error();
    return bytes;
  }

 private:
  VoussoirRves* handle_ = nullptr;
};

/// Row by row; no component equals another one.
constexpr std::array<double, 4 * n> gradients{1e-5, 3e-5, -2e-5, -4e-5, 0, 5e-5, 1e-5, -1e-5, -3e-5, 0, 2e-5, 2e-5};

using Answer = std::array<double, 12 * n>;  ///< stresses, then tangents

/// The answer to `scale` times the gradients.
Answer answer_of(VoussoirRves* rves, double scale = 1) {
  Answer out{};
  auto h = gradients;
  for (double& number : h) number *= scale;
  EXPECT_EQ(voussoir_evaluate(rves, n, h.data(), out.data(), out.data() + 3 * n, nullptr), voussoir_ok)
      << voussoir_last_error();
  return out;
}

TEST(CInterface, AnswersWithTheBitsOfTheCppInterface) {
  const Rves rves;
  const auto batch = make_rves(case_file, n, settings);
  std::vector<fem::Gradient> h(n);
  for (std::size_t k = 0; k < n; ++k) {
    h[k] << gradients[4 * k], gradients[4 * k + 1], gradients[4 * k + 2], gradients[4 * k + 3];
  }
  std::vector<fem::Stress> stress(n);
  std::vector<fem::Tangent> tangent(n);
  for (int increment = 0; increment < 2; ++increment) {
    batch->begin_increment();
    ASSERT_TRUE(batch->evaluate(h, stress, tangent).usable);
    batch->commit();
    const Answer c = answer_of(rves.get());
    ASSERT_EQ(voussoir_commit(rves.get()), voussoir_ok);
    const std::span<const double> numbers(c);
    EXPECT_TRUE(same_bits(numbers.first(3 * n), {stress[0].data(), 3 * n}));
    EXPECT_TRUE(same_bits(numbers.last(9 * n), {tangent[0].data(), 9 * n}));
  }
  EXPECT_EQ(rves.state(), batch->state());
  for (const fem::PointField& field : batch->fields()) {
    std::vector<double> values(field.values.size());
    const auto size = static_cast<std::int64_t>(values.size());
    EXPECT_EQ(voussoir_field_values(rves.get(), field.name.c_str(), values.data(), size), voussoir_ok);
    EXPECT_EQ(values, field.values) << field.name;
  }
}

TEST(CInterface, AStateThatIsRefusedChangesNothing) {
  const Rves rves;
  const Answer before = answer_of(rves.get());
  const std::vector<std::byte> good = rves.state();
  for (std::size_t place = 0; place < good.size(); place += 61) {
    std::vector<std::byte> bytes = good;
    bytes[place] ^= std::byte{1} << (place % 8);
    const int code = voussoir_set_state(rves.get(), bytes.data(), static_cast<std::int64_t>(bytes.size()));
    ASSERT_EQ(code, voussoir_wrong_input) << "a fault at byte " << place << " of " << good.size();
    ASSERT_EQ(rves.state(), good) << "after a fault at byte " << place;
  }
  EXPECT_NE(std::string(voussoir_last_error()).find("its checksum is wrong"), std::string::npos)
      << voussoir_last_error();
  EXPECT_EQ(answer_of(rves.get()), before);
}

TEST(CInterface, AGradientThatTurnsTheCellInsideOutIsRefused) {
  const Rves rves;
  std::array<double, 4 * n> h{};
  h[7] = -1.5;
  Answer out{};
  EXPECT_EQ(voussoir_evaluate(rves.get(), n, h.data(), out.data(), nullptr, nullptr), voussoir_misuse);
  EXPECT_NE(std::string(voussoir_last_error()).find("RVE 1"), std::string::npos) << voussoir_last_error();
  EXPECT_TRUE(std::isnan(out[0]));
}

TEST(CInterface, AGradientThatIsNoNumberIsToldBeforeOneThatTurnsTheCellInsideOut) {
  const Rves rves;
  Answer out{};
  for (const double first : {-std::numeric_limits<double>::infinity(), std::nan("")}) {
    std::array<double, 4 * n> h{};
    h[0] = first;
    h[7] = -1.5;
    EXPECT_EQ(voussoir_evaluate(rves.get(), n, h.data(), out.data(), nullptr, nullptr), voussoir_misuse);
    EXPECT_NE(std::string(voussoir_last_error()).find("the gradient of RVE 0 is not finite"), std::string::npos)
        << voussoir_last_error();
  }
}

/// Whatever argument is wrong, no old answer may be taken for a new one, committed or reported.
TEST(CInterface, ARefusedEvaluationLeavesNothingOfAnEarlierOne) {
  const Rves rves;
  const double* const h = gradients.data();
  auto no_number = gradients;
  no_number.back() = std::nan("");
  const std::array<double, 12 * n> filled = answer_of(rves.get());
  const auto refused = [&](std::int64_t size, const double* from, bool with_stress, bool with_others) {
    static_cast<void>(answer_of(rves.get()));
    VoussoirReport report{};
    EXPECT_EQ(voussoir_report(rves.get(), &report), voussoir_ok);
    std::array<double, 12 * n> out = filled;
    std::array<std::int32_t, n> status{};
    EXPECT_EQ(voussoir_evaluate(rves.get(), size, from, with_stress ? out.data() : nullptr,
                                with_others ? out.data() + 3 * n : nullptr, with_others ? status.data() : nullptr),
              voussoir_misuse);
    EXPECT_EQ(voussoir_commit(rves.get()), voussoir_misuse);
    EXPECT_EQ(voussoir_report(rves.get(), &report), voussoir_misuse);
    for (std::size_t k = 0; k < out.size(); ++k) {
      const bool given = size == n && (k < 3 * n ? with_stress : with_others);
      EXPECT_TRUE(given ? std::isnan(out[k]) : out[k] == filled[k]) << k;
    }
    for (const std::int32_t s : status) EXPECT_EQ(s, size == n && with_others ? -1 : 0);
  };
  refused(n, nullptr, true, true);
  refused(n, nullptr, true, false);
  refused(n, h, false, true);
  refused(n, no_number.data(), true, true);
  refused(n + 1, h, true, true);
}

/// F in place of H is refused, and so is a single RVE whose H is meant to be near the identity.
TEST(CInterface, GradientsNearTheIdentityAreRefused) {
  VoussoirRves* one = nullptr;
  ASSERT_EQ(voussoir_start(0), voussoir_ok);
  ASSERT_EQ(voussoir_create(case_file.c_str(), 1, "packing.folder=packings\npacking.grains=60", nullptr, nullptr, &one),
            voussoir_ok)
      << voussoir_last_error();
  for (const double e : {0.89, 0.9, 1.0, 1.1, 1.11}) {
    const std::array<double, 4> h{e, 0, 0, e};
    std::array<double, 3> stress{};
    const int code = voussoir_evaluate(one, 1, h.data(), stress.data(), nullptr, nullptr);
    EXPECT_EQ(code, e == 0.9 || e == 1.0 ? voussoir_misuse : voussoir_ok) << e << ": " << voussoir_last_error();
    if (code == voussoir_misuse) {
      EXPECT_NE(std::string(voussoir_last_error()).find("within 0.1 of the identity"), std::string::npos);
    }
  }
  EXPECT_EQ(voussoir_destroy(one), voussoir_ok);
}

TEST(CInterface, AnIncrementThatBeginsAnewNeedsAnEvaluation) {
  const Rves rves;
  static_cast<void>(answer_of(rves.get()));
  EXPECT_EQ(voussoir_begin_increment(rves.get()), voussoir_ok);
  EXPECT_EQ(voussoir_commit(rves.get()), voussoir_misuse);
}

/// Calls of other threads wait; each thread has its own sentence.
TEST(CInterface, ThreadsMayCallAtOnce) {
  const Rves rves;
  EXPECT_EQ(voussoir_commit(nullptr), voussoir_misuse);
  std::vector<std::thread> threads;
  std::atomic<int> ready = 0;
  std::array<int, 4> right{};
  std::array<Answer, 4> alone{};
  for (std::size_t t = 0; t < alone.size(); ++t) alone[t] = answer_of(rves.get(), 0.1 * static_cast<double>(t));
  for (std::size_t t = 0; t < alone.size(); ++t) {
    threads.emplace_back([&, t] {
      bool same = std::string(voussoir_last_error()).empty();
      const Rves own;
      for (ready += 1; ready < static_cast<int>(alone.size());) std::this_thread::yield();
      for (int k = 0; k < 50; ++k) {
        same = same && answer_of(own.get(), 0.1 * static_cast<double>(t)) == alone[t] &&
               answer_of(rves.get(), 0.1 * static_cast<double>(t)) == alone[t];
      }
      right[t] = same ? 1 : 0;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, (std::array<int, 4>{1, 1, 1, 1}));
  EXPECT_FALSE(std::string(voussoir_last_error()).empty());
}

void call_back(const char* /*line*/, void* code) { *static_cast<int*>(code) = voussoir_stop(); }
void create(const char* /*line*/, void* handle) {
  voussoir_create(case_file.c_str(), 1, nullptr, nullptr, nullptr, static_cast<VoussoirRves**>(handle));
}
void throw_something(const char* /*line*/, void* /*context*/) { throw 7; }

TEST(CInterface, ANoteMayNeitherCallNorThrow) {
  const Rves rves;
  VoussoirRves* others = nullptr;
  int code = -1;
  const char* one = "packing.folder=packings\npacking.grains=60";
  EXPECT_EQ(voussoir_create(case_file.c_str(), 1, one, call_back, &code, &others), voussoir_ok);
  EXPECT_EQ(code, voussoir_misuse);
  EXPECT_EQ(voussoir_destroy(others), voussoir_ok);
  VoussoirRves* within = rves.get();
  EXPECT_EQ(voussoir_create(case_file.c_str(), 1, one, create, static_cast<void*>(&within), &others), voussoir_ok);
  EXPECT_EQ(within, nullptr) << "a refused call leaves a handle";
  EXPECT_EQ(voussoir_destroy(others), voussoir_ok);
  EXPECT_EQ(voussoir_create(case_file.c_str(), 1, one, throw_something, nullptr, &others), voussoir_machine_failure);
  EXPECT_EQ(others, nullptr);
  static_cast<void>(answer_of(rves.get()));  // the lock is free
}

TEST(CInterface, AForkedProcessIsRefused) {
  const Rves rves;
  const pid_t child = fork();
  if (child == 0) {
    Answer out{};
    const int code = voussoir_evaluate(rves.get(), n, gradients.data(), out.data(), nullptr, nullptr);
    _exit(std::string(voussoir_last_error()).find("forked") == std::string::npos ? 99 : code);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), voussoir_misuse);
  static_cast<void>(answer_of(rves.get()));
}

TEST(CInterface, AskingForMoreMemoryThanThereIsIsAFailureOfTheMachine) {
  const Rves rves;
  VoussoirRves* others = nullptr;
  const std::int64_t many = std::int64_t{1} << 60;
  EXPECT_EQ(
      voussoir_create(case_file.c_str(), many, "packing.folder=packings\npacking.grains=60", nullptr, nullptr, &others),
      voussoir_machine_failure);
  EXPECT_STREQ(voussoir_last_error(), "out of memory");
}

}  // namespace
}  // namespace voussoir::library
