/// The answers of a case file that has been read: unknown keys, the resolved case, its fingerprint.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>

#include "io/case_file.hpp"
#include "io/case_node.hpp"
#include "io/hash.hpp"
#include "io/near_names.hpp"

namespace voussoir::io {

namespace {

using Kind = CaseNode::Kind;

void collect_known(const CaseNode& node, std::vector<const CaseNode*>& known) {
  for (const auto& child : node.children) {
    if (child->read) {
      known.push_back(child.get());
      collect_known(*child, known);
    }
  }
}

/// A hint at a known key with nearly this name in the same table, or with this very name in another table; empty when
/// there is none.
std::string hint(const CaseNode& root, const CaseNode& parent, const CaseNode& unknown) {
  std::vector<std::string> names;
  for (const auto& sibling : parent.children) {
    if (sibling->read && sibling->name.front() != '[') names.push_back(sibling->name);
  }
  std::string name = nearest_name(names, unknown.name);
  if (name.empty()) {
    std::vector<const CaseNode*> known;
    collect_known(root, known);
    const auto same = std::find_if(known.begin(), known.end(),
                                   [&](const CaseNode* node) { return node->name == unknown.name; });
    name = same == known.end() ? "" : (*same)->key;
  }
  return name.empty() ? "" : fmt::format("; did you mean \"{}\"?", name);
}

[[noreturn]] void refuse(const CaseNode& root, const CaseNode& parent, const CaseNode& unknown) {
  throw InputError(unknown.place, unknown.key, "unknown key" + hint(root, parent, unknown));
}

void refuse_unknown(const CaseNode& root, const CaseNode& node) {
  for (const auto& child : node.children) {
    if (!child->read) refuse(root, node, *child);
    if (child->kind == Kind::table || child->kind == Kind::array) {
      refuse_unknown(root, *child);
    }
  }
}

/// What a file of all keys knows under this name: the key itself, any entry of an array, or the key whose name the user
/// chooses; null where there is none.
const CaseNode* known_under(const CaseNode& known, const std::string& name) {
  const CaseNode* any = nullptr;
  for (const auto& child : known.children) {
    if (!child->read) continue;
    if (child->name == name) return child.get();
    if (!child->placeholder.empty() || child->name.front() == '[') any = child.get();
  }
  return any;
}

/// The same for a file that was not read to its end: `known` is the node of another file in which all keys were read.
void refuse_unknown(const CaseNode& known_root, const CaseNode& known, const CaseNode& node) {
  for (const auto& child : node.children) {
    if (child->read && child->children.empty()) continue;
    const CaseNode* twin = known_under(known, child->name);
    if (twin == nullptr) {
      if (!child->read) refuse(known_root, known, *child);
      continue;
    }
    const bool is_one_for_many = child->kind == Kind::table && twin->kind == Kind::array && !twin->children.empty();
    if (is_one_for_many) twin = twin->children.front().get();  // [grid] in place of [[grid]]
    const bool holds_keys = !twin->info || twin->info->type == KeyType::table;
    if (holds_keys && twin->kind == child->kind) refuse_unknown(known_root, *twin, *child);
  }
}

bool is_array_of_tables(const CaseNode& node) {
  return node.kind == Kind::array && !node.children.empty() && node.children.front()->kind == Kind::table;
}

std::string origin_comment(const CaseNode& node) {
  if (!node.written) {
    return "  # default";
  }
  if (!node.origin.empty()) return "  # " + node.origin;
  return node.place == "--set" ? "  # --set" : "";
}

/// The key, without quotes where TOML allows that.
std::string toml_key(const std::string& name) {
  const bool bare = std::all_of(name.begin(), name.end(),
                                [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
  return bare && !name.empty() ? name : toml_text(name);
}

void emit(const CaseNode& node, const std::string& header, std::string& out) {
  for (const auto& child : node.children) {
    if (!child->resolved.empty()) {
      out += fmt::format("{} = {}{}\n", toml_key(child->name), child->resolved, origin_comment(*child));
    }
  }
  for (const auto& child : node.children) {
    const std::string child_header = header.empty() ? toml_key(child->name) : header + "." + toml_key(child->name);
    if (child->kind == Kind::table && child->read) {
      out += fmt::format("\n[{}]\n", child_header);
      emit(*child, child_header, out);
    } else if (is_array_of_tables(*child)) {
      for (const auto& entry : child->children) {
        out += fmt::format("\n[[{}]]\n", child_header);
        emit(*entry, child_header, out);
      }
    }
  }
}

bool is_within(const std::string& key, const std::string& table) {
  return key.starts_with(table) && (key.size() == table.size() || key[table.size()] == '.' || key[table.size()] == '[');
}

void collect_meanings(const CaseNode& node, std::span<const std::string> without, std::vector<std::string>& lines) {
  for (const auto& child : node.children) {
    if (std::any_of(without.begin(), without.end(), [&](const auto& table) { return is_within(child->key, table); })) {
      continue;
    }
    if (!child->meaning.empty()) {
      lines.push_back(fmt::format("{}={}\n", child->key, child->meaning));
    } else {
      collect_meanings(*child, without, lines);
    }
  }
}

}  // namespace

void CaseFile::finish() const { refuse_unknown(state_->root, state_->root); }

void CaseFile::finish_as(const CaseFile& known) const {
  refuse_unknown(known.state_->root, known.state_->root, state_->root);
}

std::string CaseFile::resolved() const {
  std::string out;
  emit(state_->root, "", out);
  return out;
}

std::string CaseFile::fingerprint(std::span<const std::string> without) const {
  std::vector<std::string> lines;
  collect_meanings(state_->root, without, lines);
  std::sort(lines.begin(), lines.end());
  return fingerprint_of(std::accumulate(lines.begin(), lines.end(), std::string{}));
}

}  // namespace voussoir::io
