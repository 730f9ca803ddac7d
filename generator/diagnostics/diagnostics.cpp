#include "diagnostics/diagnostics.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

namespace edsc {

std::string_view to_string(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "";
}

std::size_t Diagnostics::KindHash::operator()(const Kind& kind) const {
  return std::hash<std::string_view>{}(kind.rule) ^ (std::hash<const SourceFile*>{}(kind.file) << 1U) ^
         static_cast<std::size_t>(kind.severity);
}

std::size_t Diagnostics::CauseHash::operator()(const Cause& cause) const {
  return KindHash{}(cause.kind) ^ (std::hash<std::string>{}(cause.words) << 1U);
}

void Diagnostics::report(Diagnostic diagnostic) {
  if (drop_notes_ && diagnostic.severity == Severity::note) return;
  if (is_silenced(diagnostic)) {
    any_silenced_ = any_silenced_ || diagnostic.severity != Severity::note;
    return;
  }
  if (strict_ && diagnostic.severity == Severity::warning) {
    diagnostic.severity = Severity::error;
  }
  const Kind kind{diagnostic.position.file, diagnostic.rule, diagnostic.severity};
  if (join(kind, diagnostic)) return;
  count(diagnostic.severity);
  Tally& tally = tallies_[kind];
  ++tally.found;
  if (tally.found <= most_per_rule) {
    tally.last_listed = all_.size();
    all_.push_back(std::move(diagnostic));
    return;
  }
  if (tally.found == most_per_rule + 1) {
    tally.suppressed_row = suppressed_.size();
    suppressed_.push_back({kind.file, kind.rule, kind.severity, 0, tally.last_listed});
  }
  ++suppressed_[tally.suppressed_row].count;
}

bool Diagnostics::join(const Kind& kind, Diagnostic& diagnostic) {
  if (diagnostic.cause.empty()) return false;
  const bool is_listed = tallies_[kind].found < most_per_rule;
  const auto [first, is_new] = first_of_cause_.try_emplace(
      Cause{kind, diagnostic.cause}, is_listed ? all_.size() : std::numeric_limits<std::size_t>::max());
  if (is_new) return false;
  if (first->second >= all_.size()) return true;
  Diagnostic& listed = all_[first->second];
  ++listed.places;
  if (listed.places > most_places) {
    ++listed.unnamed;
  } else {
    listed.notes.push_back({diagnostic.position, std::move(diagnostic.message)});
  }
  return true;
}

void Diagnostics::error(ErrorRule rule, const Position& position, std::string message, std::vector<Note> notes,
                        std::string cause) {
  report({Severity::error, rule.id(), position, std::move(message), std::move(notes), std::move(cause)});
}

void Diagnostics::warning(WarningRule rule, const Position& position, std::string message, std::vector<Note> notes,
                          std::string cause) {
  report({Severity::warning, rule.id(), position, std::move(message), std::move(notes), std::move(cause)});
}

void Diagnostics::note(NoteRule rule, const Position& position, std::string message, std::vector<Note> notes,
                       std::string cause) {
  report({Severity::note, rule.id(), position, std::move(message), std::move(notes), std::move(cause)});
}

void Diagnostics::usual(AnyRule rule, const Position& position, std::string message, std::vector<Note> notes,
                        std::string cause) {
  report({rule.row().severity, rule.id(), position, std::move(message), std::move(notes), std::move(cause)});
}

void Diagnostics::silence(std::string rule) { silenced_.push_back(std::move(rule)); }

void Diagnostics::count(Severity severity) {
  errors_ += severity == Severity::error ? 1 : 0;
  warnings_ += severity == Severity::warning ? 1 : 0;
  notes_ += severity == Severity::note ? 1 : 0;
}

bool Diagnostics::is_silenced(const Diagnostic& diagnostic) const {
  if (diagnostic.severity == Severity::error && !silence_errors_) return false;
  return std::find(silenced_.begin(), silenced_.end(), diagnostic.rule) != silenced_.end();
}

}  // namespace edsc
