/// Keys that a case gives and its run does not use.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "io/case_file.hpp"
#include "io/case_node.hpp"

namespace voussoir::io {

namespace {

/// The keys that do not count for one reason.
struct Idle {
  std::string reason;
  std::vector<std::string> keys;
  std::string place;  ///< of the first key
};

void note(const CaseNode& node, const std::string& reason, std::vector<Idle>& all) {
  const auto same = std::find_if(all.begin(), all.end(), [&](const Idle& idle) { return idle.reason == reason; });
  Idle& idle = same != all.end() ? *same : all.emplace_back(Idle{reason, {}, node.place});
  idle.keys.push_back(node.key);
}

/// Collects the written values below `node`, without those that another table was given and this one has taken over. A
/// reason holds for all that lies below the node that has it.
void collect(const CaseNode& node, const std::string& inherited, std::vector<Idle>& all) {
  const std::string& reason = node.idle.empty() ? inherited : node.idle;
  const bool is_value = !node.resolved.empty();
  if (is_value && node.written && node.origin.empty() && !reason.empty()) note(node, reason, all);
  if (is_value) return;  // the entries of an array belong to their key
  for (const auto& child : node.children) collect(*child, reason, all);
}

}  // namespace

void Table::declare_idle(std::string_view key, const std::string& reason) const {
  CaseNode* node = node_;
  for (std::string_view rest = key; !rest.empty() && node != nullptr;) {
    const std::size_t end = std::min(rest.find_first_of(".[", 1), rest.size());
    node = node->find(rest.substr(0, end));
    rest.remove_prefix(end < rest.size() && rest[end] == '.' ? end + 1 : end);
  }
  if (node == nullptr || !node->read) throw std::logic_error(full_key(key) + " is declared idle but was never read");
  if (node->idle.empty()) node->idle = reason;
}

std::vector<std::string> CaseFile::idle_keys() const {
  std::vector<Idle> all;
  collect(state_->root, "", all);
  std::vector<std::string> lines;
  for (const Idle& idle : all) {
    lines.push_back(fmt::format("{} ({}): not used, because {}", fmt::join(idle.keys, ", "), idle.place, idle.reason));
  }
  return lines;
}

}  // namespace voussoir::io
