#include "device/meaning/profiles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <deque>
#include <iterator>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "device/meaning/built_in_profiles.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

constexpr std::uint16_t first_profile_index = 0x6000, last_profile_index = 0x9FFF;

/// A profile of edsc, which is read when it is needed: reading all of them takes longer than checking a device.
class LazyProfile {
 public:
  explicit LazyProfile(const BuiltInProfile& file) : source_{std::string{file.name}, std::string{file.text}} {}

  [[nodiscard]] const MeaningProfile& get() {
    std::call_once(read_, [&] {
      Diagnostics diagnostics;
      profile_ = read_meaning_profile(source_, diagnostics);
    });
    return profile_;
  }

 private:
  std::once_flag read_;
  SourceFile source_;  ///< positions point to it
  MeaningProfile profile_;
};

constexpr std::string_view object_codes[] = {"VAR", "ARRAY", "RECORD"};

struct UseName {
  std::string_view name;
  ProfileUse use;
};
constexpr UseName use_names[] = {{"command", ProfileUse::command},
                                 {"status", ProfileUse::status},
                                 {"parameter", ProfileUse::parameter},
                                 {"constant", ProfileUse::constant}};

/// `["VAR", "UNSIGNED16", "rw", "command", "manual 000"]`; nothing if a part is unknown.
std::optional<ProfileObject> read_profile_object(std::string_view index, const nlohmann::json& row) {
  constexpr std::size_t parts = 5;
  const bool has_parts = row.is_array() && row.size() == parts &&
                         std::ranges::all_of(row, [](const nlohmann::json& part) { return part.is_string(); });
  const auto number = parse_index(index);
  if (!has_parts || !number) return std::nullopt;
  const auto text = [&](std::size_t part) { return row[part].get<std::string>(); };
  const auto* const code = std::ranges::find(object_codes, text(0));
  const auto* const access = std::ranges::find(canopen::access_rows, text(2), &canopen::AccessRow::name);
  const auto* const use = std::ranges::find(use_names, text(3), &UseName::name);
  const auto* const type = std::ranges::find(canopen::data_types, text(1), &canopen::DataTypeRow::name);
  const bool has_type = type != std::end(canopen::data_types);
  if (code == std::end(object_codes) || access == std::end(canopen::access_rows) || use == std::end(use_names) ||
      (!has_type && !text(1).empty()))
    return std::nullopt;
  return ProfileObject{*number, *code, has_type ? type : nullptr, access->access, use->use, text(4)};
}

std::vector<ProfileObject> read_profile_objects(const nlohmann::json& rows, OptionFile& file) {
  std::vector<ProfileObject> objects;
  for (const auto& [index, row] : file.json().members(rows)) {
    if (auto object = read_profile_object(index, *row)) {
      objects.push_back(std::move(*object));
    } else {
      file.error(*row, index, "expected object code, data type, access type, use and source");
    }
  }
  std::ranges::sort(objects, {}, &ProfileObject::index);
  return objects;
}

std::map<std::uint16_t, std::string> read_profile_names(const nlohmann::json& rows, OptionFile& file) {
  std::map<std::uint16_t, std::string> names;
  for (const auto& [index, name] : file.json().members(rows)) {
    const auto number = parse_index(index);
    if (number && name->is_string()) {
      names[*number] = name->get<std::string>();
    } else {
      file.error(*name, index, "expected the name of an object");
    }
  }
  return names;
}

/// `["Delta time", "UNSIGNED16", "rw"]`, without the access type or both if they are those of the object; nothing if a
/// part is unknown.
std::optional<ProfileEntry> read_profile_entry(const nlohmann::json& row) {
  const bool has_parts = row.is_array() && !row.empty() && row.size() <= 3 &&
                         std::ranges::all_of(row, [](const nlohmann::json& part) { return part.is_string(); });
  if (!has_parts) return std::nullopt;
  ProfileEntry entry{row[0].get<std::string>()};
  if (row.size() > 1) {
    const auto* const type =
        std::ranges::find(canopen::data_types, row[1].get<std::string>(), &canopen::DataTypeRow::name);
    if (type == std::end(canopen::data_types)) return std::nullopt;
    entry.type = type;
  }
  if (row.size() > 2) {
    const auto* const access =
        std::ranges::find(canopen::access_rows, row[2].get<std::string>(), &canopen::AccessRow::name);
    if (access == std::end(canopen::access_rows)) return std::nullopt;
    entry.access = access->access;
  }
  return entry;
}

std::map<std::uint16_t, std::vector<ProfileEntry>> read_profile_entries(const nlohmann::json& rows, OptionFile& file) {
  std::map<std::uint16_t, std::vector<ProfileEntry>> entries;
  for (const auto& [index, row] : file.json().members(rows)) {
    const auto number = parse_index(index);
    bool is_valid = number && row->is_array();
    for (std::size_t i = 0; is_valid && i < row->size(); ++i) {
      auto entry = read_profile_entry((*row)[i]);
      is_valid = entry.has_value();
      if (entry) entries[*number].push_back(*std::move(entry));
    }
    if (!is_valid) file.error(*row, index, "expected a list of names, data types and access types");
  }
  return entries;
}

}  // namespace

std::string MeaningProfile::name_of(std::uint16_t index) const {
  const auto found = names.find(index);
  return found == names.end() ? std::string{} : found->second;
}

std::span<const ProfileEntry> MeaningProfile::entries_of(std::uint16_t index) const {
  const auto found = entries.find(index);
  return found == entries.end() ? std::span<const ProfileEntry>{} : found->second;
}

const ProfileObject* MeaningProfile::find(std::uint16_t index) const {
  const auto found = std::ranges::lower_bound(objects, index, {}, &ProfileObject::index);
  return found != objects.end() && found->index == index ? &*found : nullptr;
}

const MeaningProfile* find_profile(std::uint16_t number) {
  const std::span<const BuiltInProfile> files = built_in_profiles();
  static std::deque<LazyProfile> profiles(files.begin(), files.end());
  const auto found = std::ranges::find(files, number, &BuiltInProfile::number);
  return found != files.end() ? &profiles[static_cast<std::size_t>(found - files.begin())].get() : nullptr;
}

MeaningProfile::Place MeaningProfile::place_of(std::uint16_t index) const {
  if (repeat_offset == 0 || index < first_profile_index || index > last_profile_index) return {index, 0};
  const unsigned axis = static_cast<unsigned>(index - first_profile_index) / repeat_offset;
  if (axis >= repeat_count) return {index, 0};
  const auto offset = static_cast<std::uint16_t>(axis * repeat_offset);
  return {static_cast<std::uint16_t>(index - offset), offset};
}

MeaningProfile read_meaning_profile(const SourceFile& source, Diagnostics& diagnostics) {
  MeaningProfile profile;
  const JsonFile json_file{source};
  json_file.report_faults("options-syntax", diagnostics);
  const auto& root = json_file.root();
  if (!root.is_object()) return profile;
  OptionFile file{json_file, diagnostics};
  for (const auto& [name, value] : json_file.members(root)) {
    if (name == "profile" && value->is_number_unsigned()) {
      profile.number = value->get<std::uint16_t>();
    } else if (name == "title" && value->is_string()) {
      profile.title = value->get<std::string>();
    } else if (name == "repeat" && value->is_object()) {
      profile.repeat_offset = parse_index(value->value("offset", "")).value_or(0);
      profile.repeat_count = value->value("count", std::uint16_t{1});
    } else if (name == "meaning") {
      profile.meanings.entries = read_meaning(*value, name, MeaningSource::profile, file).entries;
    } else if (name == "objects" && value->is_object()) {
      profile.objects = read_profile_objects(*value, file);
    } else if (name == "names" && value->is_object()) {
      profile.names = read_profile_names(*value, file);
    } else if (name == "entries" && value->is_object()) {
      profile.entries = read_profile_entries(*value, file);
    } else if (name == "emcy") {
      profile.meanings.error_codes = read_error_codes(*value, name, MeaningSource::profile, file);
    } else {
      file.error(*value, name, "unknown member of a profile");
    }
  }
  return profile;
}

}  // namespace edsc
