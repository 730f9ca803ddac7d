/// The concise DCF, which an NMT master uses to configure a node: object 1F22h (CiA 302-3, 4.2).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/device.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// The number of entries, then each with index, sub-index, length and data, low byte first. It contains the writable
/// entries whose ParameterValue differs from their default value, in an order in which a device with its default values
/// accepts them (`order_writes`): a PDO is disabled before its mapping changes, so that its COB-ID and the number of
/// mapped objects occur twice. `device` is that of `sheet`, with the node-ID. A formula without node-ID and an invalid
/// value are reported and ignored.
[[nodiscard]] std::string concise_dcf(const DataSheet& sheet, const Device& device, Diagnostics& diagnostics);

struct ConciseEntry {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::string_view data;  ///< of the stream
};

/// Returns the entries of such a stream; nothing if its length does not match its contents.
[[nodiscard]] std::optional<std::vector<ConciseEntry>> read_concise_dcf(std::string_view stream);

}  // namespace edsc
