#include "diagnostics/print.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnostics/excerpt.hpp"
#include "diagnostics/place.hpp"
#include "diagnostics/report_order.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

/// ANSI escape sequences, or nothing.
struct Palette {
  std::string_view place;
  std::string_view severities[3];  ///< in the order of Severity
  std::string_view caret, reset;

  [[nodiscard]] std::string_view of(Severity severity) const { return severities[static_cast<std::size_t>(severity)]; }
};

constexpr Palette plain{};
constexpr Palette coloured{"\x1B[1m", {"\x1B[1;36m", "\x1B[1;35m", "\x1B[1;31m"}, "\x1B[1;32m", "\x1B[0m"};

std::string file_name(const SourceFile* file) { return file == nullptr ? std::string() : printable(file->name()); }

/// The numbers of findings of one file. A file that several nodes of a network have is read once for each.
struct FileSum {
  const SourceFile* file;
  SeverityCounts counts = {};
  std::size_t causes = 0;  ///< warnings and errors that do not follow from others
  std::size_t allowed = 0;
};

/// Whether the findings that are only counted follow from another one, as the last listed one of their kind does.
bool follows(const Diagnostics::Omitted& omitted, const Diagnostics& diagnostics) {
  return diagnostics.all()[omitted.last_listed].follows_from.has_value();
}

std::vector<FileSum> sums_by_file(const Diagnostics& diagnostics, bool with_allowed) {
  std::vector<FileSum> sums;
  const auto sum_of = [&](const SourceFile* file) -> FileSum& {
    const auto found = std::ranges::find_if(sums, [&](const FileSum& sum) {
      return sum.file == file || (sum.file != nullptr && file != nullptr && sum.file->name() == file->name());
    });
    return found != sums.end() ? *found : sums.emplace_back(FileSum{file});
  };
  const auto add = [&](const SourceFile* file, Severity severity, std::size_t count, bool follows) {
    FileSum& sum = sum_of(file);
    sum.counts[severity] += count;
    if (severity != Severity::note && !follows) sum.causes += count;
  };
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    add(diagnostic.position.file, diagnostic.severity, 1, diagnostic.follows_from.has_value());
  }
  for (const Diagnostics::Omitted& omitted : diagnostics.omitted()) {
    add(omitted.file, omitted.severity, omitted.count, follows(omitted, diagnostics));
  }
  if (with_allowed && diagnostics.suppressed_findings() > 0) {
    sum_of(diagnostics.suppressed().front().diagnostic.position.file).allowed += diagnostics.suppressed_findings();
  }
  return sums;
}

class TextPrinter {
 public:
  TextPrinter(std::string& out, const TextStyle& style)
      : out_(out), style_(style), palette_(style.colour ? coloured : plain) {}

  void print(const Diagnostic& diagnostic) {
    print_head(diagnostic.position, diagnostic.severity, diagnostic.message, diagnostic.rule.text());
    print_source(diagnostic.position);
    const bool are_places = diagnostic.places > 1 && !style_.all;
    const std::size_t shown =
        are_places ? std::min(diagnostic.notes.size(), Diagnostic::max_places - 1) : diagnostic.notes.size();
    for (const Note& note : std::span{diagnostic.notes}.first(shown)) {
      print_head(note.position, Severity::note, note.message, {});
      print_source(note.position);
    }
    const std::size_t more = diagnostic.unnamed + diagnostic.notes.size() - shown;
    if (more == 0) return;
    print_file(diagnostic.position.file);
    print_message(Severity::note, fmt::format("{} more {} with the same cause", more, more == 1 ? "place" : "places"),
                  {});
  }

  /// The findings that follow from one, if they are not listed.
  void print(const SourceFile* file, const std::vector<Consequence>& consequences) {
    if (consequences.empty() || style_.all) return;
    std::size_t sum = 0;
    std::string rules;
    for (const Consequence& one : consequences) {
      sum += one.count;
      rules += fmt::format("{}{} {}", rules.empty() ? "" : ", ", one.count, one.rule.text());
    }
    print_file(file);
    print_message(
        Severity::note,
        fmt::format("{} from this: {}{}", sum == 1 ? "1 finding follows" : fmt::format("{} findings follow", sum),
                    rules, style_.of_check ? " (--all-findings lists them)" : ""),
        {});
  }

  void print(const Diagnostics::Omitted& omitted) {
    print_file(omitted.file);
    print_message(omitted.severity, fmt::format("{} more of this kind", omitted.count), omitted.rule.text());
  }

  void print(const FileSum& sum) {
    if (sum.file != nullptr) {
      append("{}: ", file_name(sum.file));
    }
    const std::size_t errors = sum.counts[Severity::error];
    const std::size_t notes = sum.counts[Severity::note];
    if (sum.causes < errors + sum.counts[Severity::warning]) append("{}, ", counted(sum.causes, "cause"));
    append("{}, {}", counted(errors, "error"), counted(sum.counts[Severity::warning], "warning"));
    if (notes > 0) append(", {}", counted(notes, "note"));
    if (sum.allowed > 0) append(", {} allowed", sum.allowed);
    if (style_.of_check && errors > 0)
      append("; {} generate", errors == 1 ? "1 stops" : fmt::format("{} stop", errors));
    out_ += '\n';
  }

 private:
  template <typename... Values>
  void append(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Values>(values)...);
  }

  void print_head(const Position& position, Severity severity, std::string_view message, std::string_view rule) {
    const Place place = place_of(position);
    if (!place.file.empty()) {
      append("{}{}:{}:{}:{} ", palette_.place, printable(place.file), place.line, place.column, palette_.reset);
    }
    print_message(severity, message, rule);
  }

  void print_file(const SourceFile* file) {
    if (file != nullptr) {
      append("{}{}:{} ", palette_.place, file_name(file), palette_.reset);
    }
  }

  void print_message(Severity severity, std::string_view message, std::string_view rule) {
    append("{}{}:{} {}", palette_.of(severity), to_string(severity), palette_.reset, printable(message));
    if (!rule.empty()) {
      append(" [{}]", rule);
    }
    out_ += '\n';
  }

  void print_source(const Position& composed) {
    const Position position = origin_of(composed);
    if (position.file == nullptr || position.line == 0) {
      return;
    }
    const Excerpt shown = excerpt(position.file->line(position.line), position);
    const std::string number = fmt::format("{:>5}", position.line);
    append("{} | {}\n", number, shown.text);
    append("{:{}} | {:{}}{}^{:~<{}}{}\n", "", number.size(), "", shown.caret, palette_.caret, "",
           shown.caret_columns - 1, palette_.reset);
  }

  std::string& out_;
  const TextStyle style_;
  const Palette& palette_;
};

nlohmann::json to_json(const Position& position) {
  Place place = place_of(position);
  return {{"file", std::move(place.file)}, {"line", place.line}, {"column", place.column}, {"length", place.length}};
}

nlohmann::json to_json(const Diagnostic& diagnostic) {
  nlohmann::json notes = nlohmann::json::array();
  for (const Note& note : diagnostic.notes) {
    nlohmann::json& row = notes.emplace_back(to_json(note.position));
    row["message"] = note.message;
  }
  nlohmann::json row = to_json(diagnostic.position);
  row["severity"] = to_string(diagnostic.severity);
  row["rule"] = diagnostic.rule.text();
  row["message"] = diagnostic.message;
  row["notes"] = std::move(notes);
  if (diagnostic.places > 1) row["places"] = diagnostic.places;
  return row;
}

nlohmann::json to_json(const Diagnostics::Suppressed& suppressed, const Allowance& allowance) {
  nlohmann::json row = to_json(suppressed.diagnostic);
  nlohmann::json& why = row["allowance"] = to_json(allowance.position);
  why["kind"] = allowance.in_source ? "inSource" : "external";
  why["reason"] = allowance.reason;
  return row;
}

nlohmann::json allowed_rows(const Diagnostics& diagnostics) {
  nlohmann::json rows = nlohmann::json::array();
  for (const Diagnostics::Suppressed& one : diagnostics.suppressed()) {
    rows.push_back(to_json(one, diagnostics.allowances()[one.allowance]));
  }
  return rows;
}

nlohmann::json to_json(const Diagnostics::Omitted& omitted) {
  return {{"file", omitted.file == nullptr ? std::string() : omitted.file->name()},
          {"severity", to_string(omitted.severity)},
          {"rule", omitted.rule.text()},
          {"count", omitted.count}};
}

template <typename Rows>
nlohmann::json to_json_array(const Rows& rows) {
  nlohmann::json array = nlohmann::json::array();
  for (const auto& row : rows) {
    array.push_back(to_json(row));
  }
  return array;
}

}  // namespace

void print_text(std::string& out, const Diagnostics& diagnostics, const TextStyle& style) {
  TextPrinter printer(out, style);
  for (const std::size_t at : report_order(diagnostics)) {
    const Diagnostic& one = diagnostics.all()[at];
    if (one.follows_from && !style.all) continue;
    printer.print(one);
    printer.print(one.position.file, consequences_of(at, diagnostics));
    for (const Diagnostics::Omitted& omitted : diagnostics.omitted()) {
      if (omitted.last_listed == at) printer.print(omitted);
    }
  }
  for (const FileSum& sum : sums_by_file(diagnostics, style.of_check)) printer.print(sum);
}

void print_text(std::FILE* out, const Diagnostics& diagnostics, const TextStyle& style) {
  std::string text;
  print_text(text, diagnostics, style);
  std::fwrite(text.data(), 1, text.size(), out);
}

nlohmann::json print_json(const Diagnostics& diagnostics) {
  const std::vector<std::size_t> order = report_order(diagnostics);
  std::vector<std::size_t> places(order.size());
  for (std::size_t at = 0; at < order.size(); ++at) places[order[at]] = at;
  nlohmann::json rows = nlohmann::json::array();
  for (const std::size_t at : order) {
    const Diagnostic& one = diagnostics.all()[at];
    nlohmann::json& row = rows.emplace_back(to_json(one));
    if (one.follows_from) row["follows_from"] = places[*one.follows_from];
  }
  return {{"schema", 2},
          {"diagnostics", std::move(rows)},
          {"allowed_diagnostics", allowed_rows(diagnostics)},
          {"suppressed", to_json_array(diagnostics.omitted())},
          {"causes", count_causes(diagnostics)},
          {"errors", diagnostics.errors()},
          {"warnings", diagnostics.warnings()},
          {"notes", diagnostics.notes()},
          {"allowed", diagnostics.suppressed_findings()}};
}

}  // namespace edsc
