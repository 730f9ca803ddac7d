#include "commands/new_project.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "backend/cpp/identifier.hpp"
#include "backend/render.hpp"
#include "device/device.hpp"
#include "device/entry_text.hpp"
#include "system/path.hpp"
#include "text/ascii.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

using Json = nlohmann::ordered_json;

/// A file of each project, or of those whose view has `condition`. An empty name in the project: that of its template.
struct ProjectFileRow {
  std::string_view file_name;
  std::string_view condition;
};
constexpr ProjectFileRow project_file_rows[] = {
    {"CMakeLists.txt", ""}, {"CMakePresets.json", ""}, {"application.hpp", ""},     {"main.cpp", ""},
    {"firmware.cpp", ""},   {"serial_bus.hpp", ""},    {"lss_settings.hpp", "lss"},
};

/// A meaning that the profile leaves to the device: an example to adapt.
struct ProjectMeaningRow {
  std::uint16_t profile;
  std::uint16_t index;
  std::string_view json;
};
constexpr ProjectMeaningRow project_meaning_rows[] = {
    {401, 0x6000, R"({"bits": {"0": "input_1", "1": "input_2", "2": "input_3", "3": "input_4", "4": "input_5",
                      "5": "input_6", "6": "input_7", "7": "input_8"}})"},
    {401, 0x6200, R"({"bits": {"0": "output_1", "1": "output_2", "2": "output_3", "3": "output_4", "4": "output_5",
                      "5": "output_6", "6": "output_7", "7": "output_8"}})"},
    {402, 0x6064, R"({"unit": "rev", "scale": "1/4096"})"},
    {402, 0x607A, R"({"unit": "rev", "scale": "1/4096"})"},
    {402, 0x606C, R"({"unit": "rpm"})"},
    {402, 0x60FF, R"({"unit": "rpm"})"},
    {404, 0x7100, R"({"unit": "degC", "scale": "1/10"})"},
    {406, 0x6004, R"({"unit": "rev", "scale": "1/4096"})"},
};

std::string options_text(const NewSheet& sheet, const Device& device) {
  Json meaning = Json::object();
  for (const ProjectMeaningRow& row : project_meaning_rows) {
    if (row.profile != sheet.profile || device.find(row.index) == nullptr) continue;
    meaning[fmt::format("{:04X}h", row.index)] = Json::parse(row.json);
  }
  return meaning.empty() ? std::string{} : Json{{"meaning", std::move(meaning)}}.dump(2) + "\n";
}

/// A row for each object that the default PDOs of this direction map.
Json mapped_objects(const OpenSheet& open, PdoDirection direction) {
  Json rows = Json::array();
  std::set<std::pair<std::uint16_t, std::uint8_t>> known;
  for (const Pdo& pdo : open.device->pdos) {
    if (pdo.direction != direction) continue;
    for (const PdoEntry& mapped : pdo.entries) {
      if (mapped.object == nullptr || !known.emplace(mapped.object->index, mapped.object->sub_index).second) continue;
      const Object& object = *open.device->find(mapped.object->index);
      rows.push_back({{"type", open.names->space() + "::" + open.names->type_of(object, *mapped.object).text()},
                      {"what", printable(named(*mapped.object))}});
    }
  }
  return rows;
}

Json project_view(const std::string& file_name, const NewSheet& sheet, const OpenSheet& open) {
  return {{"file", file_name},
          {"name", open.names->space()},
          {"blank", ""},  // an empty line beside a section of the template
          {"stores", sheet.stores},
          {"lss", sheet.has_lss},
          {"stores_or_lss", sheet.stores || sheet.has_lss},
          {"received", mapped_objects(open, PdoDirection::receive)},
          {"sent", mapped_objects(open, PdoDirection::transmit)}};
}

}  // namespace

std::string project_name_fault(const std::string& path) {
  const std::string name = from_native(to_native(path).filename());
  const bool is_plain = std::ranges::all_of(name, [](char character) {
    return is_letter(character) || is_digit(character) || character == '_' || character == '-' || character == '.';
  });
  return is_plain ? std::string{} : name + " has characters other than letters, digits, _, - and .";
}

std::vector<OutputFile> project_files(const std::string& path, const NewSheet& sheet, const OpenSheet& open) {
  const std::filesystem::path native = to_native(path);
  const std::filesystem::path folder = native.parent_path();
  const Json view = project_view(from_native(native.filename()), sheet, open);
  std::vector<OutputFile> files;
  for (const ProjectFileRow& row : project_file_rows) {
    if (!row.condition.empty() && !view.at(std::string{row.condition}).get<bool>()) continue;
    files.push_back({from_native(folder / row.file_name), render(report_template(row.file_name), view)});
  }
  if (std::string options = options_text(sheet, *open.device); !options.empty()) {
    const std::string name = from_native(native.stem()) + ".options.json";
    files.push_back({from_native(folder / to_native(name)), std::move(options)});
  }
  return files;
}

}  // namespace edsc
