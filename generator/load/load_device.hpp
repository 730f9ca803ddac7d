/// Loads and checks a device from a path.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "backend/cpp/cpp_names.hpp"
#include "device/device.hpp"
#include "device/options/options.hpp"
#include "eds/data_sheet.hpp"
#include "load/user_profile.hpp"
#include "overlay/compose_overlay.hpp"
#include "text/source_file.hpp"

namespace edsc {

struct LoadSettings {
  std::string path;
  std::string options_path;  ///< empty: `NAME.options.json` beside the EDS, if it exists
  std::string name;          ///< C++ namespace; empty: from the file name
  std::optional<std::uint8_t> node_id;
  bool static_mapping = false;  ///< of all PDOs, regardless of the options file
  bool check = true;            ///< run the rules over the device
  bool keep_going = false;      ///< errors in the EDS become warnings; invalid objects are skipped
  bool needs_reasons = false;   ///< report sections of an overlay without a reason
  std::string profile_path{};   ///< a profile database of the user; empty: none
  ReadBase read{};              ///< reads the files of the device; empty: from the file system
};

/// A device and the files to which its positions point.
struct LoadedDevice {
  std::shared_ptr<const SourceFile> source;              ///< of an overlay, the text that it results in
  std::vector<std::shared_ptr<const SourceFile>> parts;  ///< the overlay and its bases; empty without an overlay
  std::unique_ptr<SourceFile> options_source;            ///< null without options file
  std::unique_ptr<UserProfile> user_profile;             ///< null without one
  Options options;
  DataSheet sheet;
  std::optional<Device> device;   ///< nothing if the file could not be read as a data sheet
  std::optional<CppNames> names;  ///< of the device
  bool unreadable = false;        ///< a file could not be read: wrong usage, not invalid input

  [[nodiscard]] NamedDevice named() const { return {*device, *names}; }
};

/// Reads, resolves and optionally checks a device. Adds findings to `diagnostics`, whose positions point into the
/// result.
[[nodiscard]] std::unique_ptr<LoadedDevice> load_device(const LoadSettings& settings, Diagnostics& diagnostics);

/// The names of all files of a device: EDS or overlay, its bases, options.
[[nodiscard]] std::vector<std::string> input_files(const LoadedDevice& loaded);

/// Replaces an overlay in `loaded.source` by the text that it results in; another file by the text that an overlay of
/// EDSC_OVERLAYS makes of it. Prints the name of such an overlay to standard error. Returns false if there is no text.
bool apply_overlays(LoadedDevice& loaded, const ComposeSettings& settings, Diagnostics& diagnostics);

/// How the options file beside a file says that it is read, for a command that needs no other option.
struct ChoicesOfOptions {
  std::unique_ptr<SourceFile> options;  ///< null without options file
  ReadingChoices choices;
};
/// The choices in the options file beside a file; of an overlay, else of its base. Errors in the options file are in
/// `diagnostics`, whose positions point into the result.
[[nodiscard]] ChoicesOfOptions choices_beside(const std::string& path, Diagnostics& diagnostics);

/// The device of the data sheet with another node-ID, or without one. Findings are not reported: those of the first
/// device were. `keep_going` as in its settings.
[[nodiscard]] Device device_for(const LoadedDevice& loaded, std::optional<std::uint8_t> node_id, bool keep_going);

/// Whether `--keep-going` turns all errors into warnings.
[[nodiscard]] bool can_keep_going(const LoadedDevice& loaded, const Diagnostics& diagnostics);

/// Reports options and comments that silence or allow findings that did not occur.
void report_unused_allowances(const LoadedDevice& loaded, Diagnostics& diagnostics);

/// The parts of load_device() after reading the source and the options into `loaded`: the data sheet, and the device of
/// the data sheet.
void read_sheet(LoadedDevice& loaded, Diagnostics& diagnostics);
void resolve_sheet(LoadedDevice& loaded, const LoadSettings& settings, Diagnostics& diagnostics);
/// Both parts.
void resolve_and_check(LoadedDevice& loaded, const LoadSettings& settings, Diagnostics& diagnostics);

}  // namespace edsc
