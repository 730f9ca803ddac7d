/// Diagnostics: faults with severity and position.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnostics/allowances.hpp"
#include "diagnostics/position.hpp"
#include "diagnostics/remedy.hpp"
#include "rules/check_rules.hpp"

namespace edsc {

struct Note {
  Position position;
  std::string message;
};

struct Diagnostic {
  Severity severity = Severity::error;
  RuleId rule;
  Position position;
  std::string message;
  std::vector<Note> notes;  ///< related positions
  /// Findings of one rule with the same cause are merged: the notes list the next places, and `places` counts all of
  /// them. A finding without a cause is never merged.
  std::string cause;
  std::size_t places = 1;
  std::size_t unnamed = 0;  ///< number of places that are neither `position` nor in the notes
  /// The finding from which this one follows, an index in `Diagnostics::all()`. It is never more severe than that one.
  std::optional<std::size_t> follows_from = {};

  /// Number of places of a cause that a text shows at first.
  static constexpr std::size_t max_places = 4;
  /// Maximum number of stored places per cause.
  static constexpr std::size_t max_stored_places = 1000;
  /// Adds another place with the same cause: to the notes, or only to the numbers.
  void add_place(const Position& place, std::string text);
};

/// The notes that a command reports.
enum class Notes : std::uint8_t {
  none,
  without_names,  ///< all but those about names of the generated code: `edsc check`
  of_names,       ///< only those: `edsc generate`
};

/// The number of findings of each severity.
struct SeverityCounts {
  std::array<std::size_t, 3> counts{};

  [[nodiscard]] std::size_t& operator[](Severity severity) { return counts[static_cast<std::size_t>(severity)]; }
  [[nodiscard]] std::size_t operator[](Severity severity) const { return counts[static_cast<std::size_t>(severity)]; }
};

/// Collects the findings for one or more files, in the order in which they are reported.
class Diagnostics {
 public:
  void error(ErrorRule rule, const Position& position, std::string message, std::vector<Note> notes = {},
             std::string cause = {}) {
    report({Severity::error, rule, position, std::move(message), std::move(notes), std::move(cause)});
  }
  void warning(WarningRule rule, const Position& position, std::string message, std::vector<Note> notes = {},
               std::string cause = {}) {
    report({Severity::warning, rule, position, std::move(message), std::move(notes), std::move(cause)});
  }
  void note(NoteRule rule, const Position& position, std::string message, std::vector<Note> notes = {},
            std::string cause = {}) {
    report({Severity::note, rule, position, std::move(message), std::move(notes), std::move(cause)});
  }
  /// Reports a finding with the usual severity of the rule.
  void usual(AnyRule rule, const Position& position, std::string message, std::vector<Note> notes = {},
             std::string cause = {}) {
    report({rule.row().severity, rule, position, std::move(message), std::move(notes), std::move(cause)});
  }
  /// Adds a finding of another collection.
  void report(Diagnostic diagnostic);

  /// Drops the warnings and notes of a rule; its errors remain, since they cause parts of the device to be skipped.
  void silence(RuleId rule);
  /// Sets aside the findings to which an allowance applies: warnings and notes, but not errors, as in silence().
  void set_outline(SheetOutline outline) { allowances_.set_outline(std::move(outline)); }
  [[nodiscard]] const SheetOutline& outline() const { return allowances_.outline(); }
  void allow(Allowance allowance) { allowances_.add(std::move(allowance)); }
  /// From now on, errors are dropped or set aside too: for `edsc check`, which does not generate anything.
  void silence_errors() { silence_errors_ = true; }
  /// Whether a warning or an error was dropped or set aside.
  [[nodiscard]] bool any_silenced() const { return any_silenced_; }
  /// Whether silence() of this rule has dropped a finding.
  [[nodiscard]] bool has_silenced(RuleId rule) const;
  /// From now on, errors at positions in `file` become warnings (`--keep-going`), for files that the user cannot
  /// change, except errors of fatal rules. Such a warning can still be silenced.
  void keep_going(const SourceFile* file) { foreign_file_ = file; }
  /// From now on, warnings count as errors (`--strict`); notes do not.
  void treat_warnings_as_errors() { strict_ = true; }

  /// From now on, only these notes are reported. At first all are, but those about names of the generated code.
  void limit_notes(Notes notes) { notes_ = notes; }

  /// States that a finding follows from another one; both are indices in `all()`.
  void set_cause(std::size_t consequence, std::size_t cause) { all_[consequence].follows_from = cause; }

  /// From now on, remedies are stored: for `edsc check --repair`.
  void collect_remedies() { collects_remedies_ = true; }
  /// Offers the remedy of a finding that is reported too. That of a silenced or allowed finding is not stored.
  void offer(Remedy remedy);
  /// `text` replaces the value of a field.
  void offer_value(AnyRule rule, const Position& value, std::string text, std::string reason) {
    offer({Remedy::Kind::value, rule, value, {}, std::move(text), std::move(reason)});
  }
  /// A section gets a key.
  void offer_key(AnyRule rule, const Position& section, std::string key, std::string text, std::string reason) {
    offer({Remedy::Kind::key, rule, section, std::move(key), std::move(text), std::move(reason)});
  }
  [[nodiscard]] const std::vector<Remedy>& remedies() const { return remedies_; }

  /// The listed findings. `errors()`, `warnings()` and `notes()` also count the omitted ones.
  [[nodiscard]] const std::vector<Diagnostic>& all() const { return all_; }
  [[nodiscard]] std::size_t errors() const { return counts_[Severity::error]; }
  [[nodiscard]] std::size_t warnings() const { return counts_[Severity::warning]; }
  [[nodiscard]] std::size_t notes() const { return counts_[Severity::note]; }
  /// The number of findings of `rule` in `file` after the first `max_per_rule`, which are counted only.
  struct Omitted {
    const SourceFile* file;
    RuleId rule;
    Severity severity;
    std::size_t count;
    std::size_t last_listed;  ///< index in `all()` of the last listed one of this kind
  };
  [[nodiscard]] const std::vector<Omitted>& omitted() const { return omitted_; }
  /// Whether the next finding of this kind will be counted only, so that it does not need a message.
  [[nodiscard]] bool counts_only(AnyRule rule, Severity severity, const SourceFile* file) const;

  /// A finding that an allowance set aside, a suppression in SARIF, and the index of the allowance in `allowances()`.
  /// At most `max_per_rule` are stored per allowance.
  struct Suppressed {
    Diagnostic diagnostic;
    std::size_t allowance;
  };
  [[nodiscard]] const std::vector<Suppressed>& suppressed() const { return suppressed_; }
  [[nodiscard]] const std::vector<Allowance>& allowances() const { return allowances_.all(); }
  /// The number of findings that allowances set aside.
  [[nodiscard]] std::size_t suppressed_findings() const { return suppressed_findings_; }

  /// Maximum number of listed findings of one rule and severity per file; any more are counted only.
  static constexpr std::size_t max_per_rule = 50;

 private:
  struct Kind {
    const SourceFile* file;
    RuleId rule;
    Severity severity;
    auto operator<=>(const Kind&) const = default;
  };
  struct Cause {
    Kind kind;
    std::string words;
    auto operator<=>(const Cause&) const = default;
  };
  struct Silenced {
    RuleId rule;
    bool has_fired = false;
  };
  struct Tally {
    std::size_t found = 0;
    std::size_t last_listed = 0;  ///< in `all_`
    std::size_t omitted_row = 0;  ///< in `omitted_`, once more than `max_per_rule` were found
  };

  /// Whether the finding is another place of a listed finding, or of one that is only counted.
  bool join(const Kind& kind, Diagnostic& diagnostic);
  [[nodiscard]] bool is_tolerated(const Diagnostic& diagnostic) const;
  [[nodiscard]] bool drop_silenced(const Diagnostic& diagnostic);
  [[nodiscard]] bool set_aside(Diagnostic& diagnostic);

  std::vector<Diagnostic> all_;
  std::map<Kind, Tally> tallies_;
  std::map<Cause, std::size_t> first_of_cause_;  ///< index in `all_`; may be beyond its end
  std::vector<Omitted> omitted_;
  std::vector<Silenced> silenced_;
  SeverityCounts counts_;
  bool strict_ = false;
  Notes notes_ = Notes::without_names;
  bool silence_errors_ = false;
  bool any_silenced_ = false;
  bool collects_remedies_ = false;
  std::vector<Remedy> remedies_;
  Allowances allowances_;
  std::vector<Suppressed> suppressed_;
  std::size_t suppressed_findings_ = 0;
  const SourceFile* foreign_file_ = nullptr;
};

}  // namespace edsc
