/// Diagnostics: what is wrong, how bad it is, and where it stands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "diagnostics/allowances.hpp"
#include "diagnostics/position.hpp"
#include "diagnostics/rule.hpp"

namespace edsc {

[[nodiscard]] std::string_view to_string(Severity severity);

struct Note {
  Position position;
  std::string message;
};

struct Diagnostic {
  Severity severity = Severity::error;
  std::string_view rule;  ///< id of a row of the rule table; lives as long as the program
  Position position;
  std::string message;
  std::vector<Note> notes;  ///< further places that explain the first
  /// Findings of one rule with the same cause are one: the notes name the next places, and `places` counts all of them.
  /// Without a cause, a finding is on its own.
  std::string cause;
  std::size_t places = 1;
  std::size_t unnamed = 0;  ///< how many of the places are neither `position` nor among the notes
};

/// Collects what the passes over one or more files find, in the order they find it.
class Diagnostics {
 public:
  void error(ErrorRule rule, const Position& position, std::string message, std::vector<Note> notes = {},
             std::string cause = {});
  void warning(WarningRule rule, const Position& position, std::string message, std::vector<Note> notes = {},
               std::string cause = {});
  void note(NoteRule rule, const Position& position, std::string message, std::vector<Note> notes = {},
            std::string cause = {});
  /// A finding of the severity that the rule usually has.
  void usual(AnyRule rule, const Position& position, std::string message, std::vector<Note> notes = {},
             std::string cause = {});
  /// Takes over a finding of another collection.
  void report(Diagnostic diagnostic);

  /// Drops the warnings and notes of a rule; its errors stay, since what is wrong with them is left out of the device.
  void silence(std::string rule);
  /// Findings that an allowance applies to are set aside: warnings and notes, but no errors, as in silence().
  void set_outline(SheetOutline outline) { allowances_.set_outline(std::move(outline)); }
  void allow(Allowance allowance) { allowances_.add(std::move(allowance)); }
  /// From here on errors are dropped or set aside as well: for `edsc check`, which makes nothing of the device.
  void silence_errors() { silence_errors_ = true; }
  /// Whether a warning or an error was dropped or set aside.
  [[nodiscard]] bool any_silenced() const { return any_silenced_; }
  /// Whether silence() of this rule has dropped a finding.
  [[nodiscard]] bool has_silenced(std::string_view rule) const;
  /// From here on errors at places in `file` are warnings (`--keep-going`): who reads the file of another manufacturer
  /// cannot mend it. Those of the rules in `fatal` stay errors. A warning of this kind may still be silenced.
  void keep_going(const SourceFile* file, std::span<const std::string_view> fatal) {
    foreign_file_ = file;
    fatal_rules_ = fatal;
  }
  /// From here on a warning counts as an error (`--strict`). A note stays a note.
  void treat_warnings_as_errors() { strict_ = true; }

  /// From here on notes are dropped: `edsc check` shows them, no other command does.
  void drop_notes() { drop_notes_ = true; }

  /// The listed findings. `errors()`, `warnings()` and `notes()` count the suppressed ones too.
  [[nodiscard]] const std::vector<Diagnostic>& all() const { return all_; }
  [[nodiscard]] std::size_t errors() const { return errors_; }
  [[nodiscard]] std::size_t warnings() const { return warnings_; }
  [[nodiscard]] std::size_t notes() const { return notes_; }
  /// How many findings of `rule` in `file` came after the first `most_per_rule` and were counted only.
  struct Suppressed {
    const SourceFile* file;
    std::string_view rule;
    Severity severity;
    std::size_t count;
    std::size_t last_listed;  ///< where in `all()` the last listed one of this kind stands
  };
  [[nodiscard]] const std::vector<Suppressed>& suppressed() const { return suppressed_; }
  /// Whether the next finding of this kind is counted only, so that its message is not needed.
  [[nodiscard]] bool counts_only(std::string_view rule, Severity severity, const SourceFile* file) const;

  /// A finding that was set aside, and its place in `allowances()`. At most `most_per_rule` for each allowance are kept.
  struct Allowed {
    Diagnostic diagnostic;
    std::size_t allowance;
  };
  [[nodiscard]] const std::vector<Allowed>& allowed() const { return allowed_; }
  [[nodiscard]] const std::vector<Allowance>& allowances() const { return allowances_.all(); }
  /// How many findings were set aside.
  [[nodiscard]] std::size_t allowed_findings() const { return allowed_findings_; }

  /// A rule that fires more often than this in one file (and with one severity) is counted, not listed: nobody reads
  /// the 51st.
  static constexpr std::size_t most_per_rule = 50;
  /// Of the places with one cause, so many are named.
  static constexpr std::size_t most_places = 4;

 private:
  struct Kind {
    const SourceFile* file;
    std::string_view rule;
    Severity severity;
    bool operator==(const Kind&) const = default;
  };
  struct KindHash {
    std::size_t operator()(const Kind& kind) const;
  };
  struct Cause {
    Kind kind;
    std::string words;
    bool operator==(const Cause&) const = default;
  };
  struct CauseHash {
    std::size_t operator()(const Cause& cause) const;
  };
  struct Silenced {
    std::string rule;
    bool has_fired = false;
  };
  struct Tally {
    std::size_t found = 0;
    std::size_t last_listed = 0;     ///< in `all_`
    std::size_t suppressed_row = 0;  ///< in `suppressed_`, once more than `most_per_rule` were found
  };

  void count(Severity severity);
  /// Whether the finding is a further place of a listed one, or of one that is only counted.
  bool join(const Kind& kind, Diagnostic& diagnostic);
  [[nodiscard]] bool is_tolerated(const Diagnostic& diagnostic) const;
  [[nodiscard]] bool drop_silenced(const Diagnostic& diagnostic);
  [[nodiscard]] bool set_aside(Diagnostic& diagnostic);

  std::vector<Diagnostic> all_;
  std::unordered_map<Kind, Tally, KindHash> tallies_;
  std::unordered_map<Cause, std::size_t, CauseHash> first_of_cause_;  ///< where in `all_`; may be behind its end
  std::vector<Suppressed> suppressed_;
  std::vector<Silenced> silenced_;
  std::size_t errors_ = 0;
  std::size_t warnings_ = 0;
  std::size_t notes_ = 0;
  bool strict_ = false;
  bool drop_notes_ = false;
  bool silence_errors_ = false;
  bool any_silenced_ = false;
  Allowances allowances_;
  std::vector<Allowed> allowed_;
  std::size_t allowed_findings_ = 0;
  const SourceFile* foreign_file_ = nullptr;
  std::span<const std::string_view> fatal_rules_;
};

}  // namespace edsc
