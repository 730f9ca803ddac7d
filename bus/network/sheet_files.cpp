#include "network/sheet_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "diagnostics/diagnostics.hpp"
#include "eds/number.hpp"
#include "load/load_device.hpp"
#include "network/communication_objects.hpp"
#include "network/network.hpp"
#include "system/path.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

/// Nothing if the file is not a device description. Errors in the values of a file do not matter here.
std::optional<SheetFile> read_sheet(const std::string& path) {
  constexpr std::uint8_t any_node_id = 1;  // the identity does not depend on it
  Diagnostics ignored;
  LoadSettings settings;
  settings.path = path;
  settings.node_id = any_node_id;
  settings.check = false;
  const auto loaded = load_device(settings, ignored);
  if (!loaded->device || loaded->device->objects.empty()) return std::nullopt;
  const Device& device = *loaded->device;
  SheetFile file{path, loaded->sheet.is_dcf, {}, {}, identity_of(device)};
  if (file.is_dcf) {
    const auto node_id = parse_unsigned(loaded->sheet.commissioning.node_id.text);
    if (node_id && *node_id >= 1 && *node_id <= 127) file.node_id = static_cast<std::uint8_t>(*node_id);
    if (device.information.commissioning) file.node_name = device.information.commissioning->node_name;
  }
  const Entry* const heartbeat = device.find(communication::producer_heartbeat, 0);
  for (const auto& part : loaded->parts) {
    if (part->name() != path) file.bases.push_back(part->name());
  }
  file.has_heartbeat = heartbeat != nullptr && canopen::writable(heartbeat->access);
  file.heartbeat_ms = static_cast<std::uint32_t>(value_of(device, communication::producer_heartbeat).value_or(0));
  return file;
}

}  // namespace

SheetFiles read_sheet_files(const std::vector<std::string>& paths) {
  SheetFiles read;
  for (const std::string& path : paths) {
    if (auto file = read_sheet(path)) {
      read.files.push_back(*std::move(file));
    } else {
      read.problems.push_back(path + ": cannot be read as an EDS, DCF or XDD file (\"edsc check\" lists why)");
    }
  }
  std::vector<fs::path> bases;
  for (const SheetFile& file : read.files) {
    for (const std::string& base : file.bases) bases.push_back(to_native(base).lexically_normal());
  }
  std::erase_if(read.files, [&](const SheetFile& file) {
    return std::ranges::find(bases, to_native(file.path).lexically_normal()) != bases.end();
  });
  return read;
}

std::vector<FittingSheet> fitting_sheets(const std::vector<SheetFile>& files, std::uint8_t node_id,
                                         const Identity& identity) {
  std::vector<FittingSheet> fitting;
  for (const SheetFile& file : files) {
    const IdentityMatch match = compare_identity(file.identity, identity);
    const bool is_for_another_node = file.node_id && *file.node_id != node_id;
    if (!fits(match) || is_for_another_node) continue;
    fitting.push_back({&file, match, not_compared(file.identity, identity).size()});
  }
  std::ranges::stable_sort(fitting, {}, [](const FittingSheet& one) {
    return std::tuple{one.match, one.not_compared, !one.file->node_id.has_value()};
  });
  return fitting;
}

}  // namespace edsc
