#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <utility>

#include "device/meaning/description.hpp"
#include "eds/number.hpp"
#include "text/ascii.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

using nlohmann::json;

/// A number of a key or text: decimal or hexadecimal, also negative. UNSIGNED64 values above the range are their bits.
std::optional<std::int64_t> parse_signed(std::string_view text) {
  text = trim(text);
  const bool is_negative = text.starts_with('-');
  if (is_negative) text.remove_prefix(1);
  const auto number = parse_decimal(text);
  if (!number || (is_negative && *number > std::uint64_t{1} << 63)) return std::nullopt;
  return static_cast<std::int64_t>(is_negative ? 0 - *number : *number);
}

/// `4` and `4..7`: the first and the last bit.
std::optional<std::pair<std::uint8_t, std::uint8_t>> parse_bits(std::string_view text) {
  const std::size_t dots = text.find("..");
  const auto first = parse_decimal(text.substr(0, dots));
  const auto last = dots == std::string_view::npos ? first : parse_decimal(text.substr(dots + 2));
  if (!first || !last || *first > *last || *last > 63) return std::nullopt;
  return std::pair{static_cast<std::uint8_t>(*first), static_cast<std::uint8_t>(*last)};
}

/// `2003h:01`, `2003h` and, in a profile, `1400h..15FFh:01`.
std::optional<MeaningDescription> parse_address(std::string_view text) {
  const std::size_t dots = text.find("..");
  const auto last = parse_option_address(dots == std::string_view::npos ? text : text.substr(dots + 2));
  const auto first =
      dots == std::string_view::npos && last ? std::optional{last->index} : parse_index(text.substr(0, dots));
  if (!first || !last || *first > last->index) return std::nullopt;
  MeaningDescription description;
  description.first_index = *first;
  description.last_index = last->index;
  description.sub_index = last->sub_index;
  description.address = text;
  return description;
}

class MeaningReader {
 public:
  MeaningReader(std::string_view path, MeaningSource source, OptionFile& file)
      : path_{path}, source_{source}, file_{file} {}

  MeaningDescriptions read(const json& value) {
    MeaningDescriptions result;
    if (!value.is_object()) {
      error(value, path_, "expected an object with one member per object, such as \"6041h\"");
      return result;
    }
    for (const auto& [name, member] : file_.json().members(value)) {
      const std::string path = in(path_, name);
      if (name == "emcy") {
        result.error_codes = error_codes(*member, path);
        continue;
      }
      auto description = parse_address(name);
      if (!description || (source_ == MeaningSource::options && description->first_index != description->last_index)) {
        error(*member, path, "not an object or entry such as \"6041h\" or \"2003h:01\", nor \"emcy\"");
        continue;
      }
      mark(*description, *member);
      read_members(*member, path, entry_members(), *description);
      result.entries.push_back(std::move(*description));
    }
    return result;
  }

  std::vector<ErrorCodeName> read_error_codes(const json& value) { return error_codes(value, path_); }

 private:
  /// A member of the objects that describe a `Described`.
  template <class Described>
  struct Member {
    std::string_view name;
    void (MeaningReader::*read)(const json& value, const std::string& path, Described& described);
  };

  static std::span<const Member<MeaningDescription>> entry_members();
  static std::span<const Member<BitField>> field_members();
  static std::span<const Member<NamedValue>> value_members();
  static std::span<const Member<MaskedValue>> masked_members();
  static std::span<const Member<FieldCase>> case_members();
  static std::span<const Member<ErrorCodeName>> error_code_members();

  static std::string in(std::string_view path, std::string_view name) { return fmt::format("{}.{}", path, name); }

  void error(const json& value, std::string_view path, std::string_view message) { file_.error(value, path, message); }

  void mark(MeaningText& text, const json& value) const {
    text.position = file_.json().name_position(value);
    text.source = source_;
  }

  /// Reads each member of an object by its row.
  template <class Described>
  void read_members(const json& value, const std::string& path, std::span<const Member<Described>> members,
                    Described& described) {
    if (!value.is_object()) return error(value, path, "expected an object");
    for (const auto& [name, member] : file_.json().members(value)) {
      const auto row = std::ranges::find(members, name, &Member<Described>::name);
      if (row != members.end()) {
        (this->*row->read)(*member, in(path, name), described);
        continue;
      }
      std::vector<std::string_view> names;
      for (const Member<Described>& one : members) names.push_back(one.name);
      error(*member, in(path, name), fmt::format("unknown member{}", did_you_mean(name, names)));
    }
  }

  /// The text of a member; empty, and reported, if it is not a text.
  std::string text_of(const json& value, const std::string& path) {
    if (value.is_string()) return value.get<std::string>();
    error(value, path, "expected a text");
    return "";
  }

  std::string name_of(const json& value, const std::string& path) {
    const std::string name = text_of(value, path);
    if (is_meaning_name(name)) return name;
    if (value.is_string())
      error(value, path, fmt::format("\"{}\" is not a name in snake_case, such as \"over_temperature\"", name));
    return "";
  }

  std::optional<Rational> number_of(const json& value, const std::string& path) {
    const bool is_text = value.is_string();
    const auto number =
        is_text || value.is_number() ? parse_rational(is_text ? value.get<std::string>() : value.dump()) : std::nullopt;
    if (!number) error(value, path, "expected a number such as 0.1 or \"1/10\"");
    return number;
  }

  std::optional<std::uint64_t> unsigned_of(const json& value, const std::string& path) {
    if (value.is_number_unsigned()) return value.get<std::uint64_t>();
    const auto number = value.is_string() ? parse_decimal(value.get<std::string>()) : std::nullopt;
    if (!number) error(value, path, "expected a number such as \"0x6F\"");
    return number;
  }

  bool flag_of(const json& value, const std::string& path) {
    if (value.is_boolean()) return value.get<bool>();
    error(value, path, "expected true or false");
    return false;
  }

  std::optional<EntryKey> entry_of(const json& value, const std::string& path) {
    const auto entry = value.is_string() ? parse_option_entry(value.get<std::string>()) : std::nullopt;
    if (!entry) error(value, path, "expected an entry such as \"6061h\" or \"2005h:01\"");
    return entry;
  }

  template <class Described>
  void text(const json& value, const std::string& path, Described& described) {
    described.text = text_of(value, path);
  }
  template <class Described>
  void place(const json& value, const std::string& path, Described& described) {
    described.place = text_of(value, path);
  }
  template <class Described>
  void name(const json& value, const std::string& path, Described& described) {
    described.name = name_of(value, path);
  }

  void entry_unit(const json& value, const std::string& path, MeaningDescription& entry) {
    entry.unit = {text_of(value, path), file_.json().name_position(value)};
  }
  void entry_scale(const json& value, const std::string& path, MeaningDescription& entry) {
    if (const auto number = number_of(value, path)) entry.scale = {*number, file_.json().name_position(value)};
  }
  void entry_offset(const json& value, const std::string& path, MeaningDescription& entry) {
    if (const auto number = number_of(value, path)) entry.offset = {*number, file_.json().name_position(value)};
  }
  template <class Described>
  void values(const json& value, const std::string& path, Described& described) {
    enumeration(value, described.values).values = named_values(value, path);
  }
  template <class Described>
  void closed(const json& value, const std::string& path, Described& described) {
    enumeration(value, described.values).closed = flag_of(value, path);
  }
  template <class Described>
  void fields(const json& value, const std::string& path, Described& described) {
    described.fields = bit_fields(value, path);
  }
  void masked(const json& value, const std::string& path, MeaningDescription& entry) {
    for_members(value, path, "expected an object: {\"state\": {\"fault\": [\"0x4F\", \"0x08\"]}}",
                [&](const std::string& name, const json& member) {
                  if (!is_meaning_name(name)) return error(member, in(path, name), "not a name in snake_case");
                  entry.masked.push_back({name, masked_values(member, in(path, name))});
                });
  }
  void depends_on(const json& value, const std::string& path, MeaningDescription& entry) {
    entry.depends_on = entry_of(value, path);
  }
  void same_as(const json& value, const std::string& path, MeaningDescription& entry) {
    entry.same_as = entry_of(value, path);
  }
  void cases(const json& value, const std::string& path, MeaningDescription& entry) {
    for_members(value, path, "expected an object with one member per value, such as \"1\" or \"8, 9, 10\"",
                [&](const std::string& numbers, const json& member) {
                  FieldCase one;
                  mark(one, member);
                  one.values = case_values(numbers);
                  if (one.values.empty())
                    return error(member, in(path, numbers), "not one or more numbers such as \"1\" or \"8, 9, 10\"");
                  read_members(member, in(path, numbers), case_members(), one);
                  entry.cases.push_back(std::move(one));
                });
  }

  void is_signed(const json& value, const std::string& path, BitField& field) {
    field.is_signed = flag_of(value, path);
  }
  void field_unit(const json& value, const std::string& path, BitField& field) {
    Quantity& of_field = quantity(value, field);
    of_field.symbol = text_of(value, path);
    of_field.unit = canopen::find_unit(of_field.symbol);
  }
  void field_scale(const json& value, const std::string& path, BitField& field) {
    if (const auto number = number_of(value, path)) quantity(value, field).scale = *number;
  }
  void field_offset(const json& value, const std::string& path, BitField& field) {
    if (const auto number = number_of(value, path)) quantity(value, field).offset = *number;
  }

  void mask(const json& value, const std::string& path, MaskedValue& one) {
    one.mask = unsigned_of(value, path).value_or(0);
  }
  void masked_value(const json& value, const std::string& path, MaskedValue& one) {
    one.value = unsigned_of(value, path).value_or(0);
  }

  Quantity& quantity(const json& value, BitField& field) const {
    if (!field.quantity) mark(field.quantity.emplace(), value);
    return *field.quantity;
  }
  Enumeration& enumeration(const json& value, std::optional<Enumeration>& values) const {
    if (!values) mark(values.emplace(), value);
    return *values;
  }

  /// Calls `take` for each member of an object.
  template <class Take>
  void for_members(const json& value, const std::string& path, std::string_view expected, Take take) {
    if (!value.is_object()) return error(value, path, expected);
    for (const auto& [name, member] : file_.json().members(value)) take(name, *member);
  }

  /// The numbers of `8, 9, 10`, ascending; none if one is invalid.
  static std::vector<std::int64_t> case_values(std::string_view text) {
    std::vector<std::int64_t> numbers;
    while (true) {
      const std::size_t comma = text.find(',');
      const auto number = parse_signed(text.substr(0, comma));
      if (!number) return {};
      numbers.push_back(*number);
      if (comma == std::string_view::npos) break;
      text.remove_prefix(comma + 1);
    }
    std::ranges::sort(numbers);
    return numbers;
  }

  std::vector<NamedValue> named_values(const json& value, const std::string& path) {
    std::vector<NamedValue> values;
    for_members(value, path, "expected an object with one member per value: {\"0\": \"off\", \"1\": \"heating\"}",
                [&](const std::string& number, const json& member) {
                  NamedValue one;
                  mark(one, member);
                  const auto parsed = parse_signed(number);
                  if (!parsed) return error(member, in(path, number), "not a number");
                  one.value = *parsed;
                  read_named(member, in(path, number), value_members(), one);
                  if (!one.name.empty()) values.push_back(std::move(one));
                });
    sort_unique(values, &NamedValue::value, path, value);
    report_double_names(values, path);
    return values;
  }

  std::vector<BitField> bit_fields(const json& value, const std::string& path) {
    std::vector<BitField> fields;
    for_members(
        value, path,
        "expected an object with one member per bit or range of bits: {\"0\": \"door_open\", \"4..7\": \"zone\"}",
        [&](const std::string& bits, const json& member) {
          BitField field;
          mark(field, member);
          const auto parsed = parse_bits(bits);
          if (!parsed) return error(member, in(path, bits), "not a bit or range of bits such as \"3\" or \"4..7\"");
          field.first_bit = parsed->first;
          field.bits = static_cast<std::uint8_t>(parsed->second - parsed->first + 1);
          if (!member.is_null()) {
            read_named(member, in(path, bits), field_members(), field);
            if (field.name.empty()) return;
          }
          fields.push_back(std::move(field));
        });
    std::ranges::stable_sort(fields, {}, &BitField::first_bit);
    report_double_names(fields, path);
    return fields;
  }

  std::vector<MaskedValue> masked_values(const json& value, const std::string& path) {
    std::vector<MaskedValue> values;
    for_members(value, path, "expected an object with one member per name: {\"fault\": [\"0x4F\", \"0x08\"]}",
                [&](const std::string& name, const json& member) {
                  MaskedValue one;
                  mark(one, member);
                  one.name = name;
                  if (!is_meaning_name(name)) return error(member, in(path, name), "not a name in snake_case");
                  if (member.is_array() && member.size() == 2) {
                    mask(member[0], in(path, name), one);
                    masked_value(member[1], in(path, name), one);
                  } else {
                    read_members(member, in(path, name), masked_members(), one);
                  }
                  if ((one.value & ~one.mask) != 0)
                    error(member, in(path, name), "the value has bits that are not in the mask");
                  values.push_back(std::move(one));
                });
    return values;
  }

  std::vector<ErrorCodeName> error_codes(const json& value, const std::string& path) {
    std::vector<ErrorCodeName> codes;
    for_members(value, path,
                "expected an object with one member per error code: {\"2310h\": \"continuous over current\"}",
                [&](const std::string& code, const json& member) {
                  ErrorCodeName one;
                  mark(one, member);
                  const auto parsed = parse_index(code);
                  if (!parsed) return error(member, in(path, code), "not an error code such as \"2310h\"");
                  one.code = *parsed;
                  if (member.is_string()) {
                    one.text = member.get<std::string>();
                  } else {
                    read_members(member, in(path, code), error_code_members(), one);
                  }
                  if (one.text.empty()) return error(member, in(path, code), "expected a text");
                  codes.push_back(std::move(one));
                });
    sort_unique(codes, &ErrorCodeName::code, path, value);
    return codes;
  }

  /// A text is the name, an object has it as a member.
  template <class Described>
  void read_named(const json& value, const std::string& path, std::span<const Member<Described>> members,
                  Described& described) {
    if (value.is_string()) {
      described.name = name_of(value, path);
    } else {
      read_members(value, path, members, described);
      if (described.name.empty() && value.is_object() && !value.contains("name")) error(value, path, "missing name");
    }
  }

  /// Reports numbers that occur in two spellings; the first is used.
  template <class Row, class Number>
  void sort_unique(std::vector<Row>& rows, Number number, const std::string& path, const json& value) {
    std::ranges::stable_sort(rows, {}, number);
    const auto same = std::ranges::adjacent_find(rows, {}, number);
    if (same == rows.end()) return;
    error(value, path,
          fmt::format("{} occurs twice, in different spellings", static_cast<std::int64_t>((*same).*number)));
    const auto is_same = [&](const Row& a, const Row& b) { return a.*number == b.*number; };
    rows.erase(std::unique(rows.begin(), rows.end(), is_same), rows.end());
  }

  template <class Row>
  void report_double_names(const std::vector<Row>& rows, const std::string& path) {
    std::set<std::string_view> names;
    for (const Row& row : rows) {
      if (row.name.empty() || names.insert(row.name).second) continue;
      file_.error_at(row.position, path, fmt::format("\"{}\" is the name of another one, too", row.name));
    }
  }

  std::string path_;
  MeaningSource source_;
  OptionFile& file_;
};

std::span<const MeaningReader::Member<MeaningDescription>> MeaningReader::entry_members() {
  static constexpr Member<MeaningDescription> members[] = {
      {"place", &MeaningReader::place},         {"text", &MeaningReader::text},
      {"unit", &MeaningReader::entry_unit},     {"scale", &MeaningReader::entry_scale},
      {"offset", &MeaningReader::entry_offset}, {"values", &MeaningReader::values},
      {"closed", &MeaningReader::closed},       {"bits", &MeaningReader::fields},
      {"masked", &MeaningReader::masked},       {"depends_on", &MeaningReader::depends_on},
      {"cases", &MeaningReader::cases},         {"same_as", &MeaningReader::same_as},
  };
  return members;
}

std::span<const MeaningReader::Member<BitField>> MeaningReader::field_members() {
  static constexpr Member<BitField> members[] = {
      {"name", &MeaningReader::name},         {"place", &MeaningReader::place},
      {"text", &MeaningReader::text},         {"values", &MeaningReader::values},
      {"closed", &MeaningReader::closed},     {"unit", &MeaningReader::field_unit},
      {"scale", &MeaningReader::field_scale}, {"offset", &MeaningReader::field_offset},
      {"signed", &MeaningReader::is_signed},
  };
  return members;
}

std::span<const MeaningReader::Member<NamedValue>> MeaningReader::value_members() {
  static constexpr Member<NamedValue> members[] = {
      {"name", &MeaningReader::name},
      {"place", &MeaningReader::place},
      {"text", &MeaningReader::text},
  };
  return members;
}

std::span<const MeaningReader::Member<MaskedValue>> MeaningReader::masked_members() {
  static constexpr Member<MaskedValue> members[] = {
      {"mask", &MeaningReader::mask},
      {"value", &MeaningReader::masked_value},
      {"place", &MeaningReader::place},
      {"text", &MeaningReader::text},
  };
  return members;
}

std::span<const MeaningReader::Member<FieldCase>> MeaningReader::case_members() {
  static constexpr Member<FieldCase> members[] = {
      {"name", &MeaningReader::name},
      {"place", &MeaningReader::place},
      {"text", &MeaningReader::text},
      {"bits", &MeaningReader::fields},
  };
  return members;
}

std::span<const MeaningReader::Member<ErrorCodeName>> MeaningReader::error_code_members() {
  static constexpr Member<ErrorCodeName> members[] = {
      {"place", &MeaningReader::place},
      {"text", &MeaningReader::text},
  };
  return members;
}

}  // namespace

bool MeaningDescription::applies_to(std::uint16_t index, std::uint8_t sub_index_of_entry) const {
  if (index < first_index || index > last_index) return false;
  return !sub_index || *sub_index == sub_index_of_entry;
}

bool is_meaning_name(std::string_view name) {
  return !name.empty() && is_lower(name.front()) &&
         std::ranges::all_of(name, [](char one) { return is_lower(one) || is_digit(one) || one == '_'; });
}

std::vector<ErrorCodeName> read_error_codes(const json& value, std::string_view path, MeaningSource source,
                                            OptionFile& file) {
  return MeaningReader{path, source, file}.read_error_codes(value);
}

MeaningDescriptions read_meaning(const json& value, std::string_view path, MeaningSource source, OptionFile& file) {
  return MeaningReader{path, source, file}.read(value);
}

}  // namespace edsc
