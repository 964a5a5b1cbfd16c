#pragma once
/// The exception for everything that a user wrote wrong.

#include <stdexcept>
#include <string>

namespace voussoir::io {

/// A mistake of the user, as one line: "case.toml:12: ground.depth: must be positive, is -3 m". The place is
/// "file:line", or "--set" for a value given on the command line.
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& place, const std::string& key, const std::string& sentence);

  [[nodiscard]] const std::string& place() const { return place_; }
  [[nodiscard]] const std::string& key() const { return key_; }  ///< empty where the file itself has the mistake
  [[nodiscard]] const std::string& sentence() const { return sentence_; }

 private:
  std::string place_, key_, sentence_;
};

}  // namespace voussoir::io
