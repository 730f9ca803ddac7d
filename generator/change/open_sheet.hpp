/// An EDS or DCF that is changed: its bytes, and what they describe.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "backend/cpp/cpp_names.hpp"
#include "device/device.hpp"
#include "device/options/options.hpp"
#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "text/source_file.hpp"

namespace edsc {

/// What is reported about an open file.
enum class SheetChecks { reading, all };

/// It does not change; a change makes another one. Positions of the members point into its source.
struct OpenSheet {
  std::string bytes;  ///< of the file
  std::shared_ptr<const SourceFile> source;
  Options options;
  SheetChecks checks = SheetChecks::reading;
  IniFile ini;
  DataSheet sheet;
  std::optional<Device> device;   ///< nothing if the text does not have an object
  std::optional<CppNames> names;  ///< of the device
  Diagnostics diagnostics;        ///< with all checks the findings of `edsc check`, and remedies
};

/// Reads and resolves an EDS or DCF, and with `SheetChecks::all` checks it.
[[nodiscard]] std::unique_ptr<OpenSheet> open_sheet(std::string name, std::string bytes, const Options& options,
                                                    SheetChecks checks);

/// Whether `edsc format --check` passes.
[[nodiscard]] bool is_canonical(const OpenSheet& sheet);

/// The text that `edsc format` writes for a file with a device.
[[nodiscard]] std::string canonical_text(const OpenSheet& sheet);

}  // namespace edsc
