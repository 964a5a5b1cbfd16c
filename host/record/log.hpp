#pragma once
/// The log of a run: lines with their time in DIR/run.log, the same lines without the time on standard output, and one
/// live line at the foot of a terminal, which shows the progress and is never written to a file.

#include <spdlog/fwd.h>

#include <filesystem>
#include <memory>
#include <string>

namespace voussoir::host {

class RunLog {
 public:
  /// Starts `file` anew, or goes on at its end. This and all members that write to the file throw std::runtime_error
  /// naming the file where it cannot be written. Standard output may fail: one line in the file says so, and the lines
  /// are in the file only from then on.
  RunLog(const std::filesystem::path& file, bool append);
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  void line(const std::string& text);  ///< writes to the file and to standard output
  /// The same for the line that says why a stage found no equilibrium: "volume_loss failed: max_iterations ...".
  void failure(const std::string& stage, const std::string& reason);
  void warning(const std::string& text);  ///< writes to both and marks the line as a warning
  void detail(const std::string& text);   ///< writes to the file only
  void live(const std::string& text);     ///< replaces the live line; does nothing unless standard output is a terminal

 private:
  void clear_live();
  void show(const std::string& text);

  std::shared_ptr<spdlog::logger> file_;
  bool terminal_;
  std::size_t live_width_ = 0;
};

/// The last line that RunLog::failure wrote into a file, without its time; empty where there is none.
[[nodiscard]] std::string last_failure(const std::filesystem::path& file);

}  // namespace voussoir::host
