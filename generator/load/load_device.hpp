/// From a path to a checked device: what every command begins with.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "device/options.hpp"
#include "eds/data_sheet.hpp"
#include "text/source_file.hpp"

namespace edsc {

struct LoadSettings {
  std::string path;
  std::string options_path;             ///< empty: `NAME.options.json` beside the data sheet, if it is there
  std::string name;                     ///< C++ namespace; empty: from the file's name
  std::optional<std::uint8_t> node_id;
  bool static_mapping = false;          ///< of all PDOs, whatever the options file says
  bool check = true;                    ///< run the rules over the device
  bool keep_going = false;              ///< errors in the data sheet are warnings; what is wrong is left out
};

/// A device and all that its positions point into.
struct LoadedDevice {
  std::unique_ptr<SourceFile> source;
  std::unique_ptr<SourceFile> options_source;  ///< null when there is no options file
  Options options;
  DataSheet sheet;
  std::optional<Device> device;  ///< nothing when the file could not be read as a data sheet at all
  bool unreadable = false;       ///< a file could not be read: wrong usage, not wrong input
};

/// Reads, resolves and, where that is wanted, checks. Everything that is wrong stands in `diagnostics`; positions there point into the result.
[[nodiscard]] std::unique_ptr<LoadedDevice> load_device(const LoadSettings& settings, Diagnostics& diagnostics);

/// Whether `--keep-going` makes warnings of all errors.
[[nodiscard]] bool can_keep_going(const LoadedDevice& loaded, const Diagnostics& diagnostics);

/// Reports members of the options and comments of the data sheet that silence or allow what was not found.
void report_unused_allowances(const LoadedDevice& loaded, Diagnostics& diagnostics);

/// The same as load_device() from where `loaded` holds the source, and the options, already.
void resolve_and_check(LoadedDevice& loaded, const LoadSettings& settings, Diagnostics& diagnostics);

}  // namespace edsc
