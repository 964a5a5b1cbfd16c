#include "host/record/log.hpp"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "host/ranks/session.hpp"

namespace voussoir::host {

RunLog::RunLog(const std::filesystem::path& file, bool append)
    : terminal_(isatty(STDOUT_FILENO) != 0 && rank_count() == 1) {
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_st>(file.string(), !append);
    file_ = std::make_shared<spdlog::logger>("run", std::move(sink));
  } catch (const spdlog::spdlog_ex& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
  file_->set_pattern("%Y-%m-%dT%H:%M:%SZ %L %v", spdlog::pattern_time_type::utc);
  file_->flush_on(spdlog::level::info);
}

RunLog::~RunLog() { clear_live(); }

void RunLog::clear_live() {
  if (live_width_ == 0) return;
  std::printf("\r%*s\r", static_cast<int>(live_width_), "");
  live_width_ = 0;
}

void RunLog::line(const std::string& text) {
  clear_live();
  std::printf("%s\n", text.c_str());
  std::fflush(stdout);
  file_->info(text);
}

void RunLog::warning(const std::string& text) {
  clear_live();
  std::printf("warning: %s\n", text.c_str());
  std::fflush(stdout);
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

}  // namespace voussoir::host
