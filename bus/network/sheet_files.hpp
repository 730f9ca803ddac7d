/// EDS, DCF, XDD and overlay files, to find the one that describes a device.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "online/identity.hpp"

namespace edsc {

/// A file, and what a network file needs of it.
struct SheetFile {
  std::string path;
  bool is_dcf = false;
  std::optional<std::uint8_t> node_id;  ///< of a DCF
  std::string node_name;                ///< of a DCF
  Identity identity;
  bool has_heartbeat = false;        ///< 1017h can be written
  std::uint32_t heartbeat_ms = 0;    ///< default value of 1017h
  std::vector<std::string> bases{};  ///< of an overlay
};

struct SheetFiles {
  std::vector<SheetFile> files;       ///< in the order of their paths
  std::vector<std::string> problems;  ///< files that could not be read
};

/// The base of an overlay is skipped if it is one of them: the overlay describes the device.
[[nodiscard]] SheetFiles read_sheet_files(const std::vector<std::string>& paths);

/// A file that fits a device.
struct FittingSheet {
  const SheetFile* file = nullptr;
  IdentityMatch match = IdentityMatch::same;
  std::size_t not_compared = 0;  ///< numbers of the identity
};

/// The files that fit the device with this node-ID, the best first: same revision before minor and major revision, then
/// more numbers compared, then a DCF for the node-ID. A DCF for another node-ID does not fit.
[[nodiscard]] std::vector<FittingSheet> fitting_sheets(const std::vector<SheetFile>& files, std::uint8_t node_id,
                                                       const Identity& identity);

}  // namespace edsc
