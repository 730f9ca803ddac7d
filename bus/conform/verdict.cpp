#include "conform/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "device/device.hpp"
#include "online/sdo_access.hpp"
#include "text/ascii.hpp"

namespace edsc::conform {
namespace {

/// A word of a command, quoted for a shell if necessary.
std::string shell_word(std::string_view word) {
  constexpr std::string_view plain = "_./:@%+=,-";
  const bool is_plain = !word.empty() && std::ranges::all_of(word, [&](char c) {
    return is_letter(c) || is_digit(c) || plain.find(c) != std::string_view::npos;
  });
  if (is_plain) return std::string{word};
  std::string quoted{"'"};
  for (const char c : word) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c;
    }
  }
  return quoted + '\'';
}

/// The failed case at the end of the chain of `CaseRow::cause`.
const CaseResult& root_of(const std::vector<CaseResult>& cases, const CaseResult& failed) {
  const CaseResult* root = &failed;
  for (std::size_t i = 0; i != cases.size() && !root->row->cause.empty(); ++i) {
    const auto above = std::ranges::find_if(cases, [&](const CaseResult& result) {
      return result.row->id == root->row->cause && result.verdict == Verdict::failed;
    });
    if (above == cases.end()) break;
    root = &*above;
  }
  return *root;
}

std::string cause_text(const CaseResult& root) {
  if (!root.rule.text().empty()) {
    return fmt::format("the EDS: {}; rule {} of edsc check reports it", root.got, root.rule.text());
  }
  return fmt::format("{} {}: {}", root.row->id, root.row->title, root.got);
}

/// Whether a failure consists of refused writes that are a part of another failure.
bool is_part_of(const CaseResult& failed, const CaseResult& other) {
  return !failed.refused_writes.empty() && std::ranges::all_of(failed.refused_writes, [&](const RefusedWrite& write) {
    return std::ranges::find(other.refused_writes, write) != other.refused_writes.end();
  });
}

/// `the device refuses to write 1015h:00: 0601 0002h, write of a read-only object`
std::string refused_text(const CaseResult& root) {
  constexpr std::size_t max_named = 5;
  std::string text;
  const std::size_t count = root.refused_writes.size();
  for (std::size_t i = 0; i != std::min(count, max_named); ++i) {
    const RefusedWrite& write = root.refused_writes[i];
    fmt::format_to(std::back_inserter(text), "{}{}: {}", text.empty() ? "the device refuses to write " : "; ",
                   entry_label(write.index, write.sub_index), abort_text(write.code));
  }
  return count <= max_named ? text : fmt::format("{}; and {} more", text, count - max_named);
}

}  // namespace

std::vector<Cause> RunReport::causes() const {
  std::vector<Cause> found;
  std::vector<const CaseResult*> roots;
  for (const CaseResult& result : cases) {
    if (result.verdict != Verdict::failed) continue;
    const CaseResult& root = root_of(cases, result);
    const auto has_same_cause = [&](const CaseResult* other) {
      return other == &root || (!root.rule.text().empty() && other->rule.text() == root.rule.text()) ||
             is_part_of(root, *other);
    };
    const auto number = static_cast<std::size_t>(std::ranges::find_if(roots, has_same_cause) - roots.begin());
    if (number == roots.size()) {
      roots.push_back(&root);
      found.push_back({cause_text(root), {}});
    }
    if (roots[number] != &root && is_part_of(root, *roots[number])) found[number].text = refused_text(*roots[number]);
    found[number].cases.push_back(&result);
  }
  return found;
}

std::vector<MissingCondition> RunReport::missing_conditions() const {
  std::vector<MissingCondition> found;
  for (const CaseResult& result : cases) {
    if (result.verdict != Verdict::inconclusive || result.condition == Condition::none) continue;
    auto same = std::ranges::find_if(found, [&](const MissingCondition& missing) {
      return missing.condition == result.condition && missing.reason == result.reason;
    });
    if (same == found.end()) same = found.insert(same, {result.condition, result.reason, {}});
    same->cases.push_back(&result);
  }
  return found;
}

std::size_t RunReport::count(Verdict verdict) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(cases, [&](const CaseResult& result) { return result.verdict == verdict; }));
}

bool RunReport::passed() const {
  return !cases.empty() && count(Verdict::failed) == 0 && unused_deviations.empty() && not_restored.empty() &&
         !interrupted && lost.empty();
}

std::string repeat_command(const RunReport& run, const CaseRow& row) {
  const Level level = std::max(run.level, row.level);
  const Permission permissions = run.permissions | row.needs;
  std::string command = fmt::format("edsc conform {} {} {}", shell_word(run.bus), run.node, shell_word(run.sheet));
  if (!run.options.empty()) command += " --options " + shell_word(run.options);
  if (level != Level::read) fmt::format_to(std::back_inserter(command), " --level {}", row_of(level).name);
  for (const PermissionRow& permission : permission_options) {
    if (level >= Level::all || !includes(permissions, permission.permission)) continue;
    fmt::format_to(std::back_inserter(command), " {}", permission.option);
  }
  if (run.force) command += " --force";
  fmt::format_to(std::back_inserter(command), " --only {} --seed {}", row.id, run.seed);
  return command;
}

}  // namespace edsc::conform
