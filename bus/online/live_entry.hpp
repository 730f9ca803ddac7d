/// An entry of a live node: what is known of it, its value as text and as JSON.
#pragma once

#include <canopen/data_type.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "device/device.hpp"
#include "online/sdo_access.hpp"

namespace edsc {

/// One entry, with its data sheet or without.
struct LiveEntry {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  const Entry* entry = nullptr;                ///< null without data sheet
  const canopen::DataTypeRow* type = nullptr;  ///< null: raw bytes
  std::string name;                            ///< `Identity object, Vendor-ID`; empty without data sheet
};

[[nodiscard]] LiveEntry live_entry(const Object& object, const Entry& entry);

/// A type in place of the data sheet's, whose access, limits and unit do not count then.
void set_type(LiveEntry& entry, const canopen::DataTypeRow& type);

/// What the node has there. Where its answer tells no size, as many bytes as the type has, and a string without the 00h
/// behind it.
[[nodiscard]] SdoOutcome upload(SdoAccess& node, const LiveEntry& entry,
                                SdoTransfer transfer = SdoTransfer::segmented, const SdoProgress& progress = {});

/// Whether these bytes were read back. Where the answer told no size, those behind them do not count.
[[nodiscard]] bool reads_back(const SdoOutcome& outcome, std::span<const std::uint8_t> bytes);

/// `6064h:00 Position actual value`
[[nodiscard]] std::string title(const LiveEntry& entry);

/// `123456 inc`; of a DOMAIN the first bytes and how many there are, without a type all bytes.
[[nodiscard]] std::string value_of(const LiveEntry& entry, std::span<const std::uint8_t> bytes);

/// `40 E2 01 00`
[[nodiscard]] std::string hex_bytes(std::span<const std::uint8_t> bytes);

/// What came of reading or writing it (docs/schema/read.schema.json).
[[nodiscard]] nlohmann::ordered_json as_json(const LiveEntry& entry, const SdoOutcome& outcome,
                                             std::span<const std::uint8_t> bytes);

/// Data types by the names that people use: `u16`, `i32`, `f32`, `string`, and those of CiA 301. Null when it is none.
[[nodiscard]] const canopen::DataTypeRow* find_type(std::string_view name);

/// Whether the value may be long enough for a block transfer: that of a DOMAIN.
[[nodiscard]] SdoTransfer best_transfer(const LiveEntry& entry);

}  // namespace edsc
