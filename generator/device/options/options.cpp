#include "device/options/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <canopen/base/abort_code.hpp>
#include <canopen/lss/lss_options.hpp>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "device/identifier.hpp"
#include "device/index_range.hpp"
#include "device/options/option_table.hpp"
#include "eds/number.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 3> allow_members = {"rule", "object", "reason"};
constexpr const char* allow_form =
    "expected an array of objects: [{\"rule\": \"pdo-empty\", \"object\": \"1A00h\", \"reason\": \"mapped at start\"}]";

/// Enumerators of canopen::Storing that differ from the access type of an entry.
constexpr std::array storing_names = {"always", "never", "with_node_id"};

/// `1018h` or `1018`: an index.
std::optional<std::uint16_t> parse_index(std::string_view text) {
  if (text.ends_with('h')) text.remove_suffix(1);
  const auto index = parse_unsigned(fmt::format("0x{}", text));
  return index && *index <= 0xFFFF ? std::optional{static_cast<std::uint16_t>(*index)} : std::nullopt;
}

/// `6401h:03`, or `6401h` for the whole object.
std::optional<EntrySelector> parse_entry_selector(std::string_view text) {
  const std::size_t colon = text.find(':');
  const auto index = parse_index(text.substr(0, colon));
  if (!index) return std::nullopt;
  if (colon == std::string_view::npos) return EntrySelector{*index, std::nullopt};
  const auto sub_index = parse_unsigned(fmt::format("0x{}", text.substr(colon + 1)));
  if (!sub_index || *sub_index > 0xFF) return std::nullopt;
  return EntrySelector{*index, static_cast<std::uint8_t>(*sub_index)};
}

/// `1018h:04`, `1018:4` or `1018h`: an entry of the dictionary.
std::optional<EntryKey> parse_entry_key(std::string_view text) {
  const auto entry = parse_entry_selector(text);
  return entry ? std::optional{EntryKey{entry->index, entry->sub_index.value_or(0)}} : std::nullopt;
}

/// Ten hexadecimal digits: five bytes.
std::optional<EmergencyInfo> parse_emergency_info(std::string_view text) {
  EmergencyInfo bytes{};
  if (text.size() != 2 * bytes.size()) return std::nullopt;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto byte = parse_unsigned(fmt::format("0x{}", text.substr(2 * i, 2)));
    if (!byte) return std::nullopt;
    bytes[i] = static_cast<std::uint8_t>(*byte);
  }
  return bytes;
}

class OptionsReader {
 public:
  OptionsReader(const SourceFile& source, Diagnostics& diagnostics) : source_{source}, diagnostics_{diagnostics} {}

  Options read() {
    json document;
    try {
      document = json::parse(source_.text());
    } catch (const json::parse_error& problem) {
      diagnostics_.error("options-syntax", position_at(problem.byte), fmt::format("not JSON: {}", what_of(problem)));
      return {};
    } catch (const json::out_of_range& problem) {
      diagnostics_.error("options-syntax", Position{&source_}, fmt::format("not JSON: {}", what_of(problem)));
      return {};
    }
    if (!document.is_object()) {
      error("", "the options file must be one JSON object");
      return {};
    }
    for (const auto& [name, value] : document.items()) member(name, value);
    return std::move(options_);
  }

 private:
  using Read = void (OptionsReader::*)(const json& value);
  struct StructuredOption {
    std::string_view name;
    Read read;
  };
  /// Returns the readers of the options with form `structured`.
  static std::span<const StructuredOption> structured_options();

  void member(const std::string& name, const json& value) {
    if (name == "$schema") return;
    const OptionRow* const row = find_option(name);
    if (row == nullptr) return error(name, "unknown option" + did_you_mean(name, all_names()));
    switch (row->form) {
      case OptionForm::flag: return flag(*row, value);
      case OptionForm::number: return number(*row, value);
      case OptionForm::mask: return mask(*row, value);
      case OptionForm::abort_code: return abort_code(*row, value);
      case OptionForm::emergency_code: return emergency_code(*row, value);
      case OptionForm::can_id_range: return can_id_range(*row, value);
      case OptionForm::structured: break;
    }
    const auto option = std::ranges::find(structured_options(), name, &StructuredOption::name);
    (this->*option->read)(value);
  }

  static std::vector<std::string_view> all_names() {
    std::vector<std::string_view> names{"$schema"};
    for (const OptionRow& row : options_table) names.push_back(row.name);
    return names;
  }

  void set(const OptionRow& row, std::string value) { options_.runtime.emplace_back(row.name, std::move(value)); }

  void names(const json& value) {
    each_entry("names", value, [&](EntryKey key, const json& v) { return name_of(key, v); });
  }

  void string_capacity(const json& value) {
    each_entry("string_capacity", value, [&](EntryKey key, const json& v) { return capacity_of(key, v); });
  }

  void zero_terminated_strings(const json& value) {
    is_flag("zero_terminated_strings", value, options_.zero_terminated_strings);
  }

  void each_entry(const std::string& name, const json& value, const std::function<bool(EntryKey, const json&)>& take) {
    if (!value.is_object()) return error(name, "expected an object with one member per entry, such as \"1018h:04\"");
    for (const auto& [entry, v] : value.items()) {
      const auto key = parse_entry_key(entry);
      if (!key) {
        error(name + "/" + entry, "not an entry such as \"1018h:04\"");
      } else if (!take(*key, v)) {
        error(name + "/" + entry, "invalid value for this option");
      }
    }
  }

  bool name_of(EntryKey key, const json& value) {
    if (!value.is_string() || !is_identifier(value.get_ref<const std::string&>())) return false;
    options_.names[key] = value.get<std::string>();
    return true;
  }

  bool capacity_of(EntryKey key, const json& value) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > 0xFFFF) return false;
    options_.string_capacity[key] = value.get<std::uint16_t>();
    return true;
  }

  void settable(const json& value) {
    if (!value.is_array()) return error("settable", "expected an array of entries such as \"1018h:04\"");
    for (const json& item : value) {
      const auto key = item.is_string() ? parse_entry_key(item.get<std::string>()) : std::nullopt;
      if (!key) {
        error("settable", "not an entry such as \"1018h:04\"");
      } else {
        options_.settable.push_back(*key);
      }
    }
  }

  void silence(const json& value) {
    if (!value.is_array()) return error("silence", "expected an array of rule ids");
    for (const json& item : value) {
      if (item.is_string()) {
        options_.silence.push_back({item.get<std::string>(), position_of(item.get<std::string>())});
      } else {
        error("silence", "expected an array of rule ids");
      }
    }
  }

  void allow(const json& value) {
    if (!value.is_array()) return error("allow", allow_form);
    for (const json& item : value) allow_one(item);
  }

  void allow_one(const json& item) {
    if (!item.is_object()) return error("allow", allow_form);
    AllowedFindings allowed;
    for (const auto& [name, v] : item.items()) {
      const std::string text = v.is_string() ? v.get<std::string>() : std::string{};
      const auto object = name == "object" ? parse_entry_selector(text) : std::nullopt;
      if (name == "rule" && !text.empty()) {
        allowed.rule = text;
      } else if (name == "reason" && text.find_first_not_of(" \t\r\n") != std::string::npos) {
        allowed.reason = text;
      } else if (name == "object" && object) {
        allowed.object = object;
      } else if (std::ranges::find(allow_members, name) == allow_members.end()) {
        return error("allow/" + name, "unknown member" + did_you_mean(name, allow_members));
      } else {
        return error("allow/" + name, name == "object" ? "not an object or entry such as \"6040h\" or \"6401h:03\""
                                                       : "expected a non-empty string");
      }
    }
    if (allowed.rule.empty() || allowed.reason.empty()) {
      return error("allow", allowed.rule.empty() ? "missing member rule" : "missing member reason");
    }
    allowed.position = position_of_text(json(allowed.reason).dump());
    options_.allow.push_back(std::move(allowed));
  }

  void connected_modules(const json& value) {
    constexpr const char* meaning = "expected an array of numbers of [SupportedModules]";
    if (!value.is_array()) return error("connected_modules", meaning);
    for (const json& item : value) {
      if (item.is_number_unsigned() && item.get<std::uint64_t>() >= 1 && item.get<std::uint64_t>() <= 0xFFFF) {
        options_.connected_modules.push_back(item.get<std::uint16_t>());
      } else {
        error("connected_modules", meaning);
      }
    }
  }

  void static_mapping(const json& value) {
    constexpr const char* meaning = "expected true, or an array of mapping parameters such as \"1A00h\"";
    if (value.is_boolean()) {
      options_.static_mapping.all = value.get<bool>();
      return;
    }
    if (!value.is_array()) return error("static_mapping", meaning);
    for (const json& item : value) {
      const auto index = item.is_string() ? parse_index(item.get<std::string>()) : std::nullopt;
      if (index && contains(mapping_parameters, *index)) {
        options_.static_mapping.parameters.push_back(*index);
      } else {
        error("static_mapping", meaning);
      }
    }
  }

  void no_event(const json& value) {
    constexpr const char* meaning = "expected an array of objects or entries such as \"6401h\" or \"6401h:03\"";
    if (!value.is_array()) return error("no_event", meaning);
    for (const json& item : value) {
      const auto entry = item.is_string() ? parse_entry_selector(item.get<std::string>()) : std::nullopt;
      if (entry) {
        options_.no_event.push_back(*entry);
      } else {
        error("no_event", meaning);
      }
    }
  }

  void emergency_info(const json& value) {
    constexpr const char* meaning =
        "expected an object with one member for each error code: {\"8210h\": \"0900000000\"}";
    if (!value.is_object()) return error("emergency_info", meaning);
    for (const auto& [code, bytes] : value.items()) {
      const auto number = parse_index(code);
      const auto info = bytes.is_string() ? parse_emergency_info(bytes.get<std::string>()) : std::nullopt;
      if (number && info) {
        options_.emergency_info[*number] = *info;
      } else {
        error("emergency_info/" + code,
              number ? "expected five bytes as ten hexadecimal digits" : "not a code such as \"8210h\"");
      }
    }
  }

  void storing(const json& value) {
    constexpr const char* meaning =
        "expected an object with one member for each object or entry: {\"6010h:01\": \"never\"}";
    if (!value.is_object()) return error("storing", meaning);
    for (const auto& [text, how] : value.items()) {
      const auto entry = parse_entry_selector(text);
      const bool known =
          how.is_string() && std::ranges::find(storing_names, how.get<std::string>()) != storing_names.end();
      const bool with_node_id = how == "with_node_id";
      if (entry && with_node_id && (entry->index < 0x1000 || entry->index > 0x1FFF)) {
        error("storing/" + text, "with_node_id is for objects 1000h..1FFFh");
      } else if (entry && known) {
        options_.storing.emplace_back(*entry, how.get<std::string>());
      } else {
        error("storing/" + text,
              entry ? "expected always, never or with_node_id" : "not an object or entry such as \"6010h:01\"");
      }
    }
  }

  void lss(const json& value) {
    if (!value.is_object()) return error("lss", "expected an object: {\"bit_rates\": [125, 500], \"fastscan\": false}");
    LssSettings& settings = options_.lss.emplace();
    for (const auto& [name, v] : value.items()) {
      const std::string path = "lss/" + name;
      if (name == "bit_rates") {
        settings.bit_rates = lss_bit_rates(path, v);
      } else if (std::ranges::find(lss_flags, name) == lss_flags.end()) {
        error(path, "unknown option");
      } else if (bool on = false; is_flag(path, v, on)) {
        settings.flags[name] = on;
      }
    }
  }

  /// One bit for each index of table 0 of CiA 305; none for a fixed bit rate.
  std::optional<std::uint16_t> lss_bit_rates(const std::string& path, const json& value) {
    constexpr const char* meaning =
        "expected \"fixed\", or an array of bit rates of CiA 301 in kbit/s, such as [125, 500], and \"auto\"";
    if (value == "fixed") return std::uint16_t{0};
    unsigned mask = 0;
    bool valid = value.is_array() && !value.empty();
    for (const json& item : valid ? value : json::array()) {
      const auto bit = lss_bit_rate(item);
      valid = valid && bit.has_value();
      mask |= 1u << bit.value_or(0);
    }
    if (valid) return static_cast<std::uint16_t>(mask);
    error(path, meaning);
    return std::nullopt;
  }

  /// The index of table 0.
  static std::optional<std::size_t> lss_bit_rate(const json& value) {
    if (value == "auto") return canopen::lss::automatic_bit_rate;
    if (!value.is_number_unsigned() || value == 0) return std::nullopt;
    const auto* const at = std::ranges::find(canopen::lss::bit_rates, value.get<std::uint64_t>());
    if (at == std::end(canopen::lss::bit_rates)) return std::nullopt;
    return static_cast<std::size_t>(at - std::begin(canopen::lss::bit_rates));
  }

  void stored_eds(const json& value) {
    if (value.is_boolean()) {
      options_.stored_eds = value.get<bool>() ? StoredEds::text : StoredEds::of_application;
    } else if (value == "compressed") {
      options_.stored_eds = StoredEds::compressed;
    } else {
      error("stored_eds", "expected true, false or \"compressed\"");
    }
  }

  bool is_flag(const std::string& name, const json& value, bool& target) {
    if (value.is_boolean()) {
      target = value.get<bool>();
    } else {
      error(name, "expected true or false");
    }
    return value.is_boolean();
  }

  void flag(const OptionRow& row, const json& value) {
    if (bool on = false; is_flag(std::string{row.name}, value, on)) set(row, on ? "true" : "false");
  }

  void mask(const OptionRow& row, const json& value) {
    const auto bits = value.is_string() ? parse_unsigned(value.get<std::string>()) : std::nullopt;
    if (!bits || *bits > 0xFFFF'FFFF) return error(row.name, "expected a 32-bit mask such as \"0x80000780\"");
    set(row, fmt::format("0x{:08X}", *bits));
  }

  void abort_code(const OptionRow& row, const json& value) {
    const auto code = value.is_string() ? parse_unsigned(value.get<std::string>()) : std::nullopt;
    const bool known = std::ranges::any_of(canopen::abort_code_texts, [&](const canopen::AbortCodeText& text) {
      return text.code != canopen::ok && static_cast<std::uint32_t>(text.code) == code;
    });
    if (!known) return error(row.name, "expected an abort code of CiA 301 such as \"0x06040041\"");
    set(row, fmt::format("0x{:08X}", *code));
  }

  void number(const OptionRow& row, const json& value) {
    const std::uint64_t count = value.is_number_unsigned() ? value.get<std::uint64_t>() : 0;
    if (!value.is_number_unsigned() || count < row.min || count > row.max) {
      return error(row.name, fmt::format("expected a number from {} to {}", row.min, row.max));
    }
    set(row, fmt::format("{}", count));
  }

  void can_id_range(const OptionRow& row, const json& value) {
    const auto can_id = [&](std::size_t at) {
      const bool exists = value.is_array() && value.size() == 2 && value[at].is_string();
      return exists ? parse_unsigned(value[at].get<std::string>()) : std::nullopt;
    };
    const auto first = can_id(0);
    const auto last = can_id(1);
    if (!first || !last || *first > *last || *last > 0x7FF) {
      return error(row.name, "expected the first and the last of a range of CAN-IDs: [\"0x080\", \"0x100\"]");
    }
    set(row, fmt::format("{{0x{:03X}, 0x{:03X}}}", *first, *last));
  }

  void emergency_code(const OptionRow& row, const json& value) {
    const auto code = value.is_string() ? parse_index(value.get<std::string>()) : std::nullopt;
    if (!code || *code == 0) return error(row.name, "expected an emergency error code such as \"FF00h\"");
    set(row, fmt::format("0x{:04X}", *code));
  }

  /// The position of a member's name, approximately: its first occurrence in quotes.
  [[nodiscard]] Position position_of(std::string_view member) const {
    const std::string_view last = member.substr(member.rfind('/') + 1);
    return position_of_text(fmt::format("\"{}\"", last));
  }

  [[nodiscard]] Position position_of_text(std::string_view text) const {
    const std::size_t at = source_.text().find(text);
    return at == std::string_view::npos ? Position{&source_} : position_at(at + 1);
  }

  /// `byte` counts from 1.
  [[nodiscard]] Position position_at(std::size_t byte) const {
    Position position{&source_, 1, 1};
    const std::string_view text = source_.text();
    for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
      ++position.column;
      if (text[i] == '\n') {
        ++position.line;
        position.column = 1;
      }
    }
    return position;
  }

  /// The message of the parser without its position and number.
  static std::string what_of(const json::exception& problem) {
    const std::string_view what = problem.what();
    const std::size_t colon = what.find(": ");
    return std::string{colon == std::string_view::npos ? what : what.substr(colon + 2)};
  }

  void error(std::string_view member, const std::string& message) {
    const std::string place = member.empty() ? "" : fmt::format("{}: ", member);
    diagnostics_.error("options", position_of(member), fmt::format("{}{}", place, message));
  }

  const SourceFile& source_;
  Diagnostics& diagnostics_;
  Options options_;
};

std::span<const OptionsReader::StructuredOption> OptionsReader::structured_options() {
  static constexpr StructuredOption rows[] = {
      {"names", &OptionsReader::names},
      {"string_capacity", &OptionsReader::string_capacity},
      {"settable", &OptionsReader::settable},
      {"connected_modules", &OptionsReader::connected_modules},
      {"silence", &OptionsReader::silence},
      {"allow", &OptionsReader::allow},
      {"static_mapping", &OptionsReader::static_mapping},
      {"no_event", &OptionsReader::no_event},
      {"emergency_info", &OptionsReader::emergency_info},
      {"storing", &OptionsReader::storing},
      {"zero_terminated_strings", &OptionsReader::zero_terminated_strings},
      {"lss", &OptionsReader::lss},
      {"stored_eds", &OptionsReader::stored_eds},
  };
  static_assert(std::ranges::all_of(options_table, [](const OptionRow& row) {
    return (row.form == OptionForm::structured) ==
           (std::ranges::find(rows, row.name, &StructuredOption::name) != std::end(rows));
  }));
  return rows;
}

}  // namespace

Options read_options(const SourceFile& source, Diagnostics& diagnostics) {
  return OptionsReader{source, diagnostics}.read();
}

}  // namespace edsc
