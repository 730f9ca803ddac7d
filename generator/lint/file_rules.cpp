#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <string_view>

#include "device/bit_rates.hpp"
#include "diagnostics/place.hpp"
#include "diagnostics/quote.hpp"
#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "lint/rule_groups.hpp"
#include "system/path.hpp"
#include "text/ascii.hpp"
#include "text/source_file.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

constexpr std::size_t longest_line = 255;

/// Whether `text` matches `pattern`, in which `0` is any digit.
bool has_form(std::string_view text, std::string_view pattern) {
  return std::ranges::equal(text, pattern, [](char c, char p) { return p == '0' ? is_digit(c) : to_lower(c) == p; });
}

unsigned two_digits(std::string_view text) {
  return static_cast<unsigned>(text[0] - '0') * 10 + static_cast<unsigned>(text[1] - '0');
}

/// mm-dd-yyyy
bool is_date(std::string_view text) {
  if (!has_form(text, "00-00-0000")) return false;
  const unsigned month = two_digits(text);
  const unsigned day = two_digits(text.substr(3));
  return month >= 1 && month <= 12 && day >= 1 && day <= 31;
}

/// hh:mm(AM|PM); the hour may have one digit
bool is_time(std::string_view text) {
  const bool one_digit = has_form(text, "0:00am") || has_form(text, "0:00pm");
  if (!one_digit && !has_form(text, "00:00am") && !has_form(text, "00:00pm")) return false;
  const unsigned hour = one_digit ? static_cast<unsigned>(text[0] - '0') : two_digits(text);
  return hour <= 12 && two_digits(text.substr(text.find(':') + 1)) < 60;
}

bool is_version(std::string_view text) { return has_form(text, "0.0"); }

/// Decimal, also with leading zeros: revision 08 follows 07.
bool is_unsigned8(std::string_view text) { return parse_decimal(text).value_or(256) <= 255; }

struct FileInfoForm {
  AnyRule rule;
  std::string_view key;
  Field FileInfo::*field;
  bool (*fits)(std::string_view text);
  std::string_view form;
};

constexpr FileInfoForm file_info_forms[] = {
    {"file-version", "FileVersion", &FileInfo::file_version, is_unsigned8, "a number of 0..255"},
    {"file-version", "FileRevision", &FileInfo::file_revision, is_unsigned8, "a number of 0..255"},
    {"eds-version", "EDSVersion", &FileInfo::eds_version, is_version, "of the form 4.0"},
    {"file-date", "CreationDate", &FileInfo::creation_date, is_date, "a date of the form mm-dd-yyyy"},
    {"file-date", "ModificationDate", &FileInfo::modification_date, is_date, "a date of the form mm-dd-yyyy"},
    {"file-time", "CreationTime", &FileInfo::creation_time, is_time, "a time of the form hh:mmAM"},
    {"file-time", "ModificationTime", &FileInfo::modification_time, is_time, "a time of the form hh:mmAM"},
};

void check_file_name(const RuleContext& context) {
  const Field& field = context.sheet.file_info.file_name;
  if (field.empty()) {
    context.report("file-name", context.sheet.file_info.position, "missing FileName");
    return;
  }
  if (!context.device.source->parts().empty()) return;  // the name of a base, or of the EDS to write
  const std::string_view name = file_name_of(context.device.source->name());
  if (name == "-" || equal_ignoring_case(field.text, name)) return;
  context.report("file-name", field.position,
                 fmt::format("FileName is {}, but the name of the file is {}", quote(field.text), quote(name)));
}

void check_file_info(const RuleContext& context) {
  const FileInfo& info = context.sheet.file_info;
  if (!info.present) {
    context.report("file-info", context.whole_file(), "missing section [FileInfo]");
    return;
  }
  for (const FileInfoForm& row : file_info_forms) {
    const Field& field = info.*row.field;
    if (field.empty() || row.fits(strip_inline_comment(field.text))) continue;
    context.report(row.rule, field.position,
                   fmt::format("{} must be {}, not {}", row.key, row.form, quote(field.text)));
  }
  check_file_name(context);
}

void check_encoding(const RuleContext& context) {
  const SourceFile& source = *context.device.source;
  if (source.undefined_bytes().empty()) return;
  context.report("unknown-encoding", position_at(source, source.undefined_place()),
                 undefined_bytes_text(source) + "; option \"encoding\" names the encoding");
}

void check_lines(const RuleContext& context) {
  const SourceFile& source = *context.device.source;
  bool only_ascii = is_ascii(source.text());
  for (std::uint32_t number = 1; number <= source.lines(); ++number) {
    const std::string_view line = source.line(number);
    if (line.size() > longest_line && count_code_points(line) > longest_line) {
      context.report(
          "long-line", {&source, number, longest_line + 1, 1},
          fmt::format("the line has {} characters; the maximum is {}", count_code_points(line), longest_line));
    }
    if (only_ascii || is_ascii(line)) continue;
    only_ascii = true;  // report it once
    if (!source.undefined_bytes().empty()) continue;
    const auto at = std::ranges::find_if(line, [](char c) { return static_cast<unsigned char>(c) >= 0x80; });
    context.report(
        "encoding", {&source, number, static_cast<std::uint32_t>(at - line.begin()) + 1, 1},
        fmt::format("the file contains non-ASCII characters; reading it as {}", to_string(source.encoding())));
  }
}

void check_dummy_usage(const RuleContext& context) {
  for (const NumberedField& dummy : context.sheet.dummy_usage) {
    const std::string_view text = strip_inline_comment(dummy.field.text);
    if (parse_unsigned(text).value_or(2) > 1) {
      context.report("dummy-usage", dummy.field.position,
                     fmt::format("Dummy{:04X} must be 0 or 1, not {}", dummy.number, quote(dummy.field.text)));
    } else if (parse_unsigned(text) == 1 && canopen::find_data_type(dummy.number) == nullptr) {
      context.report("dummy-usage", dummy.field.position,
                     fmt::format("Dummy{:04X} is not a data type that a PDO can map as a dummy", dummy.number));
    }
  }
}

void check_commissioned_baud_rate(const RuleContext& context) {
  const Field& field = context.sheet.commissioning.baudrate;
  const auto rate = number_of(field);
  if (field.empty() || rate == 0) return;
  if (!rate || !is_bit_rate(*rate)) {
    context.report("commissioned-baud-rate", field.position,
                   fmt::format("Baudrate must be {} or {} kbit/s, not {}",
                               fmt::join(std::span{bit_rates}.first(bit_rates.size() - 1), ", "), bit_rates.back(),
                               quote(field.text)));
    return;
  }
  for (const DeviceInfo::BaudRate& row : context.sheet.device_info.baud_rates) {
    if (row.kbit_per_second != *rate || number_of(row.field) != 0) continue;
    context.report("commissioned-baud-rate", field.position,
                   fmt::format("Baudrate is {} kbit/s, which the device does not support", *rate),
                   {{row.field.position, fmt::format("BaudRate_{}=0", *rate)}});
  }
}

void check_commissioning(const RuleContext& context) {
  const DeviceCommissioning& commissioning = context.sheet.commissioning;
  if (!commissioning.present) return;
  const Position& place = commissioning.position;
  const std::string_view name = place.line == 0 ? "" : context.device.source->line(place.line);
  if (name.find("ommissioning") != std::string_view::npos) {
    context.report("section-spelling", place, "CiA 306 spells this section [DeviceComissioning]");
  }
  if (!context.device.node_id) {
    const Field& stated = commissioning.node_id;
    context.report("commissioned-node-id", stated.position,
                   stated.empty() ? "missing NodeID; expected 1..127"
                                  : fmt::format("NodeID {} means that the node has none yet; expected 1..127",
                                                quote(strip_inline_comment(stated.text))));
  }
  check_commissioned_baud_rate(context);
}

/// XDD files have other rules for dates and encodings.
bool is_ini(const SourceFile& source) {
  const auto first = source.text().find_first_not_of(" \t\r\n");
  return first == std::string_view::npos || source.text()[first] != '<';
}

}  // namespace

void check_file(const RuleContext& context) {
  if (is_ini(*context.device.source)) {
    check_file_info(context);
    check_encoding(context);
    check_lines(context);
    check_commissioning(context);
  }
  check_dummy_usage(context);
}

}  // namespace edsc
