/// A rule: one kind of fault or change that edsc reports. The tables of all commands have this row: check_rules.hpp
/// (`edsc check`, `edsc network check`), audit/audit_rules.hpp (`edsc audit`), compare/change_rules.hpp (`edsc diff`).
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <string_view>

// Clang before 16 ends with a segmentation fault where a rule is made at compile time within an expression. It makes
// them when the program runs; other compilers report an unknown id.
#if defined(__clang__) && __clang_major__ < 16
#define EDSC_RULES_AT_RUN_TIME
#define EDSC_CONSTEVAL constexpr
#else
#define EDSC_CONSTEVAL consteval
#endif

namespace edsc {

enum class Severity : std::uint8_t { note, warning, error };

[[nodiscard]] constexpr std::string_view to_string(Severity severity) {
  constexpr std::string_view words[] = {"note", "warning", "error"};
  return words[static_cast<std::size_t>(severity)];
}

/// What a change between two versions of a device breaks.
struct Breaks {
  bool master = false;   ///< programs that access the device by SDO, or supervise it
  bool pdo = false;      ///< devices that send its RPDOs or receive its TPDOs
  bool source = false;   ///< code that is compiled against the generated headers
  bool storage = false;  ///< parameters that the device has stored are not loaded

  [[nodiscard]] constexpr bool any() const { return master || pdo || source || storage; }
};

struct Rule {
  std::string_view id;  ///< as printed and as users write it; stable
  Severity severity;    ///< of most findings
  std::string_view title;
  std::string_view source;            ///< clause of a CiA document or standard, or "edsc" for a rule of edsc
  Severity mildest = severity;        ///< if the value can still be read, or the fault is harmless
  std::string_view explanation = {};  ///< how it is checked, what to look at, or why a change breaks something
  bool is_fatal = false;              ///< an error stops edsc even with `--keep-going`: no device can be resolved
  Breaks breaks = {};                 ///< of a rule about changes
  bool is_of_names = false;           ///< notes about names of the generated code, for commands that write it
  std::string_view former_id = {};    ///< as the previous version wrote it; it is read for one version, with a note

  [[nodiscard]] constexpr bool allows(Severity other) const { return other == severity || other == mildest; }
};

namespace rule_table {
inline constexpr auto note = Severity::note;
inline constexpr auto error = Severity::error;
inline constexpr auto warning = Severity::warning;

inline constexpr Rule no_rule{"", error, "", ""};
}  // namespace rule_table

/// A row of a rule table. Ids are equal if they are the same row; their order is the one of the table.
class RuleId {
 public:
  /// No rule: of a finding that no table has. Its text is empty.
  constexpr RuleId() = default;
  constexpr explicit RuleId(const Rule& row) : row_{&row} {}

  [[nodiscard]] constexpr const Rule& row() const { return *row_; }
  [[nodiscard]] constexpr std::string_view text() const { return row_->id; }

  friend constexpr bool operator==(const RuleId&, const RuleId&) = default;
  friend constexpr auto operator<=>(const RuleId&, const RuleId&) = default;

 private:
  const Rule* row_ = &rule_table::no_rule;
};

/// Returns the rule whose id, or former id, is `text`: what a user wrote.
[[nodiscard]] constexpr std::optional<RuleId> find_rule(std::span<const Rule> table, std::string_view text) {
  if (text.empty()) return std::nullopt;
  const auto at = std::ranges::find_if(table, [&](const Rule& row) { return row.id == text || row.former_id == text; });
  return at == table.end() ? std::nullopt : std::optional{RuleId{*at}};
}

namespace rule_table {
/// Names in the compiler's error for an unknown id, or a severity that the row does not allow.
#ifdef EDSC_RULES_AT_RUN_TIME
[[noreturn]] inline void no_such_rule() { std::abort(); }
[[noreturn]] inline void severity_is_not_in_the_row_of_the_rule() { std::abort(); }
#else
void no_such_rule();
void severity_is_not_in_the_row_of_the_rule();
#endif

template <Severity severity, Severity... others>
inline constexpr bool is_one_of = ((severity == others) || ...);
}  // namespace rule_table

/// The id of a row of `table` whose findings may have each of these severities. It is made from its text. An id that
/// the table does not have, or a severity that its row does not allow, does not compile; a program that Clang before 16
/// has compiled ends when it uses one.
template <const auto& table, Severity... severities>
class RuleOf : public RuleId {
 public:
  EDSC_CONSTEVAL RuleOf(const char* id) : RuleId{row_with(id)} {
    if (!(row().allows(severities) && ...)) rule_table::severity_is_not_in_the_row_of_the_rule();
  }
  /// A rule with several severities converts to a rule with some of them.
  template <Severity... others>
  requires(sizeof...(others) > sizeof...(severities) && (rule_table::is_one_of<severities, others...> &&
                                                         ...)) constexpr RuleOf(const RuleOf<table, others...>& other)
      : RuleId{other} {}

 private:
  static EDSC_CONSTEVAL const Rule& row_with(std::string_view id) {
    const auto found = find_rule(table, id);
    if (!found) rule_table::no_such_rule();
    return found->row();
  }
};

}  // namespace edsc
