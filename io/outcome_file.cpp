#include "io/outcome_file.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "io/atomic_file.hpp"
#include "io/text_file.hpp"

namespace voussoir::io {
namespace {

constexpr std::size_t most_bytes = 100'000;
constexpr std::uint64_t most_code = 255;  ///< exit codes of processes

}  // namespace

void write_outcome(const std::filesystem::path& file, const RunOutcome& outcome) {
  const nlohmann::ordered_json text{
      {"status", outcome.status}, {"exit_code", outcome.exit_code}, {"reason", outcome.reason}};
  write_text(file, text.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

std::optional<RunOutcome> read_outcome(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    const auto text = nlohmann::json::parse(read_text_file(file, most_bytes));
    const auto& code = text.at("exit_code");
    if (!code.is_number_unsigned() || code.get<std::uint64_t>() > most_code)
      throw std::runtime_error(fmt::format("its exit_code is none of 0 to {}", most_code));
    return RunOutcome{text.at("status").get<std::string>(), code.get<int>(), text.at("reason").get<std::string>()};
  } catch (const std::exception& damage) {
    throw std::runtime_error(
        fmt::format("{} is no outcome of a run: {}; remove it, and run this run again with --resume", file.string(),
                    in_one_line(damage.what())));
  }
}

}  // namespace voussoir::io
