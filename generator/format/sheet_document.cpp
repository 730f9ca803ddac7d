#include "format/sheet_document.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "eds/sections/section_keys.hpp"
#include "eds/sections/section_name.hpp"
#include "format/object_list_sections.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

/// EDSVersion for the sections of CiA 306-1.
constexpr std::string_view eds_version = "4.0";

/// An object with sub-objects does not have a value, and CiA 306-1, 4.6.3, does not have these keys for it; an XDD
/// often has their attributes. Its DataType is that of sub-objects without one.
EntryDescription without_value(EntryDescription entry, const std::vector<SubObjectDescription>& sub_objects) {
  for (Field EntryDescription::*const field :
       {&EntryDescription::access_type, &EntryDescription::low_limit, &EntryDescription::high_limit,
        &EntryDescription::default_value, &EntryDescription::parameter_value, &EntryDescription::pdo_mapping}) {
    entry.*field = {};
  }
  const bool is_inherited = std::ranges::any_of(
      sub_objects, [](const SubObjectDescription& sub_object) { return !sub_object.data_type.present; });
  if (!is_inherited) entry.data_type = {};
  return entry;
}

/// The text on one line, with one blank between lines.
std::string one_line(std::string_view text) {
  std::string line;
  bool at_break = false;
  for (const char c : text) {
    const bool is_break = c == '\n' || c == '\r';
    const bool is_blank = is_break || c == ' ' || c == '\t';
    at_break = at_break || is_break;
    if (at_break && is_blank) continue;
    if (at_break) {
      while (line.ends_with(' ') || line.ends_with('\t')) line.pop_back();
      line += ' ';
    }
    at_break = false;
    line += c;
  }
  return line;
}

class SheetWriter {
 public:
  SheetWriter(const DataSheet& sheet, const std::string& file_name) : sheet_(sheet), file_name_(file_name) {}

  Document write() {
    write_file_info();
    write_device_info();
    write_dummies();
    if (sheet_.commissioning.present) {
      add_section({.kind = SectionKind::device_commissioning});
      put(commissioning_keys, sheet_.commissioning);
    }
    for (const ObjectDescription& object : sheet_.objects) write_object(object);
    renew_object_lists(document_, sheet_);
    return std::move(document_);
  }

 private:
  void add_section(const SectionName& name) {
    DocumentSection& section = document_.sections.emplace_back();
    section.kind = name;
    section.title = spell_section_name(name);
  }

  void put(std::string_view key, std::string_view value) {
    document_.sections.back().entries.push_back({{}, std::string{key}, one_line(value)});
  }

  template <typename Struct, std::size_t n>
  void put(const KeyRow<Struct> (&keys)[n], const Struct& source) {
    for (const KeyRow<Struct>& row : keys) {
      if (row.field != nullptr && (source.*row.field).present) put(row.key.name, (source.*row.field).text);
    }
  }

  void write_file_info() {
    FileInfo info = sheet_.file_info;
    info.file_name.text = file_name_;
    info.eds_version.text = eds_version;
    info.file_name.present = info.eds_version.present = true;
    add_section({.kind = SectionKind::file_info});
    put(file_info_keys, info);
  }

  void write_device_info() {
    if (!sheet_.device_info.present && sheet_.device_info.baud_rates.empty()) return;
    add_section({.kind = SectionKind::device_info});
    put(device_info_keys, sheet_.device_info);
    for (const DeviceInfo::BaudRate& rate : sheet_.device_info.baud_rates) {
      put(spell_numbered_key(baud_rate_key, rate.kbit_per_second), rate.field.text);
    }
  }

  void write_dummies() {
    if (sheet_.dummy_usage.empty()) return;
    add_section({.kind = SectionKind::dummy_usage});
    for (const NumberedField& used : sheet_.dummy_usage) {
      put(spell_numbered_key(dummy_key, used.number), used.field.text);
    }
  }

  void write_object(const ObjectDescription& object) {
    add_section({.kind = SectionKind::object, .index = object.index});
    const EntryDescription& entry = object;
    put_entry(object.sub_objects.empty() ? entry : without_value(entry, object.sub_objects));
    put(object_keys, object);
    for (const SubObjectDescription& sub_object : object.sub_objects) {
      add_section({.kind = SectionKind::sub_object, .index = object.index, .sub_index = sub_object.sub_index});
      put_entry(sub_object);
    }
  }

  /// The keys that objects and sub-objects have in common.
  void put_entry(const EntryDescription& entry) {
    if (sheet_.is_dcf) {
      put(entry_keys, entry);
      return;
    }
    EntryDescription of_eds = entry;
    of_eds.parameter_value.present = false;
    put(entry_keys, of_eds);
  }

  const DataSheet& sheet_;
  const std::string& file_name_;
  Document document_;
};

}  // namespace

Document document_of(const DataSheet& sheet, const std::string& file_name) {
  return SheetWriter(sheet, file_name).write();
}

}  // namespace edsc
