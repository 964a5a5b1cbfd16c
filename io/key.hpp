#pragma once
/// The name of a key and the sentence that explains it. Both stand where the key is read, and nowhere else: the lists
/// of `voussoir keys`, docs/reference/keys.md and the schemas for editors are made of them.

#include <stdexcept>
#include <string_view>

namespace voussoir::io {

/// Written as `{"thickness", "Thickness of a representative volume element out of the plane."}`. A key without a
/// sentence that begins with a capital letter and ends with a full stop does not compile.
class Key {
 public:
  // NOLINTNEXTLINE(google-explicit-constructor): a pair in braces is a key
  consteval Key(const char* key_name, const char* sentence) : name(key_name), help(sentence) {
    const bool is_sentence = !help.empty() && help.front() >= 'A' && help.front() <= 'Z' && help.back() == '.';
    if (name.empty() || !is_sentence) throw std::invalid_argument("a key without a sentence");
  }

  std::string_view name, help;
};

}  // namespace voussoir::io
