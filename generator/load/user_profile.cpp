#include "load/user_profile.hpp"

#include <algorithm>
#include <utility>

#include "device/resolve.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "xdd/read_xdd.hpp"

namespace edsc {
namespace {

constexpr std::uint16_t first_row_index = 0x2000;

ProfileUse use_of(canopen::Access access) {
  switch (access) {
    case canopen::Access::rww:
    case canopen::Access::wo: return ProfileUse::command;
    case canopen::Access::ro: return ProfileUse::status;
    case canopen::Access::constant: return ProfileUse::constant;
    case canopen::Access::rw:
    case canopen::Access::rwr: break;
  }
  return ProfileUse::parameter;
}

/// The type of all elements; null if they differ.
const canopen::DataTypeRow* common_type(const Object& object) {
  const canopen::DataTypeRow* type = nullptr;
  for (const Entry& entry : object.entries) {
    if (object.has_sub_indices() && entry.sub_index == 0) continue;
    if (type != nullptr && type != entry.type) return nullptr;
    type = entry.type;
  }
  return type;
}

ProfileObject row_of_object(const Object& object, const std::string& file) {
  ProfileObject row;
  row.index = object.index;
  row.object_code = !object.has_sub_indices() ? "VAR" : object.type == ObjectType::array ? "ARRAY" : "RECORD";
  row.type = common_type(object);
  row.access = object.entries.back().access;
  row.use = use_of(row.access);
  row.source = file;
  return row;
}

}  // namespace

UserProfile read_user_profile(const std::string& path, Diagnostics& diagnostics) {
  UserProfile result;
  std::string error;
  result.source = read_source_file(path, error);
  if (!result.source) {
    result.source = std::make_unique<SourceFile>(path, std::string{});
    diagnostics.error("unreadable-file", Position{result.source.get()}, error);
    result.is_readable = false;
    return result;
  }
  Diagnostics ignored;  // a database describes no device: it lacks what a device must have
  const SourceFile& source = *result.source;
  const DataSheet sheet =
      is_xml(source) ? read_xdd(source, ignored) : read_data_sheet(parse_ini(source, ignored), ignored);
  const Device device = resolve_device(sheet, {}, {}, ignored);
  result.profile.title = source.name();
  if (const Entry* const type = device.find(0x1000, 0); type != nullptr && type->default_value) {
    result.profile.number = static_cast<std::uint16_t>(type->default_value->bits);
  }
  for (const Object& object : device.objects) {
    if (object.index >= first_row_index && !object.entries.empty()) {
      result.profile.objects.push_back(row_of_object(object, source.name()));
    }
  }
  if (result.profile.objects.empty()) {
    diagnostics.error("no-objects", Position{result.source.get()}, "the profile does not have an object from 2000h on");
  }
  return result;
}

}  // namespace edsc
