/// An entry of a live node: its description, and its value as text and as JSON.
#pragma once

#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "device/device.hpp"
#include "online/sdo_access.hpp"
#include "values/append.hpp"

namespace edsc {

/// One entry, with or without EDS.
struct LiveEntry {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  const Entry* entry = nullptr;                ///< null without EDS
  const canopen::DataTypeRow* type = nullptr;  ///< null: raw bytes
  std::string name;                            ///< `Identity object, Vendor-ID`; empty without EDS
  const Device* device = nullptr;              ///< null without EDS
  std::optional<std::int64_t> other = {};      ///< value of the object on which fields depend; nothing if unknown
};

[[nodiscard]] LiveEntry live_entry(const Device& device, const Object& object, const Entry& entry);
/// The entry of a device. Without a device, or if it does not have the entry: index and sub-index only.
[[nodiscard]] LiveEntry live_entry(const Device* device, std::uint16_t index, std::uint8_t sub_index);
/// The entry on which the fields of this one depend: 6061h for those of 6041h. Nothing if they depend on none.
[[nodiscard]] std::optional<LiveEntry> selector_of(const LiveEntry& entry);

/// A data type that replaces that of the EDS, whose access, limits and unit are then ignored.
void set_type(LiveEntry& entry, const canopen::DataTypeRow& type);

/// The value of the node. If the response does not state the size: the size of the data type, and a string without
/// trailing 00h.
[[nodiscard]] SdoOutcome upload(SdoAccess& node, const LiveEntry& entry, SdoTransfer transfer = SdoTransfer::segmented,
                                const SdoProgress& progress = {});

/// The number in the bytes of an integer; nothing for other types.
[[nodiscard]] std::optional<std::int64_t> integer_of(const LiveEntry& entry, std::span<const std::uint8_t> bytes);

/// Whether these bytes were read back. If the response did not state the size, further bytes are ignored.
[[nodiscard]] bool reads_back(const SdoOutcome& outcome, std::span<const std::uint8_t> bytes);

/// `6064h:00 Position actual value`
[[nodiscard]] std::string title(const LiveEntry& entry);

/// `123456 inc`, `3 profile_velocity`, `8611h following error`; of a DOMAIN the first bytes and the length, without a
/// type all bytes.
[[nodiscard]] std::string value_of(const LiveEntry& entry, std::span<const std::uint8_t> bytes);

/// The result of reading or writing an entry (docs/schema/read.schema.json).
[[nodiscard]] nlohmann::ordered_json as_json(const LiveEntry& entry, const SdoOutcome& outcome,
                                             std::span<const std::uint8_t> bytes);

/// Finds a data type by a short name, `u16`, `i32`, `f32`, `string`, or its name in CiA 301. Null if unknown.
[[nodiscard]] const canopen::DataTypeRow* find_type(std::string_view name);

/// Whether the value may be long enough for a block transfer: a DOMAIN.
[[nodiscard]] SdoTransfer best_transfer(const LiveEntry& entry);

}  // namespace edsc
