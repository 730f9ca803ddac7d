/// A device that the whole front end reads from the text of an EDS.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "backend/cpp/cpp_names.hpp"
#include "device/resolve.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "lint/check_device.hpp"
#include "support/diagnostic_matchers.hpp"
#include "text/source_file.hpp"

namespace edsc {

/// A name for the device, else that of its file, and its node-ID.
struct DeviceSettings {
  std::string name;
  std::optional<std::uint8_t> node_id;
};

/// Also owns everything that the positions of the device refer to.
struct DeviceFromText {
  explicit DeviceFromText(std::string text, Options given = {}, DeviceSettings settings = {},
                          std::string file = "test.eds")
      : source(std::move(file), std::move(text), Packing::none, given.reading),
        options(std::move(given)),
        sheet(read_data_sheet(parse_ini(source, diagnostics), diagnostics)),
        device(resolve_device(sheet, options, settings.node_id, diagnostics)),
        names(device, options, settings.name) {}

  SourceFile source;
  Diagnostics diagnostics;
  Options options;
  DataSheet sheet;
  Device device;
  CppNames names;

  [[nodiscard]] NamedDevice named() const { return {device, names}; }
  [[nodiscard]] const Entry& entry(std::uint16_t index, std::uint8_t sub_index = 0) const {
    const Entry* found = device.find(index, sub_index);
    if (found == nullptr) throw std::runtime_error{entry_label(index, sub_index) + " is missing"};
    return *found;
  }

  /// The first finding of a rule; throws if there is none.
  [[nodiscard]] const Diagnostic& finding(std::string_view rule) const {
    for (const Diagnostic& diagnostic : diagnostics.all()) {
      if (diagnostic.rule.text() == rule) return diagnostic;
    }
    throw std::runtime_error{"no finding of rule " + std::string{rule}};
  }

  /// The line that the first finding of a rule points at.
  [[nodiscard]] std::string_view line_of(std::string_view rule) const {
    return source.line(finding(rule).position.line);
  }
};

/// Rules about object lists and mandatory objects: short fixtures have neither.
inline const std::vector<std::string> list_rules = {"object-not-listed", "mandatory-object"};

/// The ids of all rules with a finding, each once, in the order of their first finding.
inline std::vector<std::string> rules_of(const Diagnostics& diagnostics) {
  std::vector<std::string> rules;
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    const std::string rule{diagnostic.rule.text()};
    if (std::ranges::find(list_rules, rule) != list_rules.end()) continue;
    if (std::ranges::find(rules, rule) == rules.end()) rules.push_back(rule);
  }
  return rules;
}

/// A VAR: `[2000]` and its keys; `more` adds lines such as `DefaultValue=1`.
inline std::string var(std::string_view index, std::string_view name, std::string_view data_type,
                       std::string_view access = "rw", std::string_view more = "") {
  std::string text;
  const auto line = [&](std::string_view key, std::string_view value) {
    text.append(key).append("=").append(value).append("\n");
  };
  text.append("[").append(index).append("]\n");
  line("ParameterName", name);
  line("ObjectType", "0x7");
  line("DataType", data_type);
  line("AccessType", access);
  return text.append(more);
}

/// A sub-object: `[2000sub1]` and its keys.
inline std::string sub(std::string_view index, int number, std::string_view name, std::string_view data_type,
                       std::string_view more = "") {
  return var(std::string{index} + "sub" + std::to_string(number), name, data_type, "rw", more);
}

/// The section of a RECORD or ARRAY without its sub-objects; `sub_objects` is the value of SubNumber.
inline std::string group(std::string_view index, std::string_view name, std::string_view object_type, int sub_objects) {
  std::string text{"["};
  text.append(index).append("]\nParameterName=").append(name).append("\nObjectType=").append(object_type);
  return text.append("\nSubNumber=").append(std::to_string(sub_objects)).append("\n");
}

}  // namespace edsc
