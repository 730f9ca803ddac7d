#include "diagnostics/diagnostics.hpp"

#include <algorithm>
#include <functional>
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

void Diagnostics::report(Diagnostic diagnostic) {
  if (drop_notes_ && diagnostic.severity == Severity::note) return;
  if (is_silenced(diagnostic)) {
    any_silenced_ = any_silenced_ || diagnostic.severity != Severity::note;
    return;
  }
  if (strict_ && diagnostic.severity == Severity::warning) {
    diagnostic.severity = Severity::error;
  }
  count(diagnostic.severity);

  const Kind kind{diagnostic.position.file, diagnostic.rule, diagnostic.severity};
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

void Diagnostics::error(std::string_view rule, const Position& position, std::string message) {
  report({Severity::error, rule, position, std::move(message), {}});
}

void Diagnostics::warning(std::string_view rule, const Position& position, std::string message) {
  report({Severity::warning, rule, position, std::move(message), {}});
}

void Diagnostics::note(std::string_view rule, const Position& position, std::string message) {
  report({Severity::note, rule, position, std::move(message), {}});
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
