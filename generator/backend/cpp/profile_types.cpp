#include "backend/cpp/profile_types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "backend/cpp/json_object.hpp"
#include "backend/cpp/word_view.hpp"
#include "backend/render.hpp"
#include "device/meaning/resolve_meaning.hpp"
#include "device/options/options.hpp"

namespace edsc {
namespace {

using canopen::DataType;
using nlohmann::ordered_json;

struct ProfileTypeRow {
  std::uint16_t index;
  std::uint8_t sub_index;
  DataType type;
  std::string_view name;
};

/// Objects of CiA 402-2 with names of values or bits, and their data types.
constexpr ProfileTypeRow cia402_rows[] = {
    {0x6007, 0, DataType::integer16, "AbortConnectionOptionCode"},
    {0x6040, 0, DataType::unsigned16, "Controlword"},
    {0x6041, 0, DataType::unsigned16, "Statusword"},
    {0x605A, 0, DataType::integer16, "QuickStopOptionCode"},
    {0x605B, 0, DataType::integer16, "ShutdownOptionCode"},
    {0x605C, 0, DataType::integer16, "DisableOperationOptionCode"},
    {0x605D, 0, DataType::integer16, "HaltOptionCode"},
    {0x605E, 0, DataType::integer16, "FaultReactionOptionCode"},
    {0x6060, 0, DataType::integer8, "ModesOfOperation"},
    {0x607E, 0, DataType::unsigned8, "Polarity"},
    {0x6086, 0, DataType::integer16, "MotionProfileType"},
    {0x6088, 0, DataType::integer16, "TorqueProfileType"},
    {0x6098, 0, DataType::integer8, "HomingMethodNumber"},
    {0x60B8, 0, DataType::unsigned16, "TouchProbeFunction"},
    {0x60B9, 0, DataType::unsigned16, "TouchProbeStatus"},
    {0x60C0, 0, DataType::integer16, "InterpolationSubMode"},
    {0x60F2, 0, DataType::unsigned16, "PositioningOptionCode"},
    {0x60FD, 0, DataType::unsigned32, "DigitalInputs"},
    {0x6402, 0, DataType::unsigned16, "MotorType"},
    {0x6502, 0, DataType::unsigned32, "SupportedDriveModes"},
};

Entry entry_of(std::uint16_t index, std::uint8_t sub_index, DataType type) {
  Entry entry;
  entry.index = index;
  entry.sub_index = sub_index;
  entry.type = canopen::find_data_type(static_cast<std::uint32_t>(type));
  return entry;
}

/// A drive that has only these objects.
Device profile_drive() {
  Device drive;
  const auto add = [&](Entry entry) {
    Object object;
    object.index = entry.index;
    object.entries.push_back(std::move(entry));
    drive.objects.push_back(std::move(object));
  };
  Entry type = entry_of(0x1000, 0, DataType::unsigned32);
  type.default_value.emplace();
  type.default_value->bits = 402;
  add(std::move(type));
  for (const ProfileTypeRow& row : cia402_rows) add(entry_of(row.index, row.sub_index, row.type));
  Diagnostics diagnostics;
  resolve_meaning(drive, Options{}, diagnostics);
  return drive;
}

void append_contents(std::string& text, const ordered_json& node) {
  if (node.is_array()) {
    for (const ordered_json& one : node) {
      text += '[';
      append_contents(text, one);
      text += ']';
    }
  } else if (node.is_object()) {
    for (const auto& [name, value] : node.items()) {
      if (name == "comment") continue;
      append_contents(text, value);
      text += ';';
    }
  } else if (node.is_string()) {
    text += node.get_ref<const std::string&>();
  }
}

struct ProfileTypes {
  std::map<std::string, std::string> names;  ///< by contents
  ordered_json definitions = ordered_json::array();
  ordered_json names_of_values = ordered_json::array();
};

ProfileTypes make_profile_types() {
  ProfileTypes types;
  const Device drive = profile_drive();
  for (const ProfileTypeRow& row : cia402_rows) {
    const Entry& entry = *drive.find(row.index, row.sub_index);
    if (!entry.meaning) continue;
    const std::string name{row.name};
    ordered_json enumeration, word;
    if (entry.meaning->values) {
      enumeration = enumeration_view(entry);
    } else if (entry.meaning->has_fields()) {
      word = word_view(entry, "");
    } else {
      continue;
    }
    const bool is_new =
        types.names.emplace(contents_of_type(enumeration, word), fmt::format("{}::{}", cia402_types.name_space, name))
            .second;
    if (!is_new) continue;
    if (!enumeration.is_null()) enumeration["identifier"] = name;
    if (!word.is_null()) {
      word = word_view(entry, name);
      word["identifier"] = name;
    }
    add_names_of_values(types.names_of_values, name, enumeration, word);
    ordered_json comment = ordered_json::array();
    comment.push_back(fmt::format("{:04X}h{}.", row.index, comment_of(*entry.meaning)));
    types.definitions.push_back(json_object("comment", std::move(comment), "alias", nullptr, "enumeration",
                                            std::move(enumeration), "word", std::move(word)));
  }
  return types;
}

const ProfileTypes& profile_types() {
  static const ProfileTypes types = make_profile_types();
  return types;
}

/// A header with these rows. Its format is that of generated code.
std::string profile_header(std::string_view file, std::string_view key, const ordered_json& rows) {
  ordered_json view = json_object("file", "generator/profiles/cia402.json", "guard", "CANOPEN_CIA402",
                                  "meaning_namespace", cia402_types.name_space, "meaning_header",
                                  fmt::format("\"canopen/profile/{}\"", cia402_types.types_file), "profile", nullptr);
  view[std::string{key}] = json_object("rows", rows);
  const std::vector<Template>& templates = built_in_templates();
  const auto found = std::ranges::find(templates, file, &Template::file_name);
  return found == templates.end() ? std::string{} : render(found->text, view);
}

}  // namespace

std::string contents_of_type(const ordered_json& enumeration, const ordered_json& word) {
  std::string text;
  append_contents(text, enumeration);
  append_contents(text, word);
  return text;
}

std::string_view find_profile_type(const std::string& contents) {
  const auto found = profile_types().names.find(contents);
  return found == profile_types().names.end() ? std::string_view{} : std::string_view{found->second};
}

std::string cia402_types_header() { return profile_header("meaning.hpp", "meaning", profile_types().definitions); }

std::string cia402_text_header() {
  return profile_header("meaning_text.hpp", "meaning_text", profile_types().names_of_values);
}

}  // namespace edsc
