#include "device/options/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <nlohmann/json.hpp>
#include <optional>

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
std::optional<RuntimeOption> read_option(const OptionRow& row, const json& value) {
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

std::string unknown_option(const std::string& name) {
  std::vector<std::string_view> names{"$schema"};
  for (const OptionRow& row : options_table) names.push_back(row.name);
  return "unknown option" + did_you_mean(name, names);
}

void read_member(const std::string& name, const json& value, NameCheck is_name, OptionFile& file, Options& options) {
  if (name == "$schema") return;
  const OptionRow* const row = find_option(name);
  if (row == nullptr) return file.error(name, unknown_option(name));
  if (row->form == OptionForm::structured) return read_structured_option(name, value, is_name, file, options);
  if (const auto option = read_option(*row, value)) {
    options.runtime.push_back(*option);
  } else {
    file.error(name, expected(*row));
  }
}

}  // namespace

Options read_options(const SourceFile& source, NameCheck is_name, Diagnostics& diagnostics) {
  OptionFile file{source, diagnostics};
  Options options;
  json document;
  try {
    document = json::parse(source.text());
  } catch (const json::parse_error& problem) {
    file.syntax_error(problem.byte, problem.what());
    return options;
  } catch (const json::out_of_range& problem) {
    file.syntax_error({}, problem.what());
    return options;
  }
  if (!document.is_object()) {
    file.error("", "the options file must be one JSON object");
    return options;
  }
  for (const auto& [name, value] : document.items()) read_member(name, value, is_name, file, options);
  return options;
}

}  // namespace edsc
