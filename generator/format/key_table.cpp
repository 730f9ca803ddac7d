#include "format/key_table.hpp"

#include <fmt/format.h>

#include <limits>
#include <optional>
#include <span>

#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

struct SpelledKey {
  std::string_view name;
  ValueKind value = ValueKind::text;
  std::uint8_t hex_digits = 1;
  bool in_sub_objects = true;
};

constexpr std::uint8_t unsigned8 = 2;
constexpr std::uint8_t unsigned16 = 4;
constexpr std::uint8_t unsigned32 = 8;

constexpr SpelledKey file_info[] = {
    {"FileName"},     {"FileVersion"}, {"FileRevision"},     {"EDSVersion"},       {"Description"}, {"CreationTime"},
    {"CreationDate"}, {"CreatedBy"},   {"ModificationTime"}, {"ModificationDate"}, {"ModifiedBy"},  {"LastEDS"},
};

/// BaudRate_N has the position of the row that ends in `#`.
constexpr SpelledKey device_info[] = {
    {"VendorName"},
    {"VendorNumber", ValueKind::number, unsigned32},
    {"ProductName"},
    {"ProductNumber", ValueKind::number, unsigned32},
    {"RevisionNumber", ValueKind::number, unsigned32},
    {"OrderCode"},
    {"BaudRate_#", ValueKind::number},
    {"SimpleBootUpMaster", ValueKind::number},
    {"SimpleBootUpSlave", ValueKind::number},
    {"Granularity", ValueKind::number},
    {"DynamicChannelsSupported", ValueKind::number},
    {"CompactPDO", ValueKind::number},
    {"GroupMessaging", ValueKind::number},
    {"NrOfRXPDO", ValueKind::number},
    {"NrOfTXPDO", ValueKind::number},
    {"LSS_Supported", ValueKind::number},
    {"LSS_Master"},
    {"NG_Slave"},
    {"NG_Master"},
    {"NrOfNG_MonitoredNodes"},
    {"CANopenSafetySupported"},
};

constexpr SpelledKey commissioning[] = {
    {"NodeID", ValueKind::number, unsigned8},
    {"NodeName"},
    {"NodeRefd"},
    {"Baudrate", ValueKind::number},
    {"NetNumber", ValueKind::number},
    {"NetworkName"},
    {"NetRefd"},
    {"CANopenManager", ValueKind::number},
    {"LSS_SerialNumber", ValueKind::number, unsigned32},
};

constexpr SpelledKey dummy_usage[] = {{"Dummy%", ValueKind::number}};

constexpr SpelledKey comments[] = {{"Lines"}, {"Line#"}};

constexpr SpelledKey object_list[] = {{"SupportedObjects", ValueKind::count}, {"#", ValueKind::number, unsigned16}};

constexpr SpelledKey compact_values[] = {{"NrOfEntries", ValueKind::count}, {"#", ValueKind::typed}};

constexpr SpelledKey object_links[] = {{"ObjectLinks", ValueKind::count}, {"#", ValueKind::number, unsigned16}};

constexpr SpelledKey compact_texts[] = {{"NrOfEntries", ValueKind::count}, {"#"}};

constexpr SpelledKey object[] = {
    {"ParameterName"},
    {"ObjectType", ValueKind::number},
    {"SubNumber", ValueKind::number, 1, false},
    {"CompactSubObj", ValueKind::number, 1, false},
    {"DataType", ValueKind::number, unsigned16},
    {"AccessType", ValueKind::access},
    {"LowLimit", ValueKind::typed},
    {"HighLimit", ValueKind::typed},
    {"DefaultValue", ValueKind::typed},
    {"ParameterValue", ValueKind::typed},
    {"PDOMapping", ValueKind::number},
    {"ObjFlags", ValueKind::number},
    {"Denotation"},
    {"UploadFile"},
    {"DownloadFile"},
    {"ParamRefd"},
    // Not in CiA 306, but usual.
    {"Unit"},
    {"Factor"},
    {"Description"},
};

struct SectionRow {
  SectionKind kind;
  std::string_view title;  ///< for an object section, the part after the index
  std::span<const SpelledKey> keys;
};

constexpr SectionRow sections[] = {
    {SectionKind::file_info, "FileInfo", file_info},
    {SectionKind::device_info, "DeviceInfo", device_info},
    {SectionKind::dummy_usage, "DummyUsage", dummy_usage},
    {SectionKind::comments, "Comments", comments},
    {SectionKind::device_commissioning, "DeviceComissioning", commissioning},
    {SectionKind::mandatory_objects, "MandatoryObjects", object_list},
    {SectionKind::optional_objects, "OptionalObjects", object_list},
    {SectionKind::manufacturer_objects, "ManufacturerObjects", object_list},
    {SectionKind::object, "", object},
    {SectionKind::sub_object, "sub", object},
    {SectionKind::compact_names, "Name", compact_texts},
    {SectionKind::compact_values, "Value", compact_values},
    {SectionKind::compact_denotations, "Denotation", compact_texts},
    {SectionKind::object_links, "ObjectLinks", object_links},
};

const SectionRow* find_section(SectionKind kind) {
  for (const SectionRow& row : sections) {
    if (row.kind == kind) return &row;
  }
  return nullptr;
}

/// Reserved positions for the numbered keys of one row.
constexpr std::uint32_t row_step = 1U << 20U;
constexpr std::uint32_t unknown_order = std::numeric_limits<std::uint32_t>::max();

constexpr std::size_t dummy_digits = 4;

struct RowMatch {
  std::string name;
  std::uint32_t number = 0;
};

/// Whether a key matches the row: `#` is a number, `%` four hexadecimal digits.
std::optional<RowMatch> match(const SpelledKey& row, std::string_view key) {
  const char last = row.name.back();
  if (last != '#' && last != '%') {
    return equal_ignoring_case(row.name, key) ? std::optional{RowMatch{std::string{row.name}, 0}} : std::nullopt;
  }
  const std::string_view prefix = row.name.substr(0, row.name.size() - 1);
  if (!starts_with_ignoring_case(key, prefix)) return std::nullopt;
  const std::string_view digits = key.substr(prefix.size());
  if (last == '%') {
    const auto index = digits.size() == dummy_digits ? parse_hex(digits, dummy_digits) : std::nullopt;
    return index ? std::optional{RowMatch{fmt::format("{}{:04X}", prefix, *index), *index}} : std::nullopt;
  }
  const auto number = parse_unsigned(digits);
  if (!number || *number >= row_step) return std::nullopt;
  return RowMatch{fmt::format("{}{}", prefix, *number), static_cast<std::uint32_t>(*number)};
}

}  // namespace

KeySpelling spell_key(SectionKind section, std::string_view key) {
  const SectionRow* const known = find_section(section);
  std::uint32_t order = 0;
  for (const SpelledKey& row : known != nullptr ? known->keys : std::span<const SpelledKey>{}) {
    const bool belongs_here = row.in_sub_objects || section != SectionKind::sub_object;
    if (const auto found = belongs_here ? match(row, key) : std::nullopt) {
      return {order + found->number, found->name, row.value, row.hex_digits, found->number, true};
    }
    order += row_step;
  }
  return {unknown_order, std::string{key}, ValueKind::text, 1, 0, false};
}

std::string spell_title(const SectionName& name, std::string_view title) {
  const SectionRow* const known = find_section(name.kind);
  if (known == nullptr) return std::string{title};
  if (name.kind < SectionKind::object) return std::string{known->title};
  if (name.kind == SectionKind::sub_object)
    return fmt::format("{:04X}{}{:X}", name.index, known->title, name.sub_index);
  return fmt::format("{:04X}{}", name.index, known->title);
}

}  // namespace edsc
