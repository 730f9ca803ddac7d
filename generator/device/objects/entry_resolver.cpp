#include "device/objects/entry_resolver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "device/meaning/resolve_meaning.hpp"
#include "device/objects/object_type_name.hpp"
#include "device/objects/standard_objects.hpp"
#include "device/resolve_information.hpp"
#include "device/types/type_name.hpp"
#include "diagnostics/quote.hpp"
#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "values/read_value.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

using canopen::Access;
using canopen::DataClass;
using canopen::DataType;
using canopen::DataTypeRow;

/// Implied data types. The first matching row is used.
struct ImpliedType {
  std::uint16_t first, last;  ///< indices
  bool only_sub_index_0;
  DataType type;
  std::string_view what;
};

constexpr ImpliedType implied_types[] = {
    {0x0000, 0xFFFF, true, DataType::unsigned8, "sub-index 0"},
    {0x1600, 0x17FF, false, DataType::unsigned32, "a mapping entry"},
    {0x1A00, 0x1BFF, false, DataType::unsigned32, "a mapping entry"},
};

/// `: REAL32 is 0x0008` for `float`; empty if the word is not a data type.
std::string number_of_type(std::string_view name) {
  const DataTypeRow* const type = find_type_by_name(name);
  return type == nullptr ? std::string{}
                         : fmt::format(": {} is 0x{:04X}", type->name, static_cast<unsigned>(type->type));
}

/// The data type with this name in CiA 301; null for other words, which may be another type in each tool.
const DataTypeRow* standard_type_named(std::string_view name) {
  const auto* const found = std::ranges::find_if(
      canopen::data_types, [&](const DataTypeRow& row) { return equal_ignoring_case(row.name, name); });
  return found == std::end(canopen::data_types) ? nullptr : found;
}

/// Whether an entry of unknown type becomes a DOMAIN, bytes that are not interpreted. Entries of the communication
/// profile and sub-index 0 need their type and are ignored.
bool may_be_opaque(const EntryPlace& place) {
  constexpr std::uint16_t first_application_index = 0x2000;
  return place.index >= first_application_index && !(place.in_object_with_sub_indices && place.sub_index == 0);
}

struct AccessLetter {
  std::string_view letter;
  Access access;
};

/// The letters of some tools.
constexpr AccessLetter access_letters[] = {{"r", Access::ro}, {"w", Access::wo}, {"r/w", Access::rw}};

/// The description of an entry in CiA 301; null for others, and for sub-index 0 of an ARRAY or RECORD.
const StandardEntry* standard_entry(const EntryPlace& place) {
  if (place.in_object_with_sub_indices && place.sub_index == 0) return nullptr;
  return find_standard_entry(place.index, place.sub_index);
}

bool is_small_integer(const DataTypeRow& type) {
  return (type.kind == DataClass::unsigned_integer || type.kind == DataClass::signed_integer) && type.bits <= 32;
}

bool has_limits(const DataTypeRow& type) {
  return type.kind == DataClass::signed_integer || type.kind == DataClass::unsigned_integer ||
         type.kind == DataClass::real;
}

}  // namespace

std::optional<Entry> EntryResolver::resolve(const EntryDescription& description, const EntryPlace& place,
                                            std::string_view name) {
  if (place.in_object_with_sub_indices && place.sub_index != 0) check_sub_object_type(description);
  const std::optional<ValueType> found = data_type(description, place);
  if (!found) return std::nullopt;
  const bool is_opaque = found->row == nullptr;
  if (is_opaque && !may_be_opaque(place)) return std::nullopt;
  const auto needed = is_opaque ? std::nullopt : type_of_service(description, place, *found);
  const ValueType type =
      is_opaque ? types_.find(static_cast<std::uint64_t>(DataType::domain)) : needed.value_or(*found);
  std::optional<Entry> result{std::in_place};
  Entry& entry = *result;
  entry.index = place.index;
  entry.sub_index = place.sub_index;
  entry.name = name;
  entry.position = description.position;
  entry.access_position = description.access_type.present ? description.access_type.position : description.position;
  entry.mapping_position = description.pdo_mapping.present ? description.pdo_mapping.position : description.position;
  entry.type = type.row;
  if (needed) entry.stated_type = found->row;
  entry.octets = type.octets;
  entry.access = access(description, place);
  entry.pdo_mapping = pdo_mapping(description);
  entry.obj_flags = obj_flags(description);
  entry.denotation = description.denotation.text;
  entry.param_refd = description.param_refd.text;
  entry.unit = description.unit.text;
  entry.factor = description.factor.text;
  entry.offset = description.offset.text;
  entry.description = description.description.text;
  auto quantity = quantity_of_keys(description, diagnostics_);
  auto names = description.value_names.empty() ? std::nullopt : names_of_values(description, *type.row, diagnostics_);
  if (quantity || names) {
    Meaning meaning;
    meaning.quantity = std::move(quantity);
    meaning.values = std::move(names);
    entry.meaning = std::make_shared<const Meaning>(std::move(meaning));
  }
  if (!is_opaque) resolve_default(description, entry);
  if (has_limits(*entry.type)) resolve_limits(description, type, entry);
  resolve_files(description, entry);
  return result;
}

std::uint32_t EntryResolver::obj_flags(const EntryDescription& description) {
  return read_number(description.obj_flags, "object-flags", diagnostics_).value_or(0);
}

void EntryResolver::check_sub_object_type(const EntryDescription& description) {
  const std::string_view text = strip_inline_comment(description.object_type.text);
  if (text.empty()) return;
  const auto type = parse_unsigned(text);
  if (type == static_cast<std::uint64_t>(ObjectType::var) || type == static_cast<std::uint64_t>(ObjectType::domain)) {
    return;
  }
  if (const auto named = object_type_named(text); named == ObjectType::var || named == ObjectType::domain) {
    return report_object_type_name(*named, description.object_type, diagnostics_);
  }
  diagnostics_.warning("object-type", description.object_type.position,
                       "a sub-object must be a VAR or a DOMAIN; ignoring its ObjectType", {}, std::string{text});
}

std::optional<ValueType> EntryResolver::data_type(const EntryDescription& description, const EntryPlace& place) {
  const Field& field = description.data_type;
  const std::string_view text = strip_inline_comment(field.text);
  if (!field.present || text.empty()) return missing_data_type(description, place);
  const auto code = parse_unsigned(text);
  if (const DataTypeRow* const named = code ? nullptr : standard_type_named(text)) {
    diagnostics_.warning("data-type", field.position,
                         fmt::format("DataType must be a number; that of {} is 0x{:04X}", named->name,
                                     static_cast<unsigned>(named->type)),
                         {}, "name");
    diagnostics_.offer_value("data-type", field.position, fmt::format("0x{:04X}", static_cast<unsigned>(named->type)),
                             fmt::format("the number of {}", named->name));
    return types_.find(static_cast<std::uint64_t>(named->type));
  }
  if (!code) {
    diagnostics_.error("data-type", field.position,
                       fmt::format("DataType {} is not a number{}", quote(text), number_of_type(text)), {},
                       std::string{text});
    return ValueType{};
  }
  const ValueType type = types_.find(*code);
  if (type.row != nullptr) return type;
  if (const ValueType member = types_.find_member(*code, place.sub_index);
      place.in_object_with_sub_indices && member.row != nullptr) {
    diagnostics_.warning(
        "complex-data-type", field.position,
        fmt::format("DataType 0x{:04X} is the data type of a RECORD, not of a value; its sub-index {} is {}", *code,
                    place.sub_index, member.row->name),
        {}, "read");
    return member;
  }
  if (types_.is_complex(*code)) {
    diagnostics_.warning(
        "complex-data-type", field.position,
        fmt::format("DataType 0x{:04X} is the data type of a RECORD, not of a value; the entry is ignored", *code), {},
        "skipped");
    return std::nullopt;
  }
  diagnostics_.error(
      "data-type", field.position,
      fmt::format("DataType 0x{:04X} is not a basic data type of CiA 301, nor a DEFTYPE of this file", *code), {},
      fmt::format("{}", *code));
  return ValueType{};
}

std::optional<ValueType> EntryResolver::missing_data_type(const EntryDescription& description,
                                                          const EntryPlace& place) {
  const auto object_type = number_of(description.object_type);
  if (object_type == static_cast<std::uint64_t>(ObjectType::domain)) {
    diagnostics_.warning("data-type", description.position, "missing DataType; assuming DOMAIN from ObjectType", {},
                         "DOMAIN");
    return types_.find(static_cast<std::uint64_t>(DataType::domain));
  }
  if (place.record_type) {
    if (const ValueType member = types_.find_member(*place.record_type, place.sub_index); member.row != nullptr) {
      return member;
    }
  }
  for (const ImpliedType& row : implied_types) {
    const bool fits = place.in_object_with_sub_indices && place.index >= row.first && place.index <= row.last &&
                      (place.sub_index == 0 || !row.only_sub_index_0);
    if (!fits) continue;
    const ValueType type = types_.find(static_cast<std::uint64_t>(row.type));
    diagnostics_.warning("data-type", description.position,
                         fmt::format("missing DataType of {}; assuming {}", row.what, type.row->name), {},
                         std::string{row.what});
    diagnostics_.offer_key("data-type", description.position, "DataType",
                           fmt::format("0x{:04X}", static_cast<unsigned>(row.type)),
                           fmt::format("data type of {}", row.what));
    return type;
  }
  diagnostics_.error("data-type", description.position, "missing DataType", {}, "missing");
  return ValueType{};
}

std::optional<ValueType> EntryResolver::type_of_service(const EntryDescription& description, const EntryPlace& place,
                                                        const ValueType& found) {
  const StandardObject* const object = find_standard_object(place.index);
  const bool has_its_form = object != nullptr && place.in_object_with_sub_indices == (object->type != ObjectType::var);
  const StandardEntry* const entry = has_its_form ? standard_entry(place) : nullptr;
  if (entry == nullptr || found.row->type == entry->type) return std::nullopt;
  if (entry->may_differ &&
      (is_small_integer(*found.row) || !is_small_integer(*types_.find(static_cast<std::uint64_t>(entry->type)).row)))
    return std::nullopt;
  const ValueType needed = types_.find(static_cast<std::uint64_t>(entry->type));
  diagnostics_.error(
      "standard-data-type", description.data_type.position,
      fmt::format("{} is {}; the service of the device needs the {} of CiA 301 (clause {})",
                  entry_label(place.index, place.sub_index), found.row->name, needed.row->name, object->clause),
      {}, fmt::format("{} {}", object->first, found.row->name));
  diagnostics_.offer_value("standard-data-type", description.data_type.position,
                           fmt::format("0x{:04X}", static_cast<unsigned>(entry->type)),
                           fmt::format("{} (CiA 301, {})", needed.row->name, object->clause));
  return needed;
}

/// CiA 306-1, 4.6.2. A writable entry that is read-only in the device misleads more than the opposite.
Access EntryResolver::access(const EntryDescription& description, const EntryPlace& place) {
  const Field& field = description.access_type;
  const std::string_view text = strip_inline_comment(field.text);
  for (const canopen::AccessRow& row : canopen::access_rows) {
    if (equal_ignoring_case(text, row.name)) return row.access;
  }
  const StandardEntry* const standard = standard_entry(place);
  if (!field.present || text.empty()) {
    const Access assumed = standard != nullptr ? standard->access.assumed() : Access::rw;
    const std::string_view name = canopen::row_of(assumed).name;
    diagnostics_.warning("access-type", description.position, fmt::format("missing AccessType; assuming {}", name), {},
                         fmt::format("missing {}", name));
    if (standard != nullptr) {
      diagnostics_.offer_key("access-type", description.position, "AccessType", std::string{name},
                             fmt::format("access of {} in CiA 301", entry_label(place.index, place.sub_index)));
    }
    return assumed;
  }
  if (const auto* const letter = std::ranges::find_if(
          access_letters, [&](const AccessLetter& row) { return equal_ignoring_case(text, row.letter); });
      letter != std::end(access_letters)) {
    diagnostics_.warning(
        "access-type", field.position,
        fmt::format("reading the AccessType {} as {}", quote(text), canopen::row_of(letter->access).name), {},
        "letter");
    diagnostics_.offer_value("access-type", field.position, std::string{canopen::row_of(letter->access).name},
                             fmt::format("{} means {}", quote(text), canopen::row_of(letter->access).name));
    return letter->access;
  }
  const Access assumed = standard != nullptr ? standard->access.assumed() : Access::ro;
  diagnostics_.error("access-type", field.position,
                     fmt::format("AccessType {} is not ro, wo, rw, rwr, rww or const; assuming {}", quote(text),
                                 canopen::row_of(assumed).name),
                     {}, fmt::format("{} {}", text, canopen::row_of(assumed).name));
  if (standard != nullptr) {
    diagnostics_.offer_value("access-type", field.position, std::string{canopen::row_of(assumed).name},
                             fmt::format("access of {} in CiA 301", entry_label(place.index, place.sub_index)));
  }
  return assumed;
}

bool EntryResolver::pdo_mapping(const EntryDescription& description) {
  const Field& field = description.pdo_mapping;
  const std::string_view text = strip_inline_comment(field.text);
  if (!field.present || text.empty()) return false;
  const auto number = parse_unsigned(text);
  if (number && *number <= 1) return *number == 1;
  diagnostics_.warning("pdo-mapping", field.position,
                       fmt::format("PDOMapping must be 0 or 1, not {}; using {}", quote(text), number ? 1 : 0), {},
                       std::string{text});
  return number.has_value();
}

/// CiA 306-1, 5: the ParameterValue of a DCF is the configured value. In an EDS it has no meaning, even without a
/// DefaultValue.
void EntryResolver::resolve_default(const EntryDescription& description, Entry& entry) {
  const Field& configured = description.parameter_value;
  const bool is_configured = configured.present && !configured.empty();
  if (is_configured && !is_dcf_) {
    diagnostics_.warning("parameter-value", configured.position,
                         "ParameterValue belongs in a DCF; an EDS uses DefaultValue", {}, "EDS");
  }
  entry.default_value = parse_value(is_configured && is_dcf_ ? configured : description.default_value, *entry.type,
                                    node_id_, diagnostics_);
  const std::size_t length = entry.default_value ? entry.default_value->bytes.size() : 0;
  if (entry.octets == 0 || length <= entry.octets) return;
  diagnostics_.error("number-range", entry.default_value->position,
                     fmt::format("the value has {} bytes, but its data type has {}", length, entry.octets));
  entry.default_value.reset();
}

void EntryResolver::resolve_limits(const EntryDescription& description, const ValueType& type, Entry& entry) {
  entry.low_limit = parse_limit(description.low_limit, Limit::low, *entry.type, node_id_, diagnostics_);
  entry.high_limit = parse_limit(description.high_limit, Limit::high, *entry.type, node_id_, diagnostics_);
  if (!entry.low_limit && type.low_limit != nullptr) entry.low_limit = *type.low_limit;
  if (!entry.high_limit && type.high_limit != nullptr) entry.high_limit = *type.high_limit;
  drop_limit_formula(entry.low_limit);
  drop_limit_formula(entry.high_limit);
  if (!entry.low_limit || !entry.high_limit) return;
  if (!is_less(*entry.type, entry.high_limit->bits, entry.low_limit->bits)) return;
  diagnostics_.warning(
      "limits-order", entry.low_limit->position,
      fmt::format("LowLimit {} is above HighLimit {}; neither is checked", written_value(entry.low_limit, *entry.type),
                  written_value(entry.high_limit, *entry.type)));
  entry.low_limit.reset();
  entry.high_limit.reset();
}

/// A node-ID-dependent limit is not a constant: it cannot be checked before the node-ID is known.
void EntryResolver::drop_limit_formula(std::optional<Value>& limit) {
  if (!limit || !limit->plus_node_id) return;
  diagnostics_.warning("limit-formula", limit->position,
                       "node-ID-dependent limit; it is not checked unless the node-ID is given");
  limit.reset();
}

void EntryResolver::resolve_files(const EntryDescription& description, Entry& entry) {
  entry.upload_file = description.upload_file.text;
  entry.download_file = description.download_file.text;
  if (entry.type->kind == DataClass::domain) return;
  for (const Field* field : {&description.upload_file, &description.download_file}) {
    if (field->present && !field->empty()) {
      diagnostics_.warning("domain-value", field->position, "only a DOMAIN can have its value in a file", {}, "file");
    }
  }
}

}  // namespace edsc
