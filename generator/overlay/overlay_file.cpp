#include "overlay/overlay_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "diagnostics/quote.hpp"
#include "eds/allow_comments.hpp"
#include "eds/number.hpp"
#include "eds/sections/duplicates.hpp"
#include "overlay/overlay_keys.hpp"
#include "text/ascii.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

constexpr std::uint64_t overlay_version = 1;

bool is_blank_at(std::string_view text, std::size_t at) { return at >= text.size() || is_blank(text[at]); }

/// The place of the arrow: at the start or after a blank, and followed by a blank or the end.
std::size_t find_arrow(std::string_view value) {
  for (std::size_t at = value.find(arrow); at != std::string_view::npos; at = value.find(arrow, at + 1)) {
    if ((at == 0 || is_blank(value[at - 1])) && is_blank_at(value, at + arrow.size())) return at;
  }
  return std::string_view::npos;
}

/// `2000-5FFF`.
std::optional<IndexSpan> read_index_span(std::string_view name) {
  const std::size_t dash = name.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const auto first = parse_hex(trim(name.substr(0, dash)), 4);
  const auto last = parse_hex(trim(name.substr(dash + 1)), 4);
  if (!first || !last) return std::nullopt;
  return IndexSpan{*first, *last};
}

std::string comment_text(std::string_view remark) {
  while (!remark.empty() && (remark.front() == ';' || remark.front() == '#' || is_blank(remark.front()))) {
    remark.remove_prefix(1);
  }
  return std::string{remark};
}

class OverlayReader {
 public:
  OverlayReader(const SourceFile& source, Diagnostics& diagnostics) : source_(source), diagnostics_(diagnostics) {
    file_.source = &source;
    file_.ini = parse_ini(source, diagnostics);
  }

  OverlayFile read() {
    file_.header.position = {&source_};
    place_fields(overlay_keys, file_.header.position, file_.header);
    for (const IniSection& section : file_.ini.sections) {
      if (equal_ignoring_case(section.name, overlay_section)) {
        read_header(section);
      } else {
        read_section(section);
      }
    }
    check_header();
    return std::move(file_);
  }

 private:
  void error(const Position& position, std::string message) {
    diagnostics_.error("overlay-file", position, std::move(message));
  }

  void read_header(const IniSection& section) {
    if (file_.header.present) {
      return error(section_position(source_, section), "duplicate section [Overlay]");
    }
    file_.header.present = true;
    file_.header.position = section_position(source_, section);
    place_fields(overlay_keys, file_.header.position, file_.header);
    read_keys(
        source_, section, diagnostics_, [&](std::string_view key) { return find_key(overlay_keys, key, file_.header); },
        overlay_keys);
  }

  void check_header() {
    OverlayHeader& header = file_.header;
    if (!header.present) {
      if (!file_.ini.sections.empty()) error({&source_}, "missing section [Overlay]");
      return;
    }
    if (number_of(header.version) != overlay_version) {
      error(header.version.position, header.version.present
                                         ? fmt::format("unknown version {}; expected 1", quote(header.version.text))
                                         : "missing Version; expected Version=1");
    }
    for (const ReadingChoiceRow& row : reading_choice_rows()) {
      const Field& field = reading_choice(header, row);
      ReadingChoices choices;
      if (field.empty() || row.set(field.text, choices)) continue;
      error(field.position, fmt::format("{} is not {}; expected {}", quote(field.text), row.key, row.expected()));
    }
    const bool has_identity = header.vendor_number.present || header.product_number.present;
    if (header.base.empty() && !has_identity) {
      error(header.base.position, "missing Base, the path of the file to change");
    } else if (header.base.present && has_identity) {
      error(header.base.position, "Base and VendorNumber exclude each other: the identity selects the file to change");
    }
    if (!has_identity) return;
    for (const Field* const field : {&header.vendor_number, &header.product_number}) {
      if (!number_of(*field)) error(field->position, "VendorNumber and ProductNumber must be numbers");
    }
    if (header.revision_number.present && !number_of(header.revision_number)) {
      error(header.revision_number.position, "RevisionNumber is not a number");
    }
  }

  void read_section(const IniSection& section) {
    OverlaySection read;
    read.section = &section;
    read.name = read_counted_name(section.name);
    read.range = read_index_span(section.name);
    if (read.range && read.range->first > read.range->last) {
      return error(section_position(source_, section), "the range ends before it begins");
    }
    read.reason = reason_before(section.line, true);
    bool is_each_explained = !section.entries.empty();
    for (const IniEntry& entry : section.entries) {
      const std::string reason = reason_before(entry.line, false);
      is_each_explained = is_each_explained && !reason.empty();
      if (read_reserved(entry, read)) {
        if (read.reason.empty()) read.reason = reason;
        continue;
      }
      read_line(entry, reason, read);
    }
    read.has_reason = !read.reason.empty() || is_each_explained;
    for (OverlayLine& line : read.lines) {
      if (line.reason.empty()) line.reason = read.reason;
    }
    if (section.entries.empty()) error(section_position(source_, section), "the section does not have a line");
    if (read.count && !number_in_entry(*read.count)) error(value_position(source_, *read.count), "expected a number");
    file_.sections.push_back(std::move(read));
  }

  static std::optional<std::uint64_t> number_in_entry(const IniEntry& entry) {
    return parse_unsigned(strip_inline_comment(entry.value));
  }

  bool read_reserved(const IniEntry& entry, OverlaySection& section) {
    std::optional<IniEntry>* const place = equal_ignoring_case(entry.key, remove_key)   ? &section.remove
                                           : equal_ignoring_case(entry.key, rename_key) ? &section.rename
                                           : equal_ignoring_case(entry.key, count_key) && section.range ? &section.count
                                                                                                        : nullptr;
    if (place == nullptr) return false;
    if (*place) {
      error(key_position(source_, entry), fmt::format("duplicate key {}", quote(entry.key)));
    } else if (place == &section.remove && number_in_entry(entry) != 1) {
      error(value_position(source_, entry), "expected Remove=1");
    } else if (place == &section.rename && section.range) {
      error(key_position(source_, entry), "a range cannot be renamed");
    } else {
      *place = entry;
    }
    return true;
  }

  void read_line(const IniEntry& entry, std::string reason, OverlaySection& section) {
    OverlayLine line;
    line.entry = entry;
    line.key = read_counted_name(entry.key);
    line.reason = std::move(reason);
    const std::size_t at = find_arrow(entry.value);
    line.has_arrow = at != std::string_view::npos;
    if (line.has_arrow) {
      line.old_value = trim(entry.value.substr(0, at));
      const std::string_view rest = entry.value.substr(at + arrow.size());
      line.new_value = trim(rest);
      line.new_column =
          line.new_value.empty()
              ? entry.value_column + static_cast<std::uint32_t>(at)
              : entry.value_column + static_cast<std::uint32_t>(line.new_value.data() - entry.value.data());
    } else {
      line.new_value = entry.value;
      line.new_column = entry.value_column;
    }
    section.lines.push_back(std::move(line));
  }

  /// The comments between the line before and this one; for a section also those on its line.
  std::string reason_before(std::uint32_t line, bool is_section) {
    std::string reason;
    const std::vector<IniRemark>& remarks = file_.ini.remarks;
    for (; next_remark_ < remarks.size() && remarks[next_remark_].line <= line; ++next_remark_) {
      const IniRemark& remark = remarks[next_remark_];
      if (remark.line == line && !is_section) continue;
      const std::string text = comment_text(remark.text);
      if (text.empty() || is_for_edsc(remark.text)) continue;
      if (!reason.empty()) reason += ' ';
      reason += text;
    }
    return reason;
  }

  const SourceFile& source_;
  Diagnostics& diagnostics_;
  OverlayFile file_;
  std::size_t next_remark_ = 0;
};

}  // namespace

bool is_overlay(const SourceFile& source) {
  if (ends_with_ignoring_case(source.name(), ".overlay")) return true;
  for (std::uint32_t line = 1; line <= source.lines(); ++line) {
    const std::string_view text = trim(source.line(line));
    if (text.empty() || text.starts_with(';') || text.starts_with('#')) continue;
    const auto header = read_ini_header(text);
    return header && equal_ignoring_case(*header, overlay_section);
  }
  return false;
}

const Field& reading_choice(const OverlayHeader& header, const ReadingChoiceRow& row) {
  const auto key = std::ranges::find(overlay_keys, row.key, [](const auto& one) { return one.key.name; });
  return header.*key->field;
}

OverlayFile read_overlay(const SourceFile& source, Diagnostics& diagnostics) {
  return OverlayReader(source, diagnostics).read();
}

OverlayValue::OverlayValue(std::string_view text) : text_(text), number_(number_in(text)) {}

std::optional<OverlayValue::Number> OverlayValue::number_in(std::string_view text) {
  text = trim(strip_inline_comment(text));
  const bool is_negative = text.starts_with('-');
  if (is_negative) text.remove_prefix(1);
  const auto number = parse_unsigned(text);
  if (!number) return std::nullopt;
  return Number{is_negative && *number != 0, *number};
}

bool OverlayValue::is_same(std::string_view other) const {
  if (text_ == other) return true;
  const auto number = number_in(other);
  if (number_ || number) return number_ == number;
  const Formula of_a = split_formula(strip_inline_comment(text_));
  const Formula of_b = split_formula(strip_inline_comment(other));
  if (!of_a.variable.starts_with('$') || !equal_ignoring_case(of_a.variable, of_b.variable)) return false;
  if (of_a.constant.has_value() != of_b.constant.has_value()) return false;
  return !of_a.constant || is_same_value(*of_a.constant, *of_b.constant);
}

bool is_same_value(std::string_view a, std::string_view b) { return OverlayValue{a}.is_same(b); }

Position position_of(const OverlayFile& file, const OverlayLine& line) {
  return value_position(*file.source, line.entry);
}

}  // namespace edsc
