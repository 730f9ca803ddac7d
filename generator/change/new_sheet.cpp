#include "change/new_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "change/apply_changes.hpp"
#include "change/new_objects.hpp"
#include "change/open_sheet.hpp"
#include "device/bit_rates.hpp"

namespace edsc {
namespace {

/// Objects and PDOs of a new device by its profile.
struct ProfileSheetRow {
  std::uint16_t profile;
  std::uint32_t device_type;  ///< 1000h
  std::vector<std::uint16_t> objects;
  std::vector<std::uint16_t> tpdo, rpdo;  ///< PDO 1
};

const std::vector<ProfileSheetRow>& profile_sheet_rows() {
  static const std::vector<ProfileSheetRow> rows = {
      {0, 0, {}, {}, {}},
      {401, 0x0003'0191, {0x6000, 0x6200, 0x6206, 0x6207}, {0x6000}, {0x6200}},
      {402, 0x0002'0192, {0x603F, 0x6040, 0x6041, 0x605A, 0x6060, 0x6061, 0x6502}, {0x6041, 0x6061}, {0x6040, 0x6060}},
      {404, 0x0000'0194, {0x7100}, {0x7100}, {}},
      {406,
       0x0002'0196,
       {0x6000, 0x6001, 0x6002, 0x6003, 0x6004, 0x6200, 0x6500, 0x6501, 0x6502, 0x6503, 0x6504, 0x6505, 0x6506, 0x6507,
        0x6508, 0x6509, 0x650B},
       {0x6004},
       {}},
  };
  return rows;
}

const ProfileSheetRow& row_of_profile(std::uint16_t profile) {
  const auto& rows = profile_sheet_rows();
  const auto found = std::ranges::find(rows, profile, &ProfileSheetRow::profile);
  return found == rows.end() ? rows.front() : *found;
}

NewSection file_info_of(const NewSheet& sheet) {
  return {"FileInfo",
          {{"FileName", sheet.file_name},
           {"FileVersion", "1"},
           {"FileRevision", "1"},
           {"EDSVersion", "4.0"},
           {"Description", sheet.product_name},
           {"CreationTime", sheet.time},
           {"CreationDate", sheet.date},
           {"CreatedBy", sheet.vendor_name},
           {"ModificationTime", sheet.time},
           {"ModificationDate", sheet.date},
           {"ModifiedBy", sheet.vendor_name}}};
}

NewSection device_info_of(const NewSheet& sheet) {
  NewSection info{"DeviceInfo",
                  {{"VendorName", sheet.vendor_name},
                   {"VendorNumber", fmt::format("0x{:08X}", sheet.vendor)},
                   {"ProductName", sheet.product_name},
                   {"ProductNumber", fmt::format("0x{:08X}", sheet.product)},
                   {"RevisionNumber", fmt::format("0x{:08X}", sheet.revision)},
                   {"OrderCode", sheet.product_name},
                   {"SimpleBootUpMaster", "0"},
                   {"SimpleBootUpSlave", "1"},
                   {"Granularity", "8"},
                   {"DynamicChannelsSupported", "0"},
                   {"GroupMessaging", "0"},
                   {"NrOfRXPDO", "0"},
                   {"NrOfTXPDO", "0"},
                   {"LSS_Supported", sheet.has_lss ? "1" : "0"}}};
  for (const std::uint16_t rate : bit_rates) {
    const bool is_supported = std::ranges::find(sheet.bit_rates, rate) != sheet.bit_rates.end();
    info.keys.emplace_back(fmt::format("BaudRate_{}", rate), is_supported ? "1" : "0");
  }
  return info;
}

NewSection dummy_usage() {
  NewSection dummies{"DummyUsage", {}};
  for (unsigned type = 1; type <= 7; ++type) dummies.keys.emplace_back(fmt::format("Dummy{:04X}", type), "0");
  return dummies;
}

std::set<std::uint16_t> indices_of(const NewSheet& sheet) {
  std::set<std::uint16_t> indices{0x1000, 0x1001, 0x1003, 0x1005, 0x1008, 0x1014, 0x1017, 0x1018};
  if (sheet.stores) indices.insert({0x1010, 0x1011});
  const std::vector<std::uint16_t>& of_profile = row_of_profile(sheet.profile).objects;
  indices.insert(of_profile.begin(), of_profile.end());
  for (const DriveModeRow* const mode : sheet.modes) indices.insert(mode->objects.begin(), mode->objects.end());
  for (const auto* const pdos : {&sheet.tpdos, &sheet.rpdos}) {
    for (const auto& objects : *pdos) indices.insert(objects.begin(), objects.end());
  }
  return indices;
}

std::uint8_t elements_of(std::uint16_t index) {
  return index == 0x1003 ? 4 : index >= 0x607B && index <= 0x6099 ? 2 : 1;
}

void set_default(NewObject& object, std::size_t value, std::string text) {
  if (value < object.values.size()) object.values[value].default_value = std::move(text);
}

/// Default values that follow from the description of the device.
void set_defaults(const NewSheet& sheet, NewObject& object) {
  switch (object.index) {
    case 0x1000: set_default(object, 0, fmt::format("0x{:08X}", row_of_profile(sheet.profile).device_type)); break;
    case 0x1008: set_default(object, 0, sheet.product_name); break;
    case 0x1017: set_default(object, 0, fmt::format("{}", sheet.heartbeat_ms.value_or(0))); break;
    case 0x1018:
      set_default(object, 0, fmt::format("0x{:08X}", sheet.vendor));
      set_default(object, 1, fmt::format("0x{:08X}", sheet.product));
      set_default(object, 2, fmt::format("0x{:08X}", sheet.revision));
      break;
    default: break;
  }
  if (sheet.profile != 402) return;
  if (object.index == 0x6502) {
    std::uint32_t bits = 0;
    for (const DriveModeRow* const mode : sheet.modes) bits |= 1U << mode->bit;
    set_default(object, 0, fmt::format("0x{:08X}", bits));
  } else if (object.index == 0x6060 && !sheet.modes.empty()) {
    set_default(object, 0, fmt::format("{}", sheet.modes.front()->mode));
  }
}

std::vector<NewSection> sections_of_sheet(const NewSheet& sheet, std::string& problem) {
  std::vector<NewSection> sections{file_info_of(sheet), device_info_of(sheet), dummy_usage()};
  for (const std::uint16_t index : indices_of(sheet)) {
    auto object = standard_object(index, sheet.profile, elements_of(index));
    if (!object) {
      problem =
          fmt::format("edsc does not know the data type of {:04X}h; add the object with \"edsc object add\"", index);
      return {};
    }
    set_defaults(sheet, *object);
    for (NewSection& section : sections_of(*object, SubIndexNotation::hexadecimal))
      sections.push_back(std::move(section));
  }
  return sections;
}

/// The first entry of each object that a PDO can map.
std::vector<MappingValue> mapped_by(const Device& device, const std::vector<std::uint16_t>& indices) {
  std::vector<MappingValue> mapped;
  for (const std::uint16_t index : indices) {
    const Object* const object = device.find(index);
    if (object == nullptr) continue;
    for (const Entry& entry : object->entries) {
      if (object->has_sub_indices() && entry.sub_index == 0) continue;
      mapped.push_back({entry.index, entry.sub_index, entry.type->bits});
      break;
    }
  }
  return mapped;
}

void add_maps(PdoDirection direction, const std::vector<std::vector<std::uint16_t>>& given,
              const std::vector<std::uint16_t>& suggested, const Device& device, std::vector<SheetChange>& changes) {
  std::vector<std::vector<std::uint16_t>> pdos = given;
  if (pdos.empty() && !suggested.empty()) pdos.push_back(suggested);
  for (std::size_t i = 0; i < pdos.size(); ++i) {
    MapPdo map;
    map.direction = direction;
    map.number = static_cast<std::uint16_t>(i + 1);
    map.objects = mapped_by(device, pdos[i]);
    map.transmission_type = std::uint8_t{255};
    if (direction == PdoDirection::transmit) {
      map.inhibit_time = std::uint16_t{0};
      map.event_timer = std::uint16_t{0};
    }
    changes.emplace_back(std::move(map));
  }
}

}  // namespace

const std::vector<DriveModeRow>& drive_mode_rows() {
  static const std::vector<DriveModeRow> rows = {
      {"pp", 0, 1, {0x6064, 0x607A, 0x6081, 0x6083, 0x6084}},
      {"vl", 1, 2, {0x6042, 0x6043, 0x6044, 0x6046}},
      {"pv", 2, 3, {0x606B, 0x606C, 0x6083, 0x6084, 0x60FF}},
      {"tq", 3, 4, {0x6071, 0x6074, 0x6077, 0x6087}},
      {"hm", 5, 6, {0x607C, 0x6098, 0x6099, 0x609A}},
      {"csp", 7, 8, {0x6064, 0x607A}},
      {"csv", 8, 9, {0x606C, 0x60FF}},
      {"cst", 9, 10, {0x6071, 0x6077}},
  };
  return rows;
}

std::string new_sheet_text(const NewSheet& sheet, std::string& problem) {
  std::vector<NewSection> sections = sections_of_sheet(sheet, problem);
  if (!problem.empty()) return {};
  const ChangeSettings settings{.force = true, .utf8 = true, .stamp = {}};
  const auto empty = open_sheet(sheet.file_name, "", {}, SheetChecks::reading);
  AppliedChanges applied = apply_changes(*empty, std::vector<SheetChange>{AddSections{std::move(sections)}}, settings);
  problem = applied.problem;
  if (!problem.empty() || !applied.after->device) return {};
  const ProfileSheetRow& row = row_of_profile(sheet.profile);
  std::vector<SheetChange> maps;
  add_maps(PdoDirection::receive, sheet.rpdos, row.rpdo, *applied.after->device, maps);
  add_maps(PdoDirection::transmit, sheet.tpdos, row.tpdo, *applied.after->device, maps);
  AppliedChanges mapped = apply_changes(*applied.after, maps, settings);
  problem = mapped.problem;
  return problem.empty() ? canonical_text(*mapped.after) : std::string{};
}

}  // namespace edsc
