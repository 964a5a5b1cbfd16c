/// Outcomes, exceptions and ends of processes become exit codes by one table.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <exception>
#include <new>
#include <set>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include "host/case/failure.hpp"
#include "host/program/failure.hpp"
#include "host/program/sweep_outcome.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {
namespace {

template <class Exception>
Outcome outcome_of_exception(const Exception& exception) {
  return failure_of(std::make_exception_ptr(exception)).outcome;
}

TEST(ExitCodeTest, EachOutcomeHasItsCode) {
  EXPECT_EQ(exit_code(Outcome::done), 0);
  EXPECT_EQ(exit_code(Outcome::wrong_input), 2);
  EXPECT_EQ(exit_code(Outcome::no_equilibrium), 3);
  EXPECT_EQ(exit_code(Outcome::machine_failure), 4);
  EXPECT_EQ(exit_code(Outcome::interrupted), 130);
  std::set<int> codes;
  for (const ExitStatus& status : exit_table) codes.insert(status.code);
  EXPECT_EQ(codes.size(), exit_table.size());
}

TEST(ExitCodeTest, OnlyWhatTheUserWroteIsWrongInput) {
  EXPECT_EQ(outcome_of_exception(io::InputError("case.toml:3", "key", "is wrong")), Outcome::wrong_input);
  EXPECT_EQ(outcome_of_exception(NoEquilibrium("no rest")), Outcome::no_equilibrium);
  EXPECT_EQ(outcome_of_exception(Interrupted("stopped")), Outcome::interrupted);
  EXPECT_EQ(outcome_of_exception(std::bad_alloc()), Outcome::machine_failure);
  EXPECT_EQ(outcome_of_exception(std::runtime_error("disk")), Outcome::machine_failure);
  EXPECT_EQ(outcome_of_exception(std::system_error(ENOSPC, std::generic_category())), Outcome::machine_failure);
  // A broken call within the program is not the user's fault.
  EXPECT_EQ(outcome_of_exception(std::invalid_argument("sizes disagree")), Outcome::machine_failure);
  EXPECT_EQ(outcome_of_exception(std::out_of_range("no such point")), Outcome::machine_failure);
  EXPECT_EQ(outcome_of_exception(7), Outcome::machine_failure);
}

TEST(ExitCodeTest, AnErrorWithinSaysSo) {
  const Failure failure = failure_of(std::make_exception_ptr(std::invalid_argument("sizes disagree")));
  EXPECT_EQ(failure.sentence, "an error within the program: sizes disagree");
  EXPECT_EQ(failure_of(std::make_exception_ptr(std::bad_alloc())).sentence, "out of memory");
}

/// What waitpid tells of a process that does this.
template <class Act>
int status_after(const Act& act) {
  const pid_t child = fork();
  if (child == 0) {
    act();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(ExitCodeTest, WhatNobodyCatchesEndsByTheTable) {
  end_all_failures_by_the_table();
  const int thrown = status_after([] {
    ::close(STDERR_FILENO);
    std::thread([] { throw std::bad_alloc(); }).join();
  });
  EXPECT_TRUE(WIFEXITED(thrown));
  EXPECT_EQ(WEXITSTATUS(thrown), 4);
  const int library = status_after([] { std::exit(1); });  // as OpenMP does where it cannot start a thread
  EXPECT_EQ(WEXITSTATUS(library), 4);
  EXPECT_EQ(WEXITSTATUS(status_after([] { std::exit(3); })), 3);
}

TEST(SweepOutcomeTest, TheEndOfARun) {
  EXPECT_EQ(name_of(end_of(status_after([] { _exit(0); }), false)), "finished");
  EXPECT_EQ(name_of(end_of(status_after([] { _exit(2); }), false)), "wrong input");
  EXPECT_EQ(name_of(end_of(status_after([] { _exit(3); }), false)), "no equilibrium");
  EXPECT_EQ(name_of(end_of(status_after([] { _exit(4); }), false)), "machine failure");
  EXPECT_EQ(name_of(end_of(status_after([] { _exit(130); }), false)), "interrupted");
  EXPECT_EQ(name_of(end_of(status_after([] { _exit(77); }), false)), "machine failure");
  EXPECT_EQ(name_of(RunEnd{}), "not run");
}

TEST(SweepOutcomeTest, ASignalIsNamed) {
  const RunEnd killed = end_of(status_after([] { raise(SIGKILL); }), false);
  EXPECT_EQ(name_of(killed), "killed by SIGKILL");
  EXPECT_EQ(killed.code, 137);
  EXPECT_EQ(killed.outcome, Outcome::machine_failure);
  const auto by_usr1 = [] {
    signal(SIGUSR1, SIG_DFL);
    raise(SIGUSR1);
  };
  EXPECT_EQ(name_of(end_of(status_after(by_usr1), true)), "interrupted");
  EXPECT_EQ(name_of(end_of(status_after(by_usr1), false)), "killed by SIGUSR1");
}

TEST(SweepOutcomeTest, TheSweepsOwn) {
  const RunEnd done{Outcome::done, 0}, input{Outcome::wrong_input, 2}, numbers{Outcome::no_equilibrium, 3},
      machine{Outcome::machine_failure, 4}, stopped{Outcome::interrupted, 130}, not_run;
  const auto of = [](std::vector<RunEnd> ends) { return outcome_of(ends); };
  EXPECT_EQ(of({done, done}), Outcome::done);
  EXPECT_EQ(of({done, numbers}), Outcome::no_equilibrium);
  EXPECT_EQ(of({numbers, input, done}), Outcome::wrong_input);
  EXPECT_EQ(of({numbers, input, machine}), Outcome::machine_failure);
  EXPECT_EQ(of({machine, stopped}), Outcome::interrupted);
  EXPECT_EQ(of({done, not_run}), Outcome::interrupted);
}

}  // namespace
}  // namespace voussoir::host
