#include "conform/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

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

}  // namespace

std::size_t RunReport::count(Verdict verdict) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(cases, [&](const CaseResult& result) { return result.verdict == verdict; }));
}

bool RunReport::passed() const {
  return !cases.empty() && count(Verdict::failed) == 0 && unused_deviations.empty() && not_put_back.empty() &&
         !interrupted && lost.empty();
}

std::string repeat_command(const RunReport& run, const CaseRow& row) {
  const Level level = std::max(run.level, row.level);
  const Permission permissions = run.permissions | row.needs;
  std::string command = fmt::format("edsc conform {} {} {}", shell_word(run.bus), run.node, shell_word(run.sheet));
  if (!run.options.empty()) command += " --options " + shell_word(run.options);
  if (level != Level::read) fmt::format_to(std::back_inserter(command), " --level {}", row_of(level).name);
  for (const PermissionRow& permission : permission_options) {
    if (level == Level::all || !includes(permissions, permission.permission)) continue;
    fmt::format_to(std::back_inserter(command), " {}", permission.option);
  }
  fmt::format_to(std::back_inserter(command), " --only {} --seed {}", row.id, run.seed);
  return command;
}

}  // namespace edsc::conform
