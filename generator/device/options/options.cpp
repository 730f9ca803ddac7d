#include "device/options/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "device/options/option_file.hpp"
#include "device/options/option_table.hpp"
#include "device/options/structured_options.hpp"
#include "eds/number.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

using nlohmann::json;

/// The number in a text; nothing above `max`.
std::optional<std::uint32_t> number_in(const json& value, std::uint32_t max) {
  const auto number = value.is_string() ? parse_unsigned(value.get<std::string>()) : std::nullopt;
  return number && *number <= max ? std::optional{static_cast<std::uint32_t>(*number)} : std::nullopt;
}

bool is_abort_code(std::uint32_t number) {
  return std::ranges::any_of(canopen::abort_code_texts, [&](const canopen::AbortCodeText& text) {
    return text.code != canopen::ok && static_cast<std::uint32_t>(text.code) == number;
  });
}

/// An option in the form of its row; nothing if the value is invalid.
std::optional<RuntimeOption> parse_option(const OptionRow& row, const json& value) {
  std::optional<std::uint32_t> number;
  switch (row.form) {
    case OptionForm::flag:
      if (value.is_boolean()) number = value.get<bool>() ? 1 : 0;
      break;
    case OptionForm::number:
      if (value.is_number_unsigned() && value >= row.min && value <= row.max) number = value.get<std::uint32_t>();
      break;
    case OptionForm::mask: number = number_in(value, 0xFFFF'FFFF); break;
    case OptionForm::abort_code:
      number = number_in(value, 0xFFFF'FFFF);
      if (number && !is_abort_code(*number)) number.reset();
      break;
    case OptionForm::emergency_code:
      if (value.is_string()) number = parse_index(value.get<std::string>());
      if (number == 0U) number.reset();
      break;
    case OptionForm::can_id_range: {
      const bool is_pair = value.is_array() && value.size() == 2;
      number = is_pair ? number_in(value[0], 0x7FF) : std::nullopt;
      const auto last = is_pair ? number_in(value[1], 0x7FF) : std::nullopt;
      if (!number || !last || *number > *last) return std::nullopt;
      return RuntimeOption{&row, *number, *last};
    }
    case OptionForm::structured: break;
  }
  return number ? std::optional{RuntimeOption{&row, *number}} : std::nullopt;
}

/// The values that an option accepts.
std::string expected(const OptionRow& row) {
  switch (row.form) {
    case OptionForm::flag: return "expected true or false";
    case OptionForm::number: return fmt::format("expected a number from {} to {}", row.min, row.max);
    case OptionForm::mask: return "expected a 32-bit mask such as \"0x80000780\"";
    case OptionForm::abort_code: return "expected an abort code of CiA 301 such as \"0x06040041\"";
    case OptionForm::emergency_code: return "expected an emergency error code such as \"FF00h\"";
    case OptionForm::can_id_range:
      return "expected the first and the last of a range of CAN-IDs: [\"0x080\", \"0x100\"]";
    case OptionForm::structured: break;
  }
  return "";
}

/// `"timeout" in "sdo"`.
std::string in_its_group(const OptionRow& row) { return fmt::format("\"{}\" in \"{}\"", row.name, row.group.name); }

/// What a user may have written, and what edsc suggests for it.
struct WrittenName {
  std::string_view text;
  std::string suggestion;
};

/// The options of a group; with an empty name all members of the file.
std::vector<WrittenName> written_names_in(std::string_view group) {
  std::vector<WrittenName> names;
  if (group.empty()) names.push_back({"$schema", "\"$schema\""});
  for (const OptionRow& row : options_table) {
    if (row.group.name == group) names.push_back({row.name, fmt::format("\"{}\"", row.name)});
    if (group.empty() && !row.group.name.empty()) {
      names.push_back({row.group.name, fmt::format("\"{}\"", row.group.name)});
      names.push_back({row.flat_name, in_its_group(row)});
    } else if (row.group.name == group) {
      names.push_back({row.flat_name, fmt::format("\"{}\"", row.name)});
    }
  }
  return names;
}

std::string unknown_option(std::string_view group, std::string_view name) {
  const std::vector<WrittenName> names = written_names_in(group);
  std::vector<std::string_view> texts;
  texts.reserve(names.size());
  for (const WrittenName& one : names) texts.push_back(one.text);
  const std::string_view similar = most_similar(name, texts);
  if (similar.empty()) return "unknown option";
  return fmt::format("unknown option; did you mean {}?",
                     std::ranges::find(names, similar, &WrittenName::text)->suggestion);
}

/// Reads the members of an options file.
class OptionsReader {
 public:
  OptionsReader(NameCheck is_name, OptionFile& file, Options& options)
      : is_name_{is_name}, file_{file}, options_{options} {}

  void read(const json& document) {
    for (const auto& [name, value] : document.items()) {
      if (name == "$schema") continue;
      if (const OptionGroup* const group = find_option_group(name)) {
        read_group(*group, value);
      } else if (const OptionRow* const row = find_option("", name)) {
        read_option(*row, name, value);
      } else if (const OptionRow* const flat = find_flat_option(name)) {
        read_flat(*flat, value, document);
      } else {
        file_.error(value, name, unknown_option("", name));
      }
    }
    std::ranges::sort(options_.runtime, {}, [](const RuntimeOption& option) { return member_of(*option.row); });
  }

 private:
  void read_group(const OptionGroup& group, const json& members) {
    const std::string name{group.name};
    if (!members.is_object()) {
      return file_.error(members, name, fmt::format("expected an object with {} options", group.title));
    }
    if (group.name == lss_group) options_.lss.emplace();
    for (const auto& [member, value] : members.items()) {
      const std::string path = fmt::format("{}.{}", name, member);
      if (const OptionRow* const row = find_option(group.name, member)) {
        read_option(*row, path, value);
      } else {
        file_.error(value, path, unknown_option(group.name, member));
      }
    }
  }

  /// An option by its deprecated name.
  void read_flat(const OptionRow& row, const json& value, const json& document) {
    const std::string flat_name{row.flat_name};
    const auto group = document.find(row.group.name);
    if (group != document.end() && group->contains(row.name)) {
      return file_.error(value, flat_name, fmt::format("already set by {}", in_its_group(row)));
    }
    options_.deprecated.push_back(
        {file_.json().name_position(value), fmt::format("\"{}\" is deprecated; use {}", flat_name, in_its_group(row))});
    read_option(row, flat_name, value);
  }

  /// `path` is where the file has the option.
  void read_option(const OptionRow& row, const std::string& path, const json& value) {
    if (row.form == OptionForm::structured) return read_structured_option(row, path, value, is_name_, file_, options_);
    const auto option = parse_option(row, value);
    if (!option) return file_.error(value, path, expected(row));
    if (row.group.name == lss_group) {
      options_.lss->flags[std::string{row.name}] = option->value != 0;
    } else {
      options_.runtime.push_back(*option);
    }
  }

  static constexpr std::string_view lss_group = option_table::lss.name;

  NameCheck is_name_;
  OptionFile& file_;
  Options& options_;
};

}  // namespace

std::uint32_t Options::inhibit_time_unit() const {
  constexpr const OptionRow* unit = find_option("pdo", "inhibit_time_unit");
  const auto stated = std::ranges::find(runtime, unit, &RuntimeOption::row);
  return stated == runtime.end() ? usual_inhibit_time_unit : stated->value;
}

bool Options::allows_for_pdo(std::uint32_t can_id) const {
  constexpr const OptionRow* allowed = find_option("pdo", "allowed_can_ids");
  const auto stated = std::ranges::find(runtime, allowed, &RuntimeOption::row);
  return stated != runtime.end() && can_id >= stated->value && can_id <= stated->last;
}

bool Options::states(const OptionRow& row) const {
  return std::ranges::find(runtime, &row, &RuntimeOption::row) != runtime.end();
}

bool Options::is_set(const OptionRow& row) const {
  const auto stated = std::ranges::find(runtime, &row, &RuntimeOption::row);
  return stated != runtime.end() && stated->value != 0;
}

void Options::set(const RuntimeOption& option) {
  const auto after = std::ranges::find_if(
      runtime, [&](const RuntimeOption& one) { return member_of(*one.row) > member_of(*option.row); });
  runtime.insert(after, option);
}

Options read_options(const SourceFile& source, NameCheck is_name, Diagnostics& diagnostics) {
  const JsonFile json_file{source};
  json_file.report_faults("options-syntax", diagnostics);
  Options options;
  if (!json_file.is_valid()) return options;
  const json& document = json_file.root();
  OptionFile file{json_file, diagnostics};
  if (!document.is_object()) {
    file.error(document, "", "the options file must be one JSON object");
    return options;
  }
  OptionsReader{is_name, file, options}.read(document);
  return options;
}

}  // namespace edsc
