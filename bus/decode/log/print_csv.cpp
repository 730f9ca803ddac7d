#include "decode/log/print_csv.hpp"

#include <charconv>
#include <system_error>

#include "decode/log/value_number.hpp"
#include "device/meaning/value_parts.hpp"
#include "text/printable.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

/// Whether a spreadsheet would evaluate the text as a formula. Numbers such as -5 are none, also with a unit: `-5 mm`.
bool is_formula(std::string_view text) {
  if (text.empty() || std::string_view{"=+-@\t\r\n"}.find(text.front()) == std::string_view::npos) return false;
  const std::string_view digits = text.substr(text.front() == '+' ? 1 : 0);
  double number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc{}) return true;
  const std::string_view unit = digits.substr(static_cast<std::size_t>(end - digits.data()));
  return !unit.empty() && (unit.front() != ' ' || unit.find_first_of("=+-@|!()&;\"'") != std::string_view::npos);
}

/// A text of a file or device. In quotation marks if it has a comma, a quotation mark or a line end (RFC 4180, 2); with
/// an apostrophe before a formula, so that it stays text.
void append_field_text(std::string& out, std::string_view text) {
  if (is_formula(text)) {
    append_field_text(out, std::string{"'"}.append(text));
    return;
  }
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    append_printable(out, text);
    return;
  }
  out += '"';
  for (const char c : printable(text)) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

/// What the fields of a record are made of.
struct CsvRecord {
  const LogLine& line;
  const Message& message;
  const NodeLabels& labels;
  const MessageValue* value;  ///< may be null
};

[[nodiscard]] std::string_view text_of_value(const CsvRecord& record) {
  const MessageValue& value = *record.value;
  return std::string_view{record.message.text}.substr(value.text_begin, value.text_end - value.text_begin);
}

/// The name of the value, or the names of its masked values and fields: `operation_enabled, remote`.
[[nodiscard]] std::string names_of(const MessageValue& value) {
  const auto raw = value.meaning != nullptr ? integer_of(value) : std::nullopt;
  if (!raw) return "";
  const Meaning& meaning = *value.meaning;
  const NamedValue* const named = meaning.values ? meaning.values->find(*raw) : nullptr;
  if (named != nullptr) return named->name;
  std::string names;
  append_parts(names, meaning, value.bits != 0 ? value.number : number_of(value.bytes), value.other);
  return names;
}

struct CsvColumn {
  std::string_view name;
  void (*append)(std::string& out, const CsvRecord& record);
};

constexpr CsvColumn csv_columns[] = {
    {"line", [](std::string& out, const CsvRecord& of) { append_decimal(out, of.line.number); }},
    {"time", [](std::string& out, const CsvRecord& of) { append_field_text(out, of.line.time); }},
    {"bus", [](std::string& out, const CsvRecord& of) { append_field_text(out, of.line.interface); }},
    {"can_id", [](std::string& out, const CsvRecord& of) { append_can_id(out, of.line.frame); }},
    {"data", [](std::string& out, const CsvRecord& of) { append_hex_bytes(out, data_of(of.line.frame), ""); }},
    {"node",
     [](std::string& out, const CsvRecord& of) {
       if (of.message.node_id != 0) append_decimal(out, of.message.node_id);
     }},
    {"node_name",
     [](std::string& out, const CsvRecord& of) { append_field_text(out, of.labels.name(of.message.node_id)); }},
    {"service", [](std::string& out, const CsvRecord& of) { out += row_of(of.message.service).name; }},
    {"pdo",
     [](std::string& out, const CsvRecord& of) {
       if (of.message.number != 0) append_decimal(out, of.message.number);
     }},
    {"step", [](std::string& out, const CsvRecord& of) { out += step_name(of.message.step); }},
    {"object",
     [](std::string& out, const CsvRecord& of) {
       if (of.value != nullptr) append_entry_label(out, of.value->index, of.value->sub_index);
     }},
    {"name",
     [](std::string& out, const CsvRecord& of) {
       if (of.value != nullptr) append_field_text(out, of.value->name);
     }},
    {"value",
     [](std::string& out, const CsvRecord& of) {
       if (of.value == nullptr) return;
       if (const auto number = plain_number(*of.value)) return append_number(out, *number);
       append_field_text(out, text_of_value(of));
     }},
    {"physical",
     [](std::string& out, const CsvRecord& of) {
       const auto physical = of.value != nullptr ? physical_number(*of.value) : std::nullopt;
       if (physical) append_number(out, *physical);
     }},
    {"unit",
     [](std::string& out, const CsvRecord& of) {
       if (of.value != nullptr && of.value->quantity != nullptr) append_field_text(out, of.value->quantity->symbol);
     }},
    {"names",
     [](std::string& out, const CsvRecord& of) {
       if (of.value != nullptr) append_field_text(out, names_of(*of.value));
     }},
    {"problem", [](std::string& out, const CsvRecord& of) { out += of.message.problem ? "true" : "false"; }},
    {"text",
     [](std::string& out, const CsvRecord& of) {
       append_field_text(out, of.value != nullptr ? text_of_value(of) : std::string_view{of.message.text});
     }},
};

void append_record(std::string& out, const CsvRecord& record) {
  for (const CsvColumn& column : csv_columns) {
    if (&column != csv_columns) out += ',';
    column.append(out, record);
  }
  out += "\r\n";
}

}  // namespace

void append_csv_header(std::string& out) {
  for (const CsvColumn& column : csv_columns) {
    if (&column != csv_columns) out += ',';
    out += column.name;
  }
  out += "\r\n";
}

void append_csv(std::string& out, const LogLine& line, const Message& message, const NodeLabels& labels) {
  if (message.values.empty()) append_record(out, {line, message, labels, nullptr});
  for (const MessageValue& value : message.values) append_record(out, {line, message, labels, &value});
}

}  // namespace edsc
