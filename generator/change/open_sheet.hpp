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

/// It does not change; a change makes another one. Positions of the members point into its source.
struct OpenSheet {
  std::string bytes;  ///< of the file
  std::shared_ptr<const SourceFile> source;
  IniFile ini;
  DataSheet sheet;
  std::optional<Device> device;   ///< nothing if the text has no object
  std::optional<CppNames> names;  ///< of the device
  Diagnostics diagnostics;        ///< findings, as `edsc check` reports them
};

/// What is reported about an open file.
enum class SheetChecks { none, all };

/// Reads, resolves and checks an EDS or DCF. `options` must outlive the result.
[[nodiscard]] std::unique_ptr<OpenSheet> open_sheet(std::string name, std::string bytes, const Options& options,
                                                    SheetChecks checks);

/// Whether `edsc format --check` passes.
[[nodiscard]] bool is_canonical(const OpenSheet& sheet);

}  // namespace edsc
