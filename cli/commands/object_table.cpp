#include "commands/object_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "change/change.hpp"
#include "change/sheet_text.hpp"
#include "device/types/type_name.hpp"
#include "eds/number.hpp"
#include "lookup/find_entry.hpp"
#include "shared/define_command.hpp"
#include "shared/edit_file.hpp"
#include "shared/exit_code.hpp"
#include "shared/object_words.hpp"
#include "shared/output.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

/// The columns of the table and the keys of an EDS. `unit` is `Factor` and `Unit`.
enum TableColumn : std::size_t {
  index_column,
  sub_column,
  name_column,
  type_column,
  access_column,
  default_column,
  low_column,
  high_column,
  unit_column
};
constexpr std::string_view table_columns[] = {"index",   "sub", "name", "type", "access",
                                              "default", "low", "high", "unit"};

struct KeyColumn {
  std::size_t column;
  std::string_view key;
};
constexpr KeyColumn key_columns[] = {{name_column, "ParameterName"},
                                     {access_column, "AccessType"},
                                     {default_column, "DefaultValue"},
                                     {low_column, "LowLimit"},
                                     {high_column, "HighLimit"}};

/// Object codes other than VAR, in the column `type`.
struct CodeName {
  std::string_view name;
  std::uint64_t code;
};
constexpr CodeName code_names[] = {{"ARRAY", 8}, {"RECORD", 9}};

using TableRow = std::vector<std::string>;

// CSV (RFC 4180).

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string{text};
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string csv_line(const TableRow& row) {
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) line += (i == 0 ? "" : ",") + csv_field(row[i]);
  return line + "\n";
}

std::vector<TableRow> read_csv(std::string_view text) {
  std::vector<TableRow> rows;
  TableRow row{""};
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_quoted) {
      if (c != '"') {
        row.back() += c;
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        row.back() += text[++i];
      } else {
        is_quoted = false;
      }
    } else if (c == '"') {
      is_quoted = true;
    } else if (c == ',') {
      row.emplace_back();
    } else if (c == '\n') {
      rows.push_back(std::exchange(row, TableRow{""}));
    } else if (c != '\r') {
      row.back() += c;
    }
  }
  if (row != TableRow{""}) rows.push_back(std::move(row));
  std::erase(rows, TableRow{""});
  return rows;
}

// Export.

std::string type_text(const Field& data_type, const Field& object_type) {
  const auto code = number_of(object_type);
  for (const CodeName& row : code_names) {
    if (code == row.code) return std::string{row.name};
  }
  const auto number = number_of(data_type);
  const canopen::DataTypeRow* const type =
      number && *number <= UINT16_MAX ? canopen::find_data_type(static_cast<std::uint32_t>(*number)) : nullptr;
  return type != nullptr ? std::string{type->name} : std::string{data_type.text};
}

TableRow row_of(const EntryDescription& entry, std::uint16_t index, const std::string& sub) {
  std::string unit{entry.factor.text};
  if (!unit.empty() && !entry.unit.text.empty()) unit += ' ';
  unit += entry.unit.text;
  return {fmt::format("{:04X}h", index),
          sub,
          std::string{entry.parameter_name.text},
          type_text(entry.data_type, entry.object_type),
          std::string{entry.access_type.text},
          std::string{entry.default_value.text},
          std::string{entry.low_limit.text},
          std::string{entry.high_limit.text},
          std::move(unit)};
}

struct ExportSettings {
  std::string path;
  std::string output;
};

int export_table(const ExportSettings& settings) {
  const auto file = open_file(settings.path);
  std::string text = csv_line({std::begin(table_columns), std::end(table_columns)});
  for (const ObjectDescription& object : file->sheet.objects) {
    if (object.has_section) text += csv_line(row_of(object, object.index, ""));
    for (const SubObjectDescription& sub : object.sub_objects) {
      text += csv_line(row_of(sub, object.index, fmt::format("{:02X}", sub.sub_index)));
    }
  }
  write_output(settings.output, std::move(text), {settings.path});
  return exit_fine;
}

// Import.

struct ImportSettings : EditSettings {
  std::string table;
};

class TableImport {
 public:
  TableImport(const ImportSettings& settings, const OpenSheet& file)
      : settings_(settings), text_(*file.source), notation_(file.source->choices().sub_indices) {}

  std::vector<SheetChange> changes(const std::vector<TableRow>& rows) {
    for (std::size_t line = 1; line < rows.size(); ++line) read_row(rows[line], line + 1);
    for (auto& [index, sections] : added_) complete(index, sections);
    std::vector<SheetChange> changes;
    AddSections added;
    for (auto& [index, sections] : added_) std::ranges::move(sections, std::back_inserter(added.sections));
    if (!added.sections.empty()) changes.emplace_back(std::move(added));
    std::ranges::move(changes_, std::back_inserter(changes));
    return changes;
  }

 private:
  [[noreturn]] void fail_in(std::size_t line, const std::string& problem) const {
    fail(fmt::format("{}:{}: {}", settings_.table, line, problem), exit_input_has_errors);
  }

  void read_row(TableRow row, std::size_t line) {
    if (row.size() > std::size(table_columns)) fail_in(line, "too many columns");
    row.resize(std::size(table_columns));
    const auto address = parse_entry_address(trim(row[index_column]));
    if (!address || address->sub_index) fail_in(line, row[index_column] + " is not an index");
    std::string title = fmt::format("{:04X}", address->index);
    if (!row[sub_column].empty()) {
      const auto sub = parse_hex(trim(row[sub_column]), 2);
      if (!sub) fail_in(line, row[sub_column] + " is not a sub-index of two hexadecimal digits");
      title += notation_ == SubIndexNotation::decimal ? fmt::format("sub{}", *sub) : fmt::format("sub{:X}", *sub);
    }
    const std::vector<std::pair<std::string, std::string>> keys = keys_of(row, line);
    const TextSection* const section = text_.find(title);
    if (section != nullptr) return change(*section, keys);
    NewSection added{title, keys};
    added.keys.emplace_back("PDOMapping", "0");
    added_[address->index].push_back(std::move(added));
  }

  std::vector<std::pair<std::string, std::string>> keys_of(const TableRow& row, std::size_t line) const {
    std::vector<std::pair<std::string, std::string>> keys;
    const auto add = [&](std::string_view key, std::string value) {
      if (!value.empty()) keys.emplace_back(key, std::move(value));
    };
    for (const KeyColumn& column : key_columns) add(column.key, row[column.column]);
    const std::string& type = row[type_column];
    const auto code = std::ranges::find(code_names, std::string_view{type}, &CodeName::name);
    if (code != std::end(code_names)) {
      add("ObjectType", fmt::format("0x{:X}", code->code));
    } else if (const canopen::DataTypeRow* const found = find_type_by_name(type)) {
      add("DataType", fmt::format("0x{:04X}", static_cast<unsigned>(found->type)));
    } else if (parse_unsigned(type)) {
      add("DataType", type);
    } else if (!type.empty()) {
      fail_in(line, type + " is not a data type");
    }
    const FactorAndUnit unit = read_unit(row[unit_column]);
    add("Unit", unit.unit);
    add("Factor", unit.factor);
    return keys;
  }

  /// Empty columns remain.
  void change(const TextSection& section, const std::vector<std::pair<std::string, std::string>>& keys) {
    for (const auto& [key, value] : keys) {
      const auto entry = text_.find_entry(section, key);
      const std::string_view old = entry ? entry->value : std::string_view{};
      const auto old_number = parse_unsigned(strip_inline_comment(old));
      const bool is_same = old == value || (old_number && old_number == parse_unsigned(value));
      if (!is_same) changes_.emplace_back(SetValue{std::string{section.title}, key, value});
    }
  }

  /// What a table does not state: object code, SubNumber, sub-index 0.
  void complete(std::uint16_t index, std::vector<NewSection>& sections) const {
    const auto has = [](const NewSection& section, std::string_view key) {
      return std::ranges::find(section.keys, key, &std::pair<std::string, std::string>::first) != section.keys.end();
    };
    const std::string title = fmt::format("{:04X}", index);
    const auto object = std::ranges::find(sections, title, &NewSection::title);
    const bool has_subs = sections.size() > (object == sections.end() ? 0U : 1U);
    for (NewSection& section : sections) {
      if (!has(section, "ObjectType")) section.keys.emplace_back("ObjectType", "0x7");
    }
    if (object == sections.end() || !has_subs) return;
    std::erase_if(object->keys, [](const auto& key) { return key.first == "PDOMapping"; });
    object->keys.emplace_back("SubNumber", fmt::format("{}", sections.size() - 1));
  }

  const ImportSettings& settings_;
  SheetText text_;
  SubIndexNotation notation_;
  std::map<std::uint16_t, std::vector<NewSection>> added_;
  std::vector<SheetChange> changes_;
};

int import_table(const ImportSettings& settings) {
  const auto file = open_file(settings.path);
  std::string error;
  const auto source = read_source_file(settings.table, error);
  if (!source) fail(error);
  const std::vector<TableRow> rows = read_csv(source->text());
  if (rows.empty() || !std::ranges::equal(rows.front(), table_columns)) {
    fail(fmt::format("{}: the first line must be {}", settings.table, fmt::join(table_columns, ",")),
         exit_input_has_errors);
  }
  return edit_file(settings, *file, TableImport(settings, *file).changes(rows));
}

}  // namespace

void add_object_import_options(Command command, int& exit_code) {
  ImportSettings& settings = define_command(command, "", import_table, exit_code);
  command.add_option("FILE", settings.path, "EDS or DCF").required();
  command
      .add_option("SOURCE", settings.table,
                  "CSV file with the columns index, sub, name, type, access, default, low, high, unit; empty fields of "
                  "an object that exists remain")
      .required();
  settings.add_to(command);
}

void add_object_export_options(Command command, int& exit_code) {
  ExportSettings& settings = define_command(command, "", export_table, exit_code);
  command.add_option("FILE", settings.path, "EDS or DCF").required();
  command.add_option("--output", settings.output, "CSV file (default: standard output)");
}

}  // namespace edsc
