/// A text and the results of each stage up to its canonical form.
#pragma once

#include "format/canonical_form.hpp"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "backend/json/device_view.hpp"
#include "device/resolve.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "format/dcf/make_dcf.hpp"
#include "support/device_from_text.hpp"
#include "text/source_file.hpp"

namespace edsc {

/// A text and the results of each stage up to its canonical form.
struct Formatted {
  explicit Formatted(std::string text, std::optional<std::uint8_t> node_id = std::nullopt)
      : source("test.eds", std::move(text)),
        ini(parse_ini(source, diagnostics)),
        sheet(read_data_sheet(ini, diagnostics)),
        device(resolve_device(sheet, {}, node_id, diagnostics)) {}

  [[nodiscard]] std::string text() const { return to_text(canonical_form(ini, sheet, device)); }

  [[nodiscard]] std::string dcf(DcfValues values = DcfValues::different) const {
    Document document = canonical_form(ini, sheet, device);
    make_dcf(document, sheet, device, values);
    return to_text(document);
  }

  /// The device as `edsc dump` shows it, without line numbers.
  [[nodiscard]] nlohmann::ordered_json view() const {
    nlohmann::ordered_json view = device_view(device, Identifiers{device, {}});
    remove_lines(view);
    return view;
  }

  static void remove_lines(nlohmann::ordered_json& view) {
    if (view.is_object()) view.erase("line");
    for (auto& member : view) {
      if (member.is_structured()) remove_lines(member);
    }
  }

  SourceFile source;
  Diagnostics diagnostics;
  IniFile ini;
  DataSheet sheet;
  Device device;
};

/// [2000] with these keys after the usual ones.
[[nodiscard]] inline std::string object_with(std::string_view data_type, std::string_view keys) {
  return "[2000]\nParameterName=a\nDataType=" + std::string{data_type} + "\nAccessType=rw\n" + std::string{keys};
}

}  // namespace edsc
