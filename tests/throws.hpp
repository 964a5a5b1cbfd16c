#pragma once
/// A refusal is told by what it says, not by its type alone.

#include <gtest/gtest.h>

#include <source_location>
#include <string>

/// `call` throws an Exception whose sentence holds `part`.
template <class Exception, class Call>
void expect_throws(const Call& call, const std::string& part,
                   const std::source_location& where = std::source_location::current()) {
  const testing::ScopedTrace trace(where.file_name(), static_cast<int>(where.line()), "called from here");
  try {
    call();
    ADD_FAILURE() << "nothing is thrown that says \"" << part << "\"";
  } catch (const Exception& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
        << "\"" << error.what() << "\" does not say \"" << part << "\"";
  }
}
