#pragma once
/// What a run says while it runs: plain lines with their time in DIR/run.log and on the terminal, and one live line at
/// the foot of a terminal, which is never written to a file.

#include <filesystem>
#include <memory>
#include <string>

namespace spdlog {
class logger;
}

namespace voussoir::host {

class RunLog {
 public:
  /// Starts `file` anew, or goes on at its end. Throws std::runtime_error where it cannot be written.
  RunLog(const std::filesystem::path& file, bool append);
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  void line(const std::string& text);     ///< to the file and to standard output
  void warning(const std::string& text);  ///< the same, marked
  void detail(const std::string& text);   ///< to the file only
  void live(const std::string& text);     ///< replaces the live line; nothing where standard output is no terminal

 private:
  void clear_live();

  std::shared_ptr<spdlog::logger> file_;
  bool terminal_;
  std::size_t live_width_ = 0;
};

}  // namespace voussoir::host
