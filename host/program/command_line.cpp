#include "host/program/command_line.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/process/build_info.hpp"
#include "host/process/exit_code.hpp"
#include "host/process/standard_streams.hpp"
#include "host/program/commands.hpp"
#include "host/ranks/session.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {
namespace {

struct Arguments {
  std::string file;
  std::string output;
  std::vector<std::string> overrides;
  bool resume = false;
  bool replace = false;
  int threads = 0;
  int processes = 1;
};

void add_overrides(CLI::App& command, Arguments& arguments) {
  command
      .add_option("--set", arguments.overrides,
                  "table.key=value, which replaces the case file's value; may be repeated")
      ->allow_extra_args(false);
}

/// Describes the commands with their options; `code` receives the exit code of the command that was run.
void describe(CLI::App& app, Arguments& a, const std::string& command_text, int& code) {
  app.require_subcommand(1);
  app.set_version_flag("--version",
                       std::string("voussoir ") + build_version + " (" + build_revision + "), " + rank_library());

  CLI::App* run = app.add_subcommand("run", "run a case");
  run->add_option("case", a.file, "case file (TOML)")->required();
  run->add_option("-o,--output", a.output, "folder of the results; default: out/TITLE of the case");
  run->add_flag("--resume", a.resume, "go on behind the last checkpoint in the folder");
  run->add_flag("--replace", a.replace, "remove the results of an earlier run in the folder")->excludes("--resume");
  run->add_option("--threads", a.threads, "number of threads; default: all cores")->check(CLI::Range(1, 4096));
  add_overrides(*run, a);
  run->callback(
      [&] { code = command_run(a.file, a.overrides, {a.output, a.resume, a.replace, command_text, a.threads}); });

  CLI::App* check = app.add_subcommand(
      "check", "print every value of a case after defaults and --set, and what the run will cost");
  check->add_option("case", a.file, "case file (TOML)")->required();
  add_overrides(*check, a);
  check->callback([&] { code = command_check(a.file, a.overrides); });

  CLI::App* sweep = app.add_subcommand("sweep", "run a base case with lists of overrides");
  sweep->add_option("sweep", a.file, "sweep file (TOML)")->required();
  sweep->add_option("-o,--output", a.output, "folder of the results; default: out/STEM of the sweep file");
  sweep->add_option("-j", a.processes, "number of runs at a time")->check(CLI::Range(1, 1024));
  sweep->add_option("--threads", a.threads, "threads of each run")->check(CLI::Range(1, 4096));
  sweep->add_flag("--resume", a.resume, "skip finished runs and go on with interrupted ones");
  sweep->callback([&] {
    code = command_sweep(a.file,
                         {a.output, std::filesystem::read_symlink("/proc/self/exe"), a.processes, a.threads, a.resume});
  });

  CLI::App* info = app.add_subcommand("info", "print where a result comes from, and its increments");
  info->add_option("result", a.file, "run.h5 of a result")->required();
  info->callback([&] { code = command_info(a.file); });
}

int complain(int code, const std::string& sentence) {
  std::fprintf(stderr, "voussoir: %s\n", sentence.c_str());
  return code;
}

}  // namespace

int run_command_line(int argc, char** argv) {
  try {
    std::string command_text;
    for (int k = 0; k < argc; ++k) command_text += (k > 0 ? " " : "") + std::string(argv[k]);
    Arguments arguments;
    int code = exit_ok;
    CLI::App app("Tunnelling ground movement by coupled finite and discrete elements", "voussoir");
    describe(app, arguments, command_text, code);
    try {
      app.parse(argc, argv);
    } catch (const CLI::Success& help) {
      std::ostringstream text;
      app.exit(help, text, text);
      return print_answer(text.str()) ? exit_ok : exit_machine;
    } catch (const CLI::ParseError& error) {
      if (app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-') {
        return complain(exit_input, "unknown command " + std::string(argv[1]) + " (see --help)");
      }
      return complain(exit_input, std::string(error.what()) + " (see --help)");
    }
    return code;
  } catch (const io::InputError& error) {
    return complain(exit_input, error.what());
  } catch (const std::invalid_argument& error) {
    return complain(exit_input, error.what());
  } catch (const std::bad_alloc&) {
    return complain(exit_machine, "out of memory");
  } catch (const std::exception& error) {
    return complain(exit_machine, error.what());
  }
}

}  // namespace voussoir::host
