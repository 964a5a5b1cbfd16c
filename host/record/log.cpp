#include "host/record/log.hpp"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "host/process/standard_streams.hpp"
#include "host/ranks/session.hpp"

namespace voussoir::host {
namespace {

constexpr const char* failure_mark = " failed: ";

/// One line about a failure of spdlog, whose own sentence ends in the file's name, a colon and the reason.
std::runtime_error failure_of(const std::string& file, const std::string& said) {
  const std::size_t colon = said.rfind(": ");
  return std::runtime_error(file +
                            ": cannot be written: " + (colon == std::string::npos ? said : said.substr(colon + 2)));
}

}  // namespace

RunLog::RunLog(const std::filesystem::path& file, bool append)
    : terminal_(isatty(STDOUT_FILENO) != 0 && rank_count() == 1) {
  // A pipe of this name would wait for a reader for ever.
  if (std::filesystem::is_fifo(file) || std::filesystem::is_directory(file)) {
    throw std::runtime_error(file.string() + ": cannot be written: it is a folder or a pipe");
  }
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_st>(file.string(), !append);
    file_ = std::make_shared<spdlog::logger>("run", std::move(sink));
  } catch (const spdlog::spdlog_ex& error) {
    throw failure_of(file.string(), error.what());
  }
  // spdlog would print its own lines on stderr, once a second, and go on without a log.
  file_->set_error_handler([name = file.string()](const std::string& said) { throw failure_of(name, said); });
  file_->set_pattern("%Y-%m-%dT%H:%M:%SZ %L %v", spdlog::pattern_time_type::utc);
  file_->flush_on(spdlog::level::info);
}

RunLog::~RunLog() { clear_live(); }

void RunLog::clear_live() {
  if (live_width_ == 0) return;
  std::printf("\r%*s\r", static_cast<int>(live_width_), "");
  live_width_ = 0;
}

void RunLog::show(const std::string& text) {
  clear_live();
  std::printf("%s\n", text.c_str());
  if (const auto reason = lost_output()) {
    terminal_ = false;
    file_->warn("standard output cannot be written any more ({}); the run goes on, and its lines are in this file only",
                *reason);
  }
}

void RunLog::line(const std::string& text) {
  show(text);
  file_->info(text);
}

void RunLog::failure(const std::string& stage, const std::string& reason) { line(stage + failure_mark + reason); }

void RunLog::warning(const std::string& text) {
  show("warning: " + text);
  file_->warn(text);
}

void RunLog::detail(const std::string& text) { file_->info(text); }

void RunLog::live(const std::string& text) {
  if (!terminal_) return;
  clear_live();
  std::printf("%s", text.c_str());
  std::fflush(stdout);
  live_width_ = text.size();
}

std::string last_failure(const std::filesystem::path& file) {
  std::ifstream text(file);
  std::string found;
  for (std::string line; std::getline(text, line);) {
    const std::size_t mark = line.find(failure_mark);
    if (mark == std::string::npos) continue;
    const std::size_t before = line.rfind(' ', mark - 1);  // the time and the level stand before the stage
    found = line.substr(before == std::string::npos ? 0 : before + 1);
  }
  return found;
}

}  // namespace voussoir::host
