#include "host/program/command_line.hpp"

#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "host/case/failure.hpp"
#include "host/process/build_info.hpp"
#include "host/process/exit_code.hpp"
#include "host/process/standard_streams.hpp"
#include "host/process/threads.hpp"
#include "host/program/commands.hpp"
#include "host/program/sweep_outcome.hpp"
#include "host/ranks/session.hpp"

namespace voussoir::host {
namespace {

struct Arguments {
  std::string file;
  std::string name;
  std::string output;
  std::vector<std::string> overrides;
  bool resume = false;
  bool replace = false;
  bool cpu = false;
  bool devices = false;
  int threads = 0;
  int processes = 1;
  bool take_over = false;
  int members = 0;
  std::string until;
  std::string result;
  bool list = false;
  bool json = false;
  bool gather = false;
  bool markdown = false;
  bool json_schema = false;
  std::string only;
};

/// The table of exit codes, for the end of `--help`.
std::string exit_codes() {
  std::string text = "exit status:\n";
  for (const ExitStatus& status : exit_table) text += fmt::format("  {:<4} {}\n", status.code, status.meaning);
  return text + sweep_rule;
}

/// A build whose Kokkos has one thread takes any number, so that scripts work with both builds.
int most_threads_to_ask_for() { return most_threads() > 1 ? most_threads() : 4096; }

void add_threads(CLI::App& command, Arguments& a, const char* text) {
  command.add_option("--threads", a.threads, text)->check(CLI::Range(1, most_threads_to_ask_for()));
}

void add_take_over(CLI::App& command, Arguments& a) {
  command.add_flag("--take-over", a.take_over,
                   "take a folder over that a process on another host has not given back; only where that process has "
                   "ended, as where a scheduler has moved the job");
}

/// `-o "$DIR"` with a variable that is not set must not write to the default folder.
std::string not_empty(const std::string& name) { return name.empty() ? "must name a folder, is empty" : ""; }

void add_overrides(CLI::App& command, Arguments& arguments) {
  command
      .add_option("--set", arguments.overrides,
                  "table.key=value, which replaces the case file's value; may be repeated")
      ->allow_extra_args(false);
}

void add_processes(CLI::App& command, Arguments& a) {
  command.add_option("-j", a.processes, "number of runs at a time")->check(CLI::Range(1, 1024));
  add_threads(command, a, "threads of each run; default: the available cores, shared among the runs at a time");
  add_take_over(command, a);
}

ProcessOptions process_options(const Arguments& a) {
  return {std::filesystem::read_symlink("/proc/self/exe"), a.processes, a.threads, a.resume, a.take_over, {}, {}};
}

void describe_ensemble(CLI::App& app, Arguments& a, const std::string& command_text, Outcome& outcome) {
  CLI::App* ensemble = app.add_subcommand(
      "ensemble", "run a case with several draws of its packings, and reduce the results to means and bands");
  ensemble->add_option("case", a.file, "case file (TOML)")->required();
  CLI::Option* number = ensemble->add_option("-n", a.members, "number of members; with --until the largest number");
  number->check(CLI::Range(2, 1000));
  ensemble->add_option("-o,--output", a.output, "folder of the results; default: out/TITLE_ensemble")->check(not_empty);
  CLI::Option* until = ensemble->add_option("--until", a.until,
                                            "begin with four members and add more, as many at a time as -j says, until "
                                            "the standard error of the result is at "
                                            "most this share of its mean, such as \"5 %\"; -n is 64 unless given");
  ensemble
      ->add_option("--result", a.result,
                   "column of which --until speaks; default: the surface's settlement, K0 at the column's base, or the "
                   "axial stress of a specimen, at the end")
      ->needs(until);
  add_processes(*ensemble, a);
  ensemble->add_flag("--resume", a.resume, "skip finished members, go on with interrupted ones and add further ones");
  add_overrides(*ensemble, a);
  ensemble->callback([&a, &command_text, &outcome, number] {
    outcome = command_ensemble(
        a.file, {a.output, process_options(a), a.overrides,
                 number->count() > 0 ? std::optional(a.members) : std::nullopt, a.until, a.result, command_text});
  });
}

void describe_sweep(CLI::App& app, Arguments& a, const std::string& command_text, Outcome& outcome) {
  CLI::App* sweep = app.add_subcommand("sweep", "run the cases of a list or a grid, and gather their results");
  sweep->add_option("sweep", a.file, "sweep file (TOML)")->required();
  sweep->add_option("-o,--output", a.output, "folder of the results; default: out/STEM of the sweep file")
      ->check(not_empty);
  add_processes(*sweep, a);
  sweep->add_flag("--resume", a.resume, "skip finished runs and go on with interrupted ones");
  CLI::Option* list = sweep->add_flag("--list", a.list, "print the runs with their estimated cost, and run nothing");
  sweep->add_flag("--json", a.json, "print the list as JSON, for programs that start the runs")->needs(list);
  CLI::Option* only = sweep->add_option("--only", a.only, "run this one run, and keep how it ended for --gather");
  only->excludes(list);
  sweep->add_flag("--gather", a.gather, "run nothing: write the tables and the means of what has been run")
      ->excludes(list)
      ->excludes(only);
  sweep->callback([&a, &command_text, &outcome, only] {
    const SweepTask task = a.list              ? SweepTask::list
                           : a.gather          ? SweepTask::gather
                           : only->count() > 0 ? SweepTask::run_one
                                               : SweepTask::run_all;
    outcome = command_sweep(a.file, {a.output, process_options(a), task, a.only, a.json, command_text});
  });
}

void describe_mesh(CLI::App& app, Arguments& a, Outcome& outcome) {
  CLI::App* mesh = app.add_subcommand("mesh", "generate the mesh of a tunnel and store it for ground.mesh_file");
  mesh->add_option("case", a.file, "case file (TOML)")->required();
  mesh->add_option("-o,--output", a.output, "file of the mesh")->required()->check([](const std::string& name) {
    return name.empty() ? "must name a file, is empty" : "";
  });
  mesh->add_flag("--replace", a.replace, "overwrite a file that is there");
  add_overrides(*mesh, a);
  mesh->callback([&a, &outcome] { outcome = command_mesh(a.file, a.overrides, a.output, a.replace); });
}

void describe_keys(CLI::App& app, Arguments& a, Outcome& outcome) {
  CLI::App* keys = app.add_subcommand(
      "keys", "print every key of case files and sweep files: type, default, limits, explanation, kinds that use it");
  CLI::Option* name = keys->add_option("name", a.name,
                                       "what to print: a kind of case, \"sweep\" for sweep files, a table such as "
                                       "soil, or a key such as soil.thickness; "
                                       "brackets, as in \"[column]\", ask for a table that has the name of a kind");
  CLI::Option* markdown = keys->add_flag("--markdown", a.markdown,
                                         "print a page in Markdown in place of comma-separated values");
  keys->add_flag("--json-schema", a.json_schema,
                 "print a JSON schema, with which editors complete and check files; that of cases without a kind")
      ->excludes(markdown);
  keys->callback([&a, &outcome, name] {
    const KeyForm form = a.markdown ? KeyForm::page : (a.json_schema ? KeyForm::schema : KeyForm::table);
    outcome = command_keys(name->count() > 0 ? std::optional(a.name) : std::nullopt, form);
  });
}

/// Describes the commands with their options; `outcome` receives that of the command that was run.
void describe(CLI::App& app, Arguments& a, const std::string& command_text, Outcome& outcome) {
  app.require_subcommand(1);
  app.footer(exit_codes());
  app.set_version_flag("--version",
                       std::string("voussoir ") + build_version + " (" + build_revision + "), " + rank_library());

  CLI::App* run = app.add_subcommand("run", "run a case");
  run->add_option("case", a.file, "case file (TOML)")->required();
  run->add_option("-o,--output", a.output, "folder of the results; default: out/TITLE of the case")->check(not_empty);
  run->add_flag("--resume", a.resume, "go on behind the last checkpoint in the folder");
  run->add_flag("--replace", a.replace, "remove the results of an earlier run in the folder")->excludes("--resume");
  add_threads(*run, a, "number of threads; default: OMP_NUM_THREADS, or one for each core that is available");
  add_take_over(*run, a);
  add_overrides(*run, a);
  run->callback([&] {
    outcome = command_run(a.file, a.overrides, {a.output, a.resume, a.replace, command_text, a.threads, a.take_over});
  });

  CLI::App* check = app.add_subcommand(
      "check", "print every value of a case after defaults and --set, and what the run will cost");
  check->add_option("case", a.file, "case file (TOML)")->required();
  add_overrides(*check, a);
  check->callback([&] { outcome = command_check(a.file, a.overrides); });

  describe_sweep(app, a, command_text, outcome);
  describe_ensemble(app, a, command_text, outcome);
  describe_mesh(app, a, outcome);

  describe_keys(app, a, outcome);

  CLI::App* info = app.add_subcommand("info", "print where a result comes from, and its increments");
  CLI::Option_group* what = info->add_option_group("what");
  what->add_option("result", a.file, "run.h5 of a result");
  what->add_flag("--cpu", a.cpu, "print instead which instruction set the lanes take on this processor, and why");
  what->add_flag("--devices", a.devices, "print instead which GPUs were found, or why none was");
  what->require_option(1);
  info->callback(
      [&] { outcome = a.cpu ? command_info_cpu() : (a.devices ? command_info_devices() : command_info(a.file)); });
}

int complain(Outcome outcome, const std::string& sentence) {
  std::fprintf(stderr, "voussoir: %s\n", sentence.c_str());
  return exit_code(outcome);
}

}  // namespace

int run_command_line(int argc, char** argv) {
  try {
    std::string command_text;
    for (int k = 0; k < argc; ++k) command_text += (k > 0 ? " " : "") + std::string(argv[k]);
    Arguments arguments;
    Outcome outcome = Outcome::done;
    CLI::App app("Tunnelling ground movement by coupled finite and discrete elements", "voussoir");
    describe(app, arguments, command_text, outcome);
    try {
      app.parse(argc, argv);
    } catch (const CLI::Success& help) {
      std::ostringstream text;
      app.exit(help, text, text);
      return exit_code(print_answer(text.str()));
    } catch (const CLI::ParseError& error) {
      if (app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-') {
        return complain(Outcome::wrong_input, "unknown command " + std::string(argv[1]) + " (see --help)");
      }
      return complain(Outcome::wrong_input, std::string(error.what()) + " (see --help)");
    }
    return exit_code(outcome);
  } catch (...) {
    const Failure failure = failure_of(std::current_exception());
    return complain(failure.outcome, failure.sentence);
  }
}

}  // namespace voussoir::host
