#include "device/options/structured_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <canopen/lss/lss_options.hpp>
#include <canopen/storage/parameter_ranges.hpp>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "device/index_range.hpp"
#include "device/options/option_table.hpp"
#include "eds/number.hpp"
#include "text/reading_choices.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 3> allow_members = {"rule", "object", "reason"};
constexpr const char* allow_form =
    "expected an array of objects: [{\"rule\": \"pdo-empty\", \"object\": \"1A00h\", \"reason\": \"mapped at start\"}]";

/// Enumerators of canopen::Storing that differ from the access type of an entry.
constexpr std::array storing_names = {"always", "never", "with_node_id"};

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

/// What `parse` reads from a text; nothing for another value.
template <class Parse>
auto parsed(const json& value, Parse parse) {
  return value.is_string() ? parse(value.get<std::string>()) : decltype(parse("")){};
}

class StructuredOptions {
 public:
  StructuredOptions(const std::string& path, const json& value, NameCheck is_name, OptionFile& file, Options& options)
      : path_{path}, value_{value}, is_name_{is_name}, file_{file}, options_{options} {}

  void read(const OptionRow& row) {
    const ReadingChoiceRow* const choice = row.group.name.empty() ? find_reading_option(row.name) : nullptr;
    if (choice != nullptr) return reading_choice(*choice);
    struct Reader {
      std::string_view group;
      std::string_view name;
      void (StructuredOptions::*read)(const json& value);

      [[nodiscard]] constexpr bool reads(const OptionRow& other) const {
        return other.group.name == group && other.name == name;
      }
    };
    static constexpr Reader readers[] = {
        {"", "encoding", nullptr},  // a reading choice, as the next two
        {"", "sub_indices", nullptr},
        {"", "access_types", nullptr},
        {"", "names", &StructuredOptions::names},
        {"", "string_capacity", &StructuredOptions::string_capacity},
        {"", "settable", &StructuredOptions::settable},
        {"", "connected_modules", &StructuredOptions::connected_modules},
        {"", "stored_eds", &StructuredOptions::stored_eds},
        {"", "meaning", &StructuredOptions::meaning},
        {"", "typed_values", &StructuredOptions::typed_values},
        {"", "silence", &StructuredOptions::silence},
        {"", "allow", &StructuredOptions::allow},
        {"pdo", "static_mapping", &StructuredOptions::static_mapping},
        {"pdo", "no_event", &StructuredOptions::no_event},
        {"emcy", "info", &StructuredOptions::emergency_info},
        {"storage", "entries", &StructuredOptions::storing},
        {"storage", "sub_indices", &StructuredOptions::stored_by},
        {"storage", "autonomous", &StructuredOptions::autonomous_storage},
        {"sdo", "zero_terminated_strings", &StructuredOptions::zero_terminated_strings},
        {"lss", "bit_rates", &StructuredOptions::lss_bit_rates},
    };
    static_assert(std::ranges::all_of(options_table, [](const OptionRow& one) {
      const bool is_read = std::ranges::any_of(readers, [&](const Reader& reader) { return reader.reads(one); });
      return (one.form == OptionForm::structured) == is_read;
    }));
    for (const Reader& reader : readers) {
      if (reader.reads(row)) (this->*reader.read)(value_);
    }
  }

 private:
  /// Calls `take` for each item of an array; it returns false for an invalid one.
  template <class Take>
  void each_item(const json& value, const char* meaning, Take take, const char* item_meaning = nullptr) {
    if (!value.is_array()) return error(meaning);
    for (const json& item : value) {
      if (!take(item)) error_at(item, item_meaning != nullptr ? item_meaning : meaning);
    }
  }

  /// The same for each member of an object, by entry.
  template <class Take>
  void each_entry(const json& value, Take take) {
    if (!value.is_object()) return error("expected an object with one member per entry, such as \"1018h:04\"");
    std::map<EntryKey, const json*> first_of;
    for (const auto& [entry, v] : file_.json().members(value)) {
      const auto key = parse_option_entry(entry);
      if (!key) {
        error_in(entry, *v, "not an entry such as \"1018h:04\"");
      } else if (is_first(first_of, *key, entry, *v) && !take(*key, *v)) {
        error_in(entry, *v, "invalid value for this option");
      }
    }
  }

  /// Whether no member before has the same key in another spelling. Reports the member otherwise.
  template <class Key>
  bool is_first(std::map<Key, const json*>& first_of, const Key& key, const std::string& name, const json& value) {
    const auto [first, is_new] = first_of.try_emplace(key, &value);
    if (!is_new) {
      file_.error(value, fmt::format("{}.{}", path_, name), "duplicate member in another spelling",
                  {{file_.json().name_position(*first->second), "the first one"}});
    }
    return is_new;
  }

  template <class List>
  static void sort_unique(List& list) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }

  /// Appends what `parse` reads from each text of an array.
  template <class List, class Parse>
  void append_each(const json& value, const char* meaning, List& list, Parse parse,
                   const char* item_meaning = nullptr) {
    const auto take = [&](const json& item) {
      const auto found = parsed(item, parse);
      if (found) list.push_back(*found);
      return found.has_value();
    };
    each_item(value, meaning, take, item_meaning);
  }

  void names(const json& value) {
    each_entry(value, [&](EntryKey key, const json& v) {
      if (!v.is_string() || !is_name_(v.get_ref<const std::string&>())) return false;
      options_.names[key] = v.get<std::string>();
      return true;
    });
  }

  void reading_choice(const ReadingChoiceRow& row) {
    if (!value_.is_string() || !row.set(value_.get_ref<const std::string&>(), options_.reading)) {
      error(fmt::format("expected {}", row.expected()).c_str());
    }
  }

  void string_capacity(const json& value) {
    each_entry(value, [&](EntryKey key, const json& v) {
      if (!v.is_number_unsigned() || v > 0xFFFFU) return false;
      options_.string_capacity[key] = v.get<std::uint16_t>();
      return true;
    });
  }

  void settable(const json& value) {
    append_each(value, "expected an array of entries such as \"1018h:04\"", options_.settable, parse_option_entry,
                "not an entry such as \"1018h:04\"");
    sort_unique(options_.settable);
  }

  void meaning(const json& value) { options_.meaning = read_meaning(value, path_, MeaningSource::options, file_); }

  void silence(const json& value) {
    each_item(value, "expected an array of rule ids", [&](const json& item) {
      if (item.is_string()) options_.silence.push_back({item.get<std::string>(), file_.json().value_position(item)});
      return item.is_string();
    });
  }

  void allow(const json& value) {
    if (!value.is_array()) return error(allow_form);
    for (const json& item : value) allow_one(item);
  }

  void allow_one(const json& item) {
    if (!item.is_object()) return error_at(item, allow_form);
    AllowedFindings allowed;
    for (const auto& [name, v] : item.items()) {
      const std::string text = v.is_string() ? v.get<std::string>() : std::string{};
      const auto object = name == "object" ? parse_option_address(text) : std::nullopt;
      if (name == "rule" && !text.empty()) {
        allowed.rule = text;
      } else if (name == "reason" && text.find_first_not_of(" \t\r\n") != std::string::npos) {
        allowed.reason = text;
        allowed.position = file_.json().value_position(v);
      } else if (name == "object" && object) {
        allowed.object = object;
      } else if (std::ranges::find(allow_members, name) == allow_members.end()) {
        return error_in(name, v, "unknown member" + did_you_mean(name, allow_members));
      } else {
        return error_in(name, v,
                        name == "object" ? "not an object or entry such as \"6040h\" or \"6401h:03\""
                                         : "expected a non-empty string");
      }
    }
    if (allowed.rule.empty() || allowed.reason.empty()) {
      return error_at(item, allowed.rule.empty() ? "missing member rule" : "missing member reason");
    }
    options_.allow.push_back(std::move(allowed));
  }

  void connected_modules(const json& value) {
    each_item(value, "expected an array of numbers of [SupportedModules]", [&](const json& item) {
      const bool fits = item.is_number_unsigned() && item >= 1U && item <= 0xFFFFU;
      if (fits) options_.connected_modules.push_back(item.get<std::uint16_t>());
      return fits;
    });
  }

  void static_mapping(const json& value) {
    if (value.is_boolean()) {
      options_.static_mapping.all = value.get<bool>();
      return;
    }
    append_each(value, "expected true, or an array of mapping parameters such as \"1A00h\"",
                options_.static_mapping.parameters, [](const std::string& text) {
                  const auto index = parse_index(text);
                  return index && contains(mapping_parameters, *index) ? index : std::nullopt;
                });
    sort_unique(options_.static_mapping.parameters);
  }

  void no_event(const json& value) {
    append_each(value, "expected an array of objects or entries such as \"6401h\" or \"6401h:03\"", options_.no_event,
                parse_option_address);
  }

  void emergency_info(const json& value) {
    if (!value.is_object()) {
      return error("expected an object with one member for each error code: {\"8210h\": \"0900000000\"}");
    }
    std::map<std::uint16_t, const json*> first_of;
    for (const auto& [code, bytes] : file_.json().members(value)) {
      const auto number = parse_index(code);
      const auto info = parsed(*bytes, parse_emergency_info);
      if (number && !is_first(first_of, *number, code, *bytes)) continue;
      if (number && info) {
        options_.emergency_info[*number] = *info;
      } else {
        error_in(code, *bytes,
                 number ? "expected five bytes as ten hexadecimal digits" : "not a code such as \"8210h\"");
      }
    }
  }

  void storing(const json& value) {
    if (!value.is_object()) {
      return error("expected an object with one member for each object or entry: {\"6010h:01\": \"never\"}");
    }
    report_same_selectors(value);
    for (const auto& [text, how] : value.items()) {
      const auto entry = parse_option_address(text);
      const bool known =
          std::ranges::any_of(storing_names, [&spelling = how](const char* name) { return spelling == name; });
      if (entry && how == "with_node_id" && (entry->index < 0x1000 || entry->index > 0x1FFF)) {
        error_in(text, how, "with_node_id is for objects 1000h..1FFFh");
      } else if (entry && known) {
        options_.storing.emplace_back(*entry, how.get<std::string>());
      } else {
        error_in(text, how,
                 entry ? "expected always, never or with_node_id" : "not an object or entry such as \"6010h:01\"");
      }
    }
  }

  void report_same_selectors(const json& object) {
    std::map<std::pair<std::uint16_t, std::optional<std::uint8_t>>, const json*> first_of;
    for (const auto& [text, value] : file_.json().members(object)) {
      if (const auto entry = parse_option_address(text))
        is_first(first_of, {entry->index, entry->sub_index}, text, *value);
    }
  }

  void stored_by(const json& value) {
    if (!value.is_object()) {
      return error("expected an object with one member for each sub-index: {\"05h\": [\"2111h\"]}");
    }
    for (const auto& [text, entries] : value.items()) {
      const auto sub_index = parse_sub_index(text);
      if (!sub_index || *sub_index < canopen::first_group_sub_index || *sub_index > canopen::last_group_sub_index) {
        error_in(text, entries, "not a sub-index from \"05h\" to \"0Eh\"");
        continue;
      }
      const auto take = [&, &key = text](const json& item) {
        const auto entry = parsed(item, parse_option_address);
        if (!entry) {
          error_in(key, item, "expected an array of objects or entries such as \"2111h\" or \"2111h:01\"");
        } else if (entry->index < 0x2000) {
          error_in(key, item, "1010h:02 stores the parameters of 1000h..1FFFh");
        } else {
          options_.stored_by.emplace_back(*entry, *sub_index);
        }
      };
      if (entries.is_array()) {
        std::ranges::for_each(entries, take);
      } else {
        take(entries);
      }
    }
  }

  void autonomous_storage(const json& value) {
    append_each(value, "expected an array of sub-indices such as \"06h\"", options_.autonomous_storage,
                parse_sub_index);
  }

  /// "05h".
  static std::optional<std::uint8_t> parse_sub_index(std::string_view text) {
    if (text.size() != 3 || text.back() != 'h') return std::nullopt;
    const auto number = parse_unsigned(fmt::format("0x{}", text.substr(0, 2)));
    return number ? std::optional{static_cast<std::uint8_t>(*number)} : std::nullopt;
  }

  void flag(const json& value, bool& option) {
    if (!value.is_boolean()) return error("expected true or false");
    option = value.get<bool>();
  }
  void zero_terminated_strings(const json& value) { flag(value, options_.zero_terminated_strings); }
  void typed_values(const json& value) { flag(value, options_.typed_values); }

  /// One bit for each index of table 0 of CiA 305; none for a fixed bit rate.
  void lss_bit_rates(const json& value) {
    unsigned mask = 0;
    bool valid = value == "fixed" || (value.is_array() && !value.empty());
    for (std::size_t i = 0; valid && value.is_array() && i < value.size(); ++i) {
      const auto bit = lss_bit_rate(value[i]);
      valid = bit.has_value();
      mask |= 1U << bit.value_or(0);
    }
    if (!valid) {
      return error(
          "expected \"fixed\", or an array of bit rates of CiA 301 in kbit/s, such as [125, 500], and \"auto\"");
    }
    options_.lss->bit_rates = static_cast<std::uint16_t>(mask);
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
      error("expected true, false or \"compressed\"");
    }
  }

  /// Reports a fault in the option, in an element of its array, or in a member of its value.
  void error(std::string_view message) { file_.error(value_, path_, message); }
  void error_at(const json& item, std::string_view message) { file_.error(item, path_, message); }
  void error_in(const std::string& member, const json& value, std::string_view message) {
    file_.error(value, path_ + "." + member, message);
  }

  const std::string& path_;  ///< of the option, as in the file
  const json& value_;
  NameCheck is_name_;
  OptionFile& file_;
  Options& options_;
};

}  // namespace

void read_structured_option(const OptionRow& row, const std::string& path, const nlohmann::json& value,
                            NameCheck is_name, OptionFile& file, Options& options) {
  StructuredOptions{path, value, is_name, file, options}.read(row);
}

}  // namespace edsc
