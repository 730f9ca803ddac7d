#include "diagnostics/print.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "diagnostics/excerpt.hpp"
#include "diagnostics/place.hpp"
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
  std::size_t allowed = 0;
};

std::vector<FileSum> sums_by_file(const Diagnostics& diagnostics, bool with_allowed) {
  std::vector<FileSum> sums;
  const auto sum_of = [&](const SourceFile* file) -> FileSum& {
    const auto found = std::ranges::find_if(sums, [&](const FileSum& sum) {
      return sum.file == file || (sum.file != nullptr && file != nullptr && sum.file->name() == file->name());
    });
    return found != sums.end() ? *found : sums.emplace_back(FileSum{file});
  };
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    ++sum_of(diagnostic.position.file).counts[diagnostic.severity];
  }
  for (const Diagnostics::Omitted& omitted : diagnostics.omitted()) {
    sum_of(omitted.file).counts[omitted.severity] += omitted.count;
  }
  if (with_allowed && diagnostics.suppressed_findings() > 0) {
    sum_of(diagnostics.suppressed().front().diagnostic.position.file).allowed += diagnostics.suppressed_findings();
  }
  return sums;
}

class TextPrinter {
 public:
  TextPrinter(std::string& out, bool colour) : out_(out), palette_(colour ? coloured : plain) {}

  void print(const Diagnostic& diagnostic) {
    print_head(diagnostic.position, diagnostic.severity, diagnostic.message, diagnostic.rule.text());
    print_source(diagnostic.position);
    for (const Note& note : diagnostic.notes) {
      print_head(note.position, Severity::note, note.message, {});
      print_source(note.position);
    }
    if (diagnostic.unnamed > 0) {
      print_file(diagnostic.position.file);
      print_message(Severity::note,
                    fmt::format("{} more {} with the same cause", diagnostic.unnamed,
                                diagnostic.unnamed == 1 ? "place" : "places"),
                    {});
    }
  }

  void print(const Diagnostics::Omitted& omitted) {
    print_file(omitted.file);
    print_message(omitted.severity, fmt::format("{} more of this kind", omitted.count), omitted.rule.text());
  }

  void print(const FileSum& sum) {
    if (sum.file != nullptr) {
      append("{}: ", file_name(sum.file));
    }
    const std::size_t notes = sum.counts[Severity::note];
    append("{}, {}", counted(sum.counts[Severity::error], "error"), counted(sum.counts[Severity::warning], "warning"));
    if (notes > 0) append(", {}", counted(notes, "note"));
    if (sum.allowed > 0) append(", {} allowed", sum.allowed);
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

  void print_source(const Position& position) {
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

void print_text(std::string& out, const Diagnostics& diagnostics, bool colour, bool with_allowed) {
  TextPrinter printer(out, colour);
  const std::vector<Diagnostic>& all = diagnostics.all();
  for (std::size_t at = 0; at < all.size(); ++at) {
    printer.print(all[at]);
    for (const Diagnostics::Omitted& omitted : diagnostics.omitted()) {
      if (omitted.last_listed == at) {
        printer.print(omitted);
      }
    }
  }
  for (const FileSum& sum : sums_by_file(diagnostics, with_allowed)) {
    printer.print(sum);
  }
}

void print_text(std::FILE* out, const Diagnostics& diagnostics, bool colour, bool with_allowed) {
  std::string text;
  print_text(text, diagnostics, colour, with_allowed);
  std::fwrite(text.data(), 1, text.size(), out);
}

nlohmann::json print_json(const Diagnostics& diagnostics) {
  return {{"version", 1},
          {"diagnostics", to_json_array(diagnostics.all())},
          {"allowed_diagnostics", allowed_rows(diagnostics)},
          {"suppressed", to_json_array(diagnostics.omitted())},
          {"errors", diagnostics.errors()},
          {"warnings", diagnostics.warnings()},
          {"notes", diagnostics.notes()},
          {"allowed", diagnostics.suppressed_findings()}};
}

}  // namespace edsc
