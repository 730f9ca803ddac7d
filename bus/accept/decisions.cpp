#include "accept/decisions.hpp"

#include <fmt/args.h>
#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <utility>

#include "conform/cases/shared/entry_values.hpp"
#include "device/cob_id_parameter.hpp"
#include "device/index_range.hpp"
#include "device/meaning/profiles.hpp"
#include "device/objects/standard_objects.hpp"
#include "device/reserved_values.hpp"
#include "eds/number.hpp"
#include "lint/profile_objects.hpp"
#include "pdo/mapping.hpp"
#include "values/little_endian.hpp"
#include "values/value_bytes.hpp"

namespace edsc::accept {
namespace {

using canopen::AbortCode;
using canopen::Access;
using canopen::DataClass;
using canopen::DataType;
using canopen::DataTypeRow;
using Corrections = std::vector<Correction>;

constexpr std::uint16_t device_type = 0x1000;
constexpr std::uint16_t identity = 0x1018;
constexpr std::string_view structure_clause = "CiA 301, 7.4.4";

std::string clause_of(const StandardObject& standard) { return fmt::format("CiA 301, {}", standard.clause); }

const Reading* find(const Facts& facts, std::uint16_t index, std::uint8_t sub_index) {
  const auto found = facts.readings.find({index, sub_index});
  return found == facts.readings.end() ? nullptr : &found->second;
}

/// The number that the device has sent; nothing if it has not.
std::optional<std::uint64_t> number_read(const Facts& facts, std::uint16_t index, std::uint8_t sub_index) {
  const Reading* const reading = find(facts, index, sub_index);
  if (reading == nullptr || !reading->outcome.done() || !reading->was_read) return std::nullopt;
  return number_of(reading->outcome.bytes);
}

std::uint64_t device_number(const Facts& facts) { return number_of(facts.reading.outcome.bytes); }
std::size_t device_bytes(const Facts& facts) { return facts.reading.outcome.bytes.size(); }
std::size_t eds_bytes(const Facts& facts) { return bytes_for(facts.reading.entry.type->bits); }

// ---- the text of the EDS ----

const EntryDescription* description_of(const DataSheet& data, const Object& object, std::uint8_t sub_index) {
  const ObjectDescription* const description = data.find(object.index);
  if (description == nullptr) return nullptr;
  if (!object.has_sub_indices()) return description;
  return description->find(sub_index);
}

std::string section_of(const Facts& facts) {
  const bool is_var = facts.object != nullptr && !facts.object->has_sub_indices();
  return is_var || facts.kind == Kind::object_missing ? fmt::format("{:04X}", facts.index())
                                                      : fmt::format("{:04X}sub{:X}", facts.index(), facts.sub_index());
}

/// A key of the entry with the text that it has in the EDS.
Correction key_of(const Facts& facts, std::string key, Field EntryDescription::*member, std::string new_text) {
  Correction correction{section_of(facts), std::move(key), std::nullopt, std::move(new_text)};
  const EntryDescription* const description =
      facts.object == nullptr ? nullptr : description_of(facts.data, *facts.object, facts.sub_index());
  if (description != nullptr && (description->*member).present) {
    correction.old_text = std::string{strip_inline_comment((description->*member).text)};
  }
  return correction;
}

bool is_hexadecimal_in_eds(const Entry& entry) {
  return entry.default_value ? entry.default_value->hexadecimal : entry.type->kind == DataClass::unsigned_integer;
}

/// A number of the device in the notation of an EDS.
std::string number_text(const Entry& entry, std::uint64_t number) {
  const DataTypeRow& type = *entry.type;
  if (type.kind == DataClass::real) return real_text(number, type);
  if (type.kind == DataClass::signed_integer) return fmt::format("{}", sign_extended(number, type.bits));
  if (is_hexadecimal_in_eds(entry)) return fmt::format("0x{:0{}X}", number, 2 * bytes_for(type.bits));
  return fmt::format("{}", number);
}

Correction value_key(const Facts& facts, std::string text) {
  const EntryDescription* const description = description_of(facts.data, *facts.object, facts.sub_index());
  const bool of_dcf = description != nullptr && description->parameter_value.present;
  return of_dcf ? key_of(facts, "ParameterValue", &EntryDescription::parameter_value, std::move(text))
                : key_of(facts, "DefaultValue", &EntryDescription::default_value, std::move(text));
}

Corrections remove_section(const Facts& facts) { return {{section_of(facts), "Remove", std::nullopt, "1"}}; }

Corrections set_limit(const Facts& facts) {
  const Entry& entry = *facts.reading.entry.entry;
  const std::string value = number_text(entry, device_number(facts));
  const bool above = conform::check_limits(facts.node, entry, facts.reading.outcome.bytes).too_high;
  return {above ? key_of(facts, "HighLimit", &EntryDescription::high_limit, value)
                : key_of(facts, "LowLimit", &EntryDescription::low_limit, value)};
}

Corrections set_value(const Facts& facts) {
  const Entry& entry = *facts.reading.entry.entry;
  if (entry.type->bits != 0) {
    Corrections corrections = {value_key(facts, number_text(entry, device_number(facts)))};
    const conform::LimitCheck check = conform::check_limits(facts.node, entry, facts.reading.outcome.bytes);
    if (check.too_low || check.too_high) corrections.push_back(set_limit(facts).front());
    return corrections;
  }
  if (entry.type->type != DataType::visible_string) return {};
  const auto& bytes = facts.reading.outcome.bytes;
  std::string text{bytes.begin(), bytes.end()};
  while (text.ends_with('\0')) text.pop_back();
  return {value_key(facts, std::move(text))};
}

std::string type_code(const DataTypeRow& type) { return fmt::format("0x{:04X}", static_cast<unsigned>(type.type)); }

Corrections set_type_to(const Facts& facts, const DataTypeRow& type) {
  return {key_of(facts, "DataType", &EntryDescription::data_type, type_code(type))};
}

// ---- what CiA 301 and the profiles require ----

const StandardObject* standard_object(const Facts& facts) {
  const StandardObject* const standard = find_standard_object(facts.index());
  if (standard == nullptr || facts.object == nullptr) return standard;
  return facts.object->has_sub_indices() == (standard->type != ObjectType::var) ? standard : nullptr;
}

const StandardEntry* standard_entry(const Facts& facts) {
  const StandardObject* const standard = standard_object(facts);
  return standard == nullptr ? nullptr : find_standard_entry(*standard, facts.sub_index());
}

struct RequiredType {
  const DataTypeRow* type;
  std::string clause;

  [[nodiscard]] bool fits(std::size_t bytes) const { return type->bits == 0 || bytes_for(type->bits) == bytes; }
};

const DataTypeRow* row_of(DataType type) { return canopen::find_data_type(static_cast<std::uint32_t>(type)); }

/// The device profile that the device states, if the EDS states the same.
std::optional<std::uint16_t> profile_of(const Facts& facts) {
  const auto stated = number_read(facts, device_type, 0);
  const Entry* const entry = facts.sheet.find(device_type, 0);
  if (!stated || entry == nullptr || !entry->default_value) return std::nullopt;
  const auto profile = static_cast<std::uint16_t>(*stated);
  return profile == static_cast<std::uint16_t>(entry->default_value->bits) ? std::optional{profile} : std::nullopt;
}

/// The profile that the device states, and what it says about the value of this entry.
struct ProfileRow {
  const MeaningProfile* profile = nullptr;
  const ProfileObject* object = nullptr;
};

/// Nothing for sub-index 0 and FFh of an object with sub-indices, and where the elements of an object differ.
std::optional<ProfileRow> profile_row(const Facts& facts) {
  const auto number = profile_of(facts);
  const MeaningProfile* const profile = number ? find_profile(*number) : nullptr;
  const ProfileObject* const row = profile != nullptr ? profile->find(profile->place_of(facts.index()).index) : nullptr;
  if (row == nullptr || row->type == nullptr) return std::nullopt;
  const bool has_sub_indices = facts.object != nullptr && facts.object->has_sub_indices();
  if (row->has_sub_indices() != has_sub_indices) return std::nullopt;
  if (has_sub_indices && (facts.sub_index() == 0 || facts.sub_index() == 0xFF)) return std::nullopt;
  return ProfileRow{profile, row};
}

std::optional<RequiredType> required_type(const Facts& facts) {
  const bool has_sub_indices = facts.object != nullptr && facts.object->has_sub_indices();
  if (has_sub_indices && facts.sub_index() == 0)
    return RequiredType{row_of(DataType::unsigned8), std::string{structure_clause}};
  if (has_sub_indices && facts.sub_index() == 0xFF)
    return RequiredType{row_of(DataType::unsigned32), std::string{structure_clause}};
  if (const StandardEntry* const entry = standard_entry(facts)) {
    return RequiredType{row_of(entry->type), clause_of(*standard_object(facts))};
  }
  const auto row = profile_row(facts);
  if (!row) return std::nullopt;
  return RequiredType{row->object->type, fmt::format("CiA {}", row->profile->number)};
}

// ---- evidence ----

bool always(const Facts&) { return true; }

bool is_mandatory(const Facts& facts) {
  return std::ranges::find(required_objects, facts.index()) != std::end(required_objects);
}

bool is_of_profile(const Facts& facts) {
  const auto profile = profile_of(facts);
  return std::ranges::any_of(profile_needs, [&](const ProfileNeed& need) {
    return need.profile == profile && need.one_of[0] == facts.index() && need.one_of[1] == 0;
  });
}

/// The object that the device has and that requires this one; nothing: none.
std::optional<std::uint16_t> requiring_object(const Facts& facts) {
  const std::uint16_t index = facts.index();
  constexpr std::array pdo_parameters = {IndexRange{0x1400, 0x1BFF}};
  const auto other_parameter = static_cast<std::uint16_t>(index ^ 0x0200U);
  if (contains(pdo_parameters, index) && facts.device_has(other_parameter)) return other_parameter;
  for (const ObjectNeed& need : object_needs) {
    if (need.needed == index && facts.device_has(need.index)) return need.index;
  }
  return std::nullopt;
}

bool is_required_by_other(const Facts& facts) { return requiring_object(facts).has_value(); }

/// NrOfRXPDO or NrOfTXPDO is the number of PDOs of the device, and the EDS describes more.
bool exceeds_pdo_count(const Facts& facts) {
  constexpr std::array of_rpdos = {IndexRange{0x1400, 0x17FF}}, of_tpdos = {IndexRange{0x1800, 0x1BFF}};
  const bool receives = contains(of_rpdos, facts.index());
  if (!receives && !contains(of_tpdos, facts.index())) return false;
  const Capabilities& stated = facts.sheet.information.capabilities;
  const auto count = receives ? stated.nr_of_rx_pdo : stated.nr_of_tx_pdo;
  std::uint32_t described = 0, in_device = 0;
  for (const Pdo& pdo : facts.sheet.pdos) {
    if ((pdo.direction == PdoDirection::receive) != receives || pdo.communication == nullptr) continue;
    ++described;
    if (facts.device_has(pdo.communication->index)) ++in_device;
  }
  return count && *count < described && *count == in_device;
}

bool is_not_listed(const Facts& facts) {
  return !facts.data.listed.empty() &&
         std::ranges::find(facts.data.listed, facts.index(), &ListedObject::index) == facts.data.listed.end();
}

bool is_required_sub_index(const Facts& facts) {
  if (facts.object != nullptr && facts.object->has_sub_indices() && facts.sub_index() == 0) return true;
  const StandardEntry* const entry = standard_entry(facts);
  return entry != nullptr && entry->required && entry->first == facts.sub_index();
}

bool is_mandatory_entry(const Facts& facts) {
  return (is_mandatory(facts) && facts.sub_index() == 0) || is_required_sub_index(facts);
}

/// The EDS describes a sub-index above the value of its own sub-index 0, and the device has the same value.
bool exceeds_own_count(const Facts& facts) {
  if (!states_highest_sub_index(*facts.object)) return false;
  const auto written = written_count(facts.data, *facts.object);
  return written && *written < facts.sub_index() && number_read(facts, facts.index(), 0) == *written;
}

/// Sub-index 0 of the EDS counts a sub-index that it does not describe.
bool is_counted_by_eds(const Facts& facts) {
  if (facts.object == nullptr || !states_highest_sub_index(*facts.object)) return false;
  const auto written = written_count(facts.data, *facts.object);
  return written && *written >= facts.sub_index() && facts.object->highest_sub_index() < facts.sub_index();
}

bool is_unknown_to_standard(const Facts& facts) {
  const StandardObject* const standard = standard_object(facts);
  return standard != nullptr && standard->type != ObjectType::var && facts.sub_index() != 0 &&
         find_standard_entry(*standard, facts.sub_index()) == nullptr;
}

bool eds_has_required_size(const Facts& facts) {
  const auto required = required_type(facts);
  return required && required->fits(eds_bytes(facts)) && !required->fits(device_bytes(facts));
}
bool device_has_required_size(const Facts& facts) {
  const auto required = required_type(facts);
  return required && !required->fits(eds_bytes(facts)) && required->fits(device_bytes(facts));
}
bool none_has_required_size(const Facts& facts) {
  const auto required = required_type(facts);
  return required && !required->fits(eds_bytes(facts)) && !required->fits(device_bytes(facts));
}

/// The entry of a mapping parameter of the device that maps the entry with this number of bits; nothing: none.
std::optional<EntryKey> mapping_in_device(const Facts& facts, std::size_t bits) {
  for (const auto& [key, reading] : facts.readings) {
    if (!contains(mapping_parameters, key.first) || key.second == 0 || !reading.outcome.done()) continue;
    const MappingValue mapped = MappingValue::of(static_cast<std::uint32_t>(number_of(reading.outcome.bytes)));
    if (mapped.index == facts.index() && mapped.sub_index == facts.sub_index() && mapped.bits == bits) return key;
  }
  return std::nullopt;
}

bool contradicts_own_mapping(const Facts& facts) {
  return !mapping_in_device(facts, 8 * device_bytes(facts)) && mapping_in_device(facts, 8 * eds_bytes(facts));
}

/// The default mapping of the EDS has the number of bits that the device sends.
const PdoEntry* mapping_in_eds(const Facts& facts) {
  for (const Pdo& pdo : facts.sheet.pdos) {
    for (const PdoEntry& entry : pdo.entries) {
      const bool is_it = entry.index == facts.index() && entry.sub_index == facts.sub_index();
      if (is_it && entry.bits == 8 * device_bytes(facts)) return &entry;
    }
  }
  return nullptr;
}
bool contradicts_mapping_of_eds(const Facts& facts) { return mapping_in_eds(facts) != nullptr; }

bool device_is_write_only(const Facts& facts) {
  return facts.reading.outcome.end == SdoEnd::refused && facts.reading.outcome.code == AbortCode::write_only;
}

/// Whether a standard allows the access of each. A read shows of the device only whether it is write-only.
struct AllowedAccess {
  bool of_eds = false, of_device = false;
};

/// Nothing if neither CiA 301 nor the profile defines the access.
std::optional<AllowedAccess> allowed_access(const Facts& facts) {
  const Access of_eds = facts.reading.entry.entry->access;
  const bool is_write_only = device_is_write_only(facts);
  if (const StandardEntry* const entry = standard_entry(facts)) {
    return AllowedAccess{entry->access.has(of_eds), entry->access.has(Access::wo) == is_write_only};
  }
  const auto row = profile_row(facts);
  if (!row) return std::nullopt;
  const bool may_be_write_only = fits(row->object->use, Access::wo);
  return AllowedAccess{fits(row->object->use, of_eds),
                       is_write_only ? may_be_write_only : canopen::readable(row->object->access)};
}

bool standard_has_access_of_eds(const Facts& facts) {
  const auto allowed = allowed_access(facts);
  return allowed && allowed->of_eds && !allowed->of_device;
}
bool standard_has_access_of_device(const Facts& facts) {
  const auto allowed = allowed_access(facts);
  return allowed && !allowed->of_eds && allowed->of_device;
}

/// The number of [DeviceInfo] that 1018h has too; 0: none.
std::uint32_t device_info_number(const Facts& facts) {
  if (facts.index() != identity) return 0;
  switch (facts.sub_index()) {
    case 1: return facts.sheet.vendor_number;
    case 2: return facts.sheet.product_number;
    case 3: return facts.sheet.revision_number;
    default: return 0;
  }
}
bool is_in_device_info(const Facts& facts) {
  return device_info_number(facts) != 0 && device_info_number(facts) == device_number(facts);
}

bool has_predefined_cob_id(const Facts& facts) {
  const auto predefined = other_predefined_cob_id(facts.data, *facts.reading.entry.entry, facts.node);
  return predefined && canopen::CobId{static_cast<std::uint32_t>(device_number(facts))}.can_id() == *predefined;
}
/// The EDS has the pre-defined COB-ID, and the device a different CAN-ID.
bool lacks_predefined_cob_id(const Facts& facts) {
  const CobIdParameter* const parameter = find_cob_id_parameter(facts.index(), facts.sub_index());
  if (parameter == nullptr || !parameter->plus_node_id) return false;
  const std::uint32_t predefined = parameter->predefined_of(facts.index()) + facts.node.value();
  const auto can_id = [](std::uint64_t value) { return canopen::CobId{static_cast<std::uint32_t>(value)}.can_id(); };
  const Entry& entry = *facts.reading.entry.entry;
  return entry.default_value && can_id(conform::bits_of(facts.node, *entry.default_value)) == predefined &&
         can_id(device_number(facts)) != predefined;
}

bool is_count(const Facts& facts) { return facts.sub_index() == 0 && states_highest_sub_index(*facts.object); }

/// Sub-index 0 of the EDS is not the highest sub-index described, and sub-index 0 of the device is.
bool contradicts_own_sub_indices(const Facts& facts) {
  return is_count(facts) && written_count(facts.data, *facts.object) != facts.object->highest_sub_index() &&
         device_number(facts) == facts.object->highest_sub_index();
}

/// Sub-index 0 of the device is not its highest sub-index.
bool device_miscounts(const Facts& facts) {
  if (!is_count(facts)) return false;
  const std::uint64_t stated = device_number(facts);
  const Reading* const highest = stated > 254 ? nullptr : find(facts, facts.index(), static_cast<std::uint8_t>(stated));
  if (stated != 0 && highest != nullptr && highest->is_missing()) return true;
  for (const auto& [key, reading] : facts.readings) {
    if (key.first == facts.index() && key.second > stated && key.second < 0xFF && reading.exists()) return true;
  }
  return false;
}

/// CiA 301 does not define as many sub-indices as the device states.
bool exceeds_standard_count(const Facts& facts) {
  const StandardObject* const standard = standard_object(facts);
  return is_count(facts) && standard != nullptr && device_number(facts) > standard->entries.back().last;
}

bool is_identity(const Facts& facts) {
  return facts.index() == device_type || (facts.index() == identity && facts.sub_index() != 0);
}

bool is_reserved(const Facts& facts) {
  return !why_reserved(facts.index(), facts.sub_index(), device_number(facts)).empty();
}

bool is_default_outside_limits(const Facts& facts) {
  const auto bytes = conform::default_bytes(facts.node, *facts.reading.entry.entry);
  return bytes && *bytes == facts.reading.outcome.bytes;
}

// ---- corrections ----

std::string new_access(const Facts& facts) {
  if (device_is_write_only(facts)) return "wo";
  if (const StandardEntry* const entry = standard_entry(facts)) return entry->access.has(Access::rw) ? "rw" : "ro";
  const auto row = profile_row(facts);
  return std::string{canopen::row_of(row ? row->object->access : Access::rw).name};
}
Corrections set_access(const Facts& facts) {
  return {key_of(facts, "AccessType", &EntryDescription::access_type, new_access(facts))};
}

Corrections set_required_type(const Facts& facts) { return set_type_to(facts, *required_type(facts)->type); }

/// The type of the same class with the length of the device.
Corrections set_type_of_size(const Facts& facts) {
  const DataClass kind = facts.reading.entry.type->kind;
  for (const DataTypeRow& row : canopen::data_types) {
    if (row.kind == kind && row.bits != 0 && row.bits == 8 * device_bytes(facts)) return set_type_to(facts, row);
  }
  return {};
}

Corrections set_predefined_cob_id(const Facts& facts) {
  const CobIdParameter& parameter = *find_cob_id_parameter(facts.index(), facts.sub_index());
  constexpr std::uint32_t flags = canopen::CobId::invalid_bit | canopen::CobId::no_rtr_bit;
  const std::uint64_t value = (device_number(facts) & flags) | parameter.predefined_of(facts.index());
  return {value_key(facts, fmt::format("$NODEID+0x{:X}", value))};
}

/// The section that the EDS does not have, as CiA 301 describes the entry.
Corrections add_standard_entry(const Facts& facts) {
  const auto required = required_type(facts);
  const StandardEntry* const entry = standard_entry(facts);
  if (!required) return {};
  const std::string section = facts.object == nullptr && find_standard_object(facts.index())->type == ObjectType::var
                                  ? fmt::format("{:04X}", facts.index())
                                  : section_of(facts);
  const std::string_view name = facts.sub_index() == 0 && entry == nullptr ? "Highest sub-index supported"
                                                                           : find_standard_object(facts.index())->name;
  return {{section, "ParameterName", std::nullopt, std::string{name}},
          {section, "DataType", std::nullopt, type_code(*required->type)},
          {section, "AccessType", std::nullopt, entry == nullptr || !entry->access.has(Access::rw) ? "ro" : "rw"}};
}

/// The section of another element of an ARRAY, since all elements have one data type.
Corrections add_element(const Facts& facts) {
  const Entry* const first = facts.object == nullptr ? nullptr : facts.object->find(1);
  if (first == nullptr || facts.object->type != ObjectType::array) return {};
  const std::string section = section_of(facts);
  return {
      {section, "ParameterName", std::nullopt, fmt::format("{} {}", facts.object->parameter_name(), facts.sub_index())},
      {section, "DataType", std::nullopt, type_code(*first->type)},
      {section, "AccessType", std::nullopt, std::string{canopen::row_of(first->access).name}}};
}

Corrections add_entry(const Facts& facts) {
  return standard_entry(facts) != nullptr ? add_standard_entry(facts) : add_element(facts);
}

// ---- the table ----

constexpr auto eds_wrong = Mark::eds_wrong;
constexpr auto device_wrong = Mark::device_wrong;
constexpr auto undecided = Mark::undecided;

// clang-format off
constexpr Decision decision_rows[] = {
    {Kind::object_missing, "mandatory-object", "CiA 301 requires the object in each device", device_wrong, is_mandatory,
     "{object} is mandatory ({clause}), and the device does not have it"},
    {Kind::object_missing, "profile-object", "the profile in 1000h of the device requires the object", device_wrong, is_of_profile,
     "the device states the profile {other}, which requires {object}"},
    {Kind::object_missing, "needed-object", "another object of the device requires the object", device_wrong, is_required_by_other,
     "the device has {other}, which requires {object}"},
    {Kind::object_missing, "pdo-count", "the EDS describes more PDOs than NrOfRXPDO or NrOfTXPDO, which is the number of the device", eds_wrong, exceeds_pdo_count,
     "the EDS contradicts itself: it describes more PDOs than the number in [DeviceInfo], and the device has that number", remove_section},
    {Kind::object_missing, "object-not-listed", "the object lists of the EDS do not have the object", eds_wrong, is_not_listed,
     "the EDS contradicts itself: it describes {object}, but its object lists do not have it, and neither has the device", remove_section},
    {Kind::object_missing, "optional-object", "none: the object is optional", undecided, always,
     "no standard requires {object}; the frames do not show whether the device lacks it or the EDS promises too much", remove_section},

    {Kind::sub_index_missing, "required-sub-index", "CiA 301 requires the sub-index in this object", device_wrong, is_required_sub_index,
     "the device has {object}, for which {clause} requires {entry}"},
    {Kind::sub_index_missing, "eds-count", "sub-index 0 of the EDS is less, and sub-index 0 of the device is equal to it", eds_wrong, exceeds_own_count,
     "the EDS contradicts itself: it describes {entry}, but its own sub-index 0 is {other}, as in the device", remove_section},
    {Kind::sub_index_missing, "optional-sub-index", "none: the sub-index is optional", undecided, always,
     "no standard requires {entry}; the frames do not show whether the device lacks it or the EDS promises too much", remove_section},

    {Kind::not_in_eds, "required-entry", "CiA 301 requires the entry", eds_wrong, is_mandatory_entry,
     "{clause} requires {entry}; the device has it, and the EDS does not describe it", add_standard_entry},
    {Kind::not_in_eds, "undefined-sub-index", "CiA 301 defines the object without this sub-index", device_wrong, is_unknown_to_standard,
     "{clause} defines {object} without this sub-index"},
    {Kind::not_in_eds, "eds-counts-more", "sub-index 0 of the EDS counts the sub-index", eds_wrong, is_counted_by_eds,
     "the EDS contradicts itself: its own sub-index 0 is {other}, but it does not describe {entry}, which the device has", add_element},
    {Kind::not_in_eds, "additional-entry", "none: the frames do not show why", undecided, always,
     "the frames do not show whether the EDS lacks {entry} or the device has it by mistake", add_entry},

    {Kind::length, "standard-type", "CiA 301 or the profile requires the data type of the EDS", device_wrong, eds_has_required_size,
     "{clause} requires {standard}, as the EDS says"},
    {Kind::length, "eds-type", "CiA 301 or the profile requires a data type with the length of the device", eds_wrong, device_has_required_size,
     "{clause} requires {standard}, as the device sends it; the EDS has {eds}", set_required_type},
    {Kind::length, "no-standard-type", "CiA 301 or the profile requires a third length", device_wrong, none_has_required_size,
     "{clause} requires {standard}; neither the device nor the EDS has it"},
    {Kind::length, "device-mapping", "the device maps the entry with the length of the EDS", device_wrong, contradicts_own_mapping,
     "the device contradicts itself: {other} of the device maps {entry} with the length of the EDS, and its SDO response has another"},
    {Kind::length, "eds-mapping", "the EDS maps the entry with the length of the device", eds_wrong, contradicts_mapping_of_eds,
     "the EDS contradicts itself: it maps {entry} with the length that the device sends, and its DataType has another", set_type_of_size},
    {Kind::length, "free-type", "none: no standard defines the data type", undecided, always,
     "no standard defines the data type of {entry}; the frames do not show which length is intended", set_type_of_size},

    {Kind::access, "standard-access", "CiA 301 or the profile allows the access of the EDS and excludes the access of the device", device_wrong, standard_has_access_of_eds,
     "{clause} allows the access of the EDS, {eds}, and not the access of the device"},
    {Kind::access, "eds-access", "CiA 301 or the profile excludes the access of the EDS and allows the access of the device", eds_wrong, standard_has_access_of_device,
     "{clause} does not allow the access of the EDS, {eds}, and allows the access of the device", set_access},
    {Kind::access, "free-access", "none: no standard defines the access", undecided, always,
     "no standard defines the access of {entry}; the frames do not show which is intended", set_access},

    {Kind::value, "device-info", "[DeviceInfo] has the number of the device", eds_wrong, is_in_device_info,
     "the EDS contradicts itself: [DeviceInfo] has the number of the device, and {entry} another", set_value},
    {Kind::value, "eds-cob-id", "the device has the COB-ID of the pre-defined connection set, the EDS has another one", eds_wrong, has_predefined_cob_id,
     "the device has the COB-ID of the pre-defined connection set ({clause}) for its node-ID, and the EDS has another", set_predefined_cob_id},
    {Kind::value, "predefined-cob-id", "the EDS has the COB-ID of the pre-defined connection set as read-only, the device has another one", device_wrong, lacks_predefined_cob_id,
     "the EDS has the COB-ID of the pre-defined connection set ({clause}), and the device has another that cannot be written"},
    {Kind::value, "eds-sub-index-0", "sub-index 0 of the EDS is not the highest sub-index described, and sub-index 0 of the device is", eds_wrong, contradicts_own_sub_indices,
     "the EDS contradicts itself: sub-index 0 is not the highest sub-index that it describes, and sub-index 0 of the device is", set_value},
    {Kind::value, "device-sub-index-0", "sub-index 0 of the device is not its highest sub-index", device_wrong, device_miscounts,
     "the device contradicts itself: its sub-index 0 is not the highest sub-index that it has (CiA 301, 7.4.4)"},
    {Kind::value, "standard-count", "CiA 301 does not define as many sub-indices as the device states", device_wrong, exceeds_standard_count,
     "{clause} does not define as many sub-indices as the device states"},
    {Kind::value, "other-identity", "none: the EDS describes another device or another revision", undecided, is_identity,
     "the EDS describes another device, or another revision of it; the frames do not show which is intended", set_value},
    {Kind::value, "constant", "none: no standard defines the value", undecided, always,
     "the value is a constant by the EDS, and no standard defines it; the frames do not show which value is intended", set_value},

    {Kind::limit, "reserved-value", "CiA 301 reserves the value", device_wrong, is_reserved,
     "CiA 301 reserves the value: {standard}"},
    {Kind::limit, "eds-default", "DefaultValue is outside the limits of the EDS, and the device has it", eds_wrong, is_default_outside_limits,
     "the EDS contradicts itself: its own DefaultValue, which the device has, is outside its limits", set_limit},
    {Kind::limit, "free-limit", "none: no standard defines the limits", undecided, always,
     "the frames do not show whether the limit is wrong or the device has accepted a wrong value", set_limit},

    {Kind::unreadable, "abort-without-cause", "none: the abort code does not give the cause", undecided, always,
     "the device has {entry}, but does not give its value; the abort code does not show why"},

    {Kind::no_response, "no-response", "no response was received", undecided, always,
     "without a response the frames show nothing about {entry}"},
};
// clang-format on

// ---- the words of a reason ----

std::string other_of(const Facts& facts) {
  switch (facts.kind) {
    case Kind::object_missing: {
      if (const auto index = requiring_object(facts)) return index_label(*index);
      if (const auto profile = profile_of(facts)) return fmt::format("CiA {}", *profile);
      return {};
    }
    case Kind::sub_index_missing:
    case Kind::not_in_eds: {
      const auto written = facts.object == nullptr ? std::nullopt : written_count(facts.data, *facts.object);
      return written ? fmt::format("{}", *written) : std::string{};
    }
    case Kind::length: {
      const auto mapping = mapping_in_device(facts, 8 * eds_bytes(facts));
      return mapping ? entry_label(mapping->first, mapping->second) : std::string{};
    }
    default: return {};
  }
}

std::string clause_of(const Facts& facts) {
  if (facts.kind == Kind::length) {
    const auto required = required_type(facts);
    return required ? required->clause : std::string{};
  }
  if (const CobIdParameter* const parameter = find_cob_id_parameter(facts.index(), facts.sub_index());
      parameter != nullptr && facts.kind == Kind::value) {
    return fmt::format("CiA 301, {}", parameter->clause);
  }
  if (facts.kind == Kind::access && standard_entry(facts) == nullptr) {
    if (const auto row = profile_row(facts)) return fmt::format("CiA {}", row->profile->number);
  }
  const bool is_count = facts.kind == Kind::sub_index_missing && facts.sub_index() == 0;
  const StandardObject* const standard = find_standard_object(facts.index());
  return is_count || standard == nullptr ? std::string{structure_clause} : clause_of(*standard);
}

std::string standard_of(const Facts& facts) {
  if (facts.kind == Kind::length) {
    const auto required = required_type(facts);
    return required ? std::string{required->type->name} : std::string{};
  }
  if (facts.kind == Kind::limit) {
    return std::string{why_reserved(facts.index(), facts.sub_index(), device_number(facts))};
  }
  return {};
}

std::string reason_of(const Decision& row, const Facts& facts, const Difference& difference) {
  const StandardObject* const standard = find_standard_object(facts.index());
  const std::string name = facts.object != nullptr ? facts.object->name
                           : standard != nullptr   ? std::string{standard->name}
                                                   : std::string{};
  return fmt::format(fmt::runtime(row.reason), fmt::arg("entry", entry_label(facts.index(), facts.sub_index())),
                     fmt::arg("object", fmt::format("{} {}", index_label(facts.index()), name)),
                     fmt::arg("clause", clause_of(facts)), fmt::arg("standard", standard_of(facts)),
                     fmt::arg("eds", difference.in_eds), fmt::arg("device", difference.in_device),
                     fmt::arg("other", other_of(facts)));
}

}  // namespace

bool Facts::device_has(std::uint16_t index) const {
  const auto first = readings.lower_bound({index, 0});
  for (auto at = first; at != readings.end() && at->first.first == index; ++at) {
    if (at->second.exists()) return true;
  }
  return false;
}

std::span<const Decision> decisions() { return decision_rows; }

void decide(const Facts& facts, Difference& difference) {
  const auto* const row = std::ranges::find_if(
      decision_rows, [&](const Decision& one) { return one.kind == facts.kind && one.applies(facts); });
  difference.mark = row->mark;
  difference.evidence = row->id;
  difference.reason = reason_of(*row, facts, difference);
  if (row->correct != nullptr) difference.corrections = row->correct(facts);
  for (Correction& correction : difference.corrections) correction.reason = difference.reason;
}

bool states_highest_sub_index(const Object& object) {
  return object.has_sub_indices() && object.index != conform::error_history &&
         !contains(mapping_parameters, object.index);
}

std::optional<std::string> written_value(const DataSheet& data, const Object& object, std::uint8_t sub_index) {
  const ObjectDescription* const description = data.find(object.index);
  if (description == nullptr) return std::nullopt;
  const ValueFields fields = data.values_of(*description, sub_index, object.has_sub_indices());
  for (const Field* const field : {fields.parameter_value, fields.default_value}) {
    if (field != nullptr && field->present && !field->empty()) return std::string{field->text};
  }
  return std::nullopt;
}

std::optional<std::uint64_t> written_count(const DataSheet& data, const Object& object) {
  const Entry* const count = object.find(0);
  if (count == nullptr || !count->default_value) return std::nullopt;
  if (count->default_value->clause.empty()) return count->default_value->bits;
  const auto text = written_value(data, object, 0);
  return text ? parse_unsigned(strip_inline_comment(*text)) : std::nullopt;
}

std::optional<std::uint32_t> other_predefined_cob_id(const DataSheet& data, const Entry& entry, canopen::NodeId node) {
  const CobIdParameter* const parameter = find_cob_id_parameter(entry.index, entry.sub_index);
  if (parameter == nullptr || !parameter->plus_node_id || !entry.default_value) return std::nullopt;
  const std::uint32_t predefined = parameter->predefined_of(entry.index) + node.value();
  if (!entry.default_value->clause.empty()) {
    // edsc has replaced the value of the EDS: that of the default SDO.
    const bool is_default_sdo = entry.index == conform::default_sdo_server;
    const ObjectDescription* const description = data.find(entry.index);
    const SubObjectDescription* const sub = description == nullptr ? nullptr : description->find(entry.sub_index);
    return is_default_sdo && sub != nullptr && !sub->default_value.empty() ? std::optional{predefined} : std::nullopt;
  }
  const canopen::CobId stated{static_cast<std::uint32_t>(conform::bits_of(node, *entry.default_value))};
  return stated.can_id() == predefined ? std::nullopt : std::optional{predefined};
}

}  // namespace edsc::accept
