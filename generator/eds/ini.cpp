#include "eds/ini.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "diagnostics/quote.hpp"
#include "eds/number.hpp"
#include "text/ascii.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

/// Characters that do not occur in a text: control characters except tab, line ends, and what ends a text: Ctrl-Z, NUL.
bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r'; }

std::string_view without_end_of_text_mark(std::string_view text) {
  constexpr std::string_view marks{" \t\r\n\x1A\0", 6};
  const std::size_t last = text.find_last_not_of(marks);
  return text.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

std::uint32_t column_of(std::string_view line, std::string_view part) {
  return static_cast<std::uint32_t>(part.data() - line.data()) + 1;
}

Position place(const SourceFile& source, std::uint32_t line, std::uint32_t column, std::string_view text) {
  return {&source, line, column, static_cast<std::uint32_t>(std::max<std::size_t>(text.size(), 1))};
}

IniEntry entry_of(std::string_view line, std::string_view content, std::size_t equals, std::string_view key,
                  std::uint32_t number) {
  const std::string_view behind_equals = content.substr(equals + 1);
  const std::string_view value = trim_left(behind_equals);
  const std::string_view value_place = value.empty() ? behind_equals : value;
  return {key, value, number, column_of(line, key), column_of(line, value_place)};
}

class IniReader {
 public:
  IniReader(const SourceFile& source, Diagnostics& diagnostics) : source_(source), diagnostics_(diagnostics) {
    file_.source = &source;
  }

  IniFile read() {
    if (!report_binary() && !report_xml()) {
      for (line_number_ = 1; line_number_ <= source_.lines(); ++line_number_) {
        read_line(source_.line(line_number_));
      }
      report_empty();
    }
    return std::move(file_);
  }

 private:
  /// The section of the following entries.
  enum class Target { none_yet, last_section, unreadable_section };

  bool report_binary() {
    const std::string_view text = without_end_of_text_mark(source_.text());
    const auto found = std::find_if(text.begin(), text.end(), is_control);
    if (found == text.end()) {
      return false;
    }
    const std::string_view from_there = text.substr(static_cast<std::size_t>(found - text.begin()));
    line_number_ = 1;
    while (column_of(source_.line(line_number_), from_there) > source_.line(line_number_).size()) {
      ++line_number_;
    }
    error("binary-file", source_.line(line_number_), from_there.substr(0, 1),
          "control character; this is not a text file, and nothing of it is read");
    return true;
  }

  bool report_xml() {
    const std::string_view text = source_.text();
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos || text[first] != '<') {
      return false;
    }
    diagnostics_.error("xml-file", {&source_},
                       "this is XML, perhaps a device description of CiA 311; expected the INI format of CiA 306");
    return true;
  }

  void report_empty() {
    if (file_.sections.empty() && target_ == Target::none_yet && !found_entry_outside_) {
      diagnostics_.error("empty-file", {&source_}, "the file does not have a section");
    }
  }

  void read_line(std::string_view line) {
    const std::string_view content = trim(line);
    if (content.empty()) {
      return;
    }
    if (content[0] == ';') {
      keep_remark(content);
    } else if (content[0] == '#') {
      report_hash_comment(line, content);
      keep_remark(content);
    } else if (content[0] == '[') {
      read_header(line, content);
    } else {
      read_entry(line, content);
    }
  }

  void keep_remark(std::string_view text) { file_.remarks.push_back({text, line_number_}); }

  void report_hash_comment(std::string_view line, std::string_view comment) {
    if (!found_hash_comment_) {
      warning("hash-comment", line, comment.substr(0, 1),
              "a comment begins with ';' in CiA 306, not with '#'; reading all lines that begin with '#' as comments");
    }
    found_hash_comment_ = true;
  }

  void read_header(std::string_view line, std::string_view content) {
    const std::size_t end = content.find(']');
    if (end == std::string_view::npos) {
      error("unterminated-section", line, content.substr(0, 1),
            "missing ']'; the entries up to the next section are ignored");
      target_ = Target::unreadable_section;
      return;
    }
    const std::string_view name = trim(content.substr(1, end - 1));
    target_ = Target::last_section;
    file_.sections.push_back({name, line_number_, column_of(line, name), {}});

    const std::string_view rest = trim(content.substr(end + 1));
    if (rest.empty()) {
      return;
    }
    keep_remark(rest);
    if (rest[0] != ';' && rest[0] != '#') {
      warning("text-after-section", line, rest, "text after section header; reading it as a comment");
    }
  }

  void read_entry(std::string_view line, std::string_view content) {
    const std::size_t equals = content.find('=');
    if (equals == std::string_view::npos) {
      keep_remark(content);
      warning("stray-line", line, content,
              "neither a section nor an entry (missing '='); reading this line as a comment");
      return;
    }
    const std::string_view key = trim_right(content.substr(0, equals));
    if (key.empty()) {
      keep_remark(content);
      warning("stray-line", line, content, "missing key before '='; reading this line as a comment");
      return;
    }
    if (target_ == Target::none_yet) {
      report_entry_outside(line, key);
    }
    if (target_ != Target::last_section) {
      return;
    }
    std::vector<IniEntry>& entries = file_.sections.back().entries;
    if (entries.empty()) {
      entries.reserve(8);  // the usual number in an object section
    }
    entries.push_back(entry_of(line, content, equals, key, line_number_));
  }

  void report_entry_outside(std::string_view line, std::string_view key) {
    if (!found_entry_outside_) {
      error("entry-outside-section", line, key,
            quote(key) + " is before the first section; all entries up to there are ignored");
    }
    found_entry_outside_ = true;
  }

  void error(ErrorRule rule, std::string_view line, std::string_view part, std::string message) {
    diagnostics_.error(rule, place(source_, line_number_, column_of(line, part), part), std::move(message));
  }

  void warning(WarningRule rule, std::string_view line, std::string_view part, std::string message) {
    diagnostics_.warning(rule, place(source_, line_number_, column_of(line, part), part), std::move(message));
  }

  const SourceFile& source_;
  Diagnostics& diagnostics_;
  IniFile file_;
  std::uint32_t line_number_ = 0;
  Target target_ = Target::none_yet;
  bool found_hash_comment_ = false;
  bool found_entry_outside_ = false;
};

}  // namespace

const IniEntry* IniSection::find(std::string_view key) const {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const IniEntry& entry) { return equal_ignoring_case(entry.key, key); });
  return found != entries.end() ? &*found : nullptr;
}

std::optional<IniEntry> read_ini_entry(std::string_view line, std::uint32_t number) {
  const std::string_view content = trim(line);
  if (content.empty() || content[0] == ';' || content[0] == '#' || content[0] == '[') return std::nullopt;
  const std::size_t equals = content.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  const std::string_view key = trim_right(content.substr(0, equals));
  if (key.empty()) return std::nullopt;
  return entry_of(line, content, equals, key, number);
}

std::optional<std::string_view> read_ini_header(std::string_view line) {
  const std::string_view content = trim_left(line);
  if (!content.starts_with('[')) return std::nullopt;
  const std::size_t end = content.find(']');
  if (end == std::string_view::npos) return std::nullopt;
  return trim(content.substr(1, end - 1));
}

IniFile parse_ini(const SourceFile& source, Diagnostics& diagnostics) { return IniReader(source, diagnostics).read(); }

std::string_view value_of(const SourceFile& source, const IniEntry& entry) {
  if (source.choices().access_types != AccessConvention::swapped || !equal_ignoring_case(entry.key, "AccessType")) {
    return entry.value;
  }
  const std::string_view type = without_quotes(trim(strip_inline_comment(entry.value)));
  if (equal_ignoring_case(type, "rwr")) return "rww";
  return equal_ignoring_case(type, "rww") ? "rwr" : entry.value;
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) { return to_lower(x) == to_lower(y); });
}

bool starts_with_ignoring_case(std::string_view text, std::string_view start) {
  return equal_ignoring_case(text.substr(0, start.size()), start);
}

bool ends_with_ignoring_case(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && equal_ignoring_case(text.substr(text.size() - end.size()), end);
}

Position key_position(const SourceFile& source, const IniEntry& entry) {
  return place(source, entry.line, entry.key_column, entry.key);
}

Position value_position(const SourceFile& source, const IniEntry& entry) {
  return place(source, entry.line, entry.value_column, entry.value);
}

Position section_position(const SourceFile& source, const IniSection& section) {
  return place(source, section.line, section.column, section.name);
}

}  // namespace edsc
