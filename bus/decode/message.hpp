/// The meaning of a frame: its service and contents, for people and for programs.
#pragma once

#include <canopen/can/frame.hpp>
#include <canopen/nmt/nmt.hpp>
#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/device.hpp"

namespace edsc {

enum class Service : std::uint8_t {
  nmt,
  sync,
  time,
  emcy,
  boot_up,
  heartbeat,
  guarding,
  lss,
  tpdo,
  rpdo,
  sdo,
  error_frame,
  unknown,
};

struct ServiceRow {
  Service service;
  std::string_view name;   ///< in JSON and in filters
  std::string_view label;  ///< in text
};

inline constexpr ServiceRow services[] = {
    {Service::nmt, "nmt", "NMT"},
    {Service::sync, "sync", "SYNC"},
    {Service::time, "time", "TIME"},
    {Service::emcy, "emcy", "EMCY"},
    {Service::boot_up, "boot_up", "BOOT-UP"},
    {Service::heartbeat, "heartbeat", "HEART"},
    {Service::guarding, "guarding", "GUARD"},
    {Service::lss, "lss", "LSS"},
    {Service::tpdo, "tpdo", "TPDO"},
    {Service::rpdo, "rpdo", "RPDO"},
    {Service::sdo, "sdo", "SDO"},
    {Service::error_frame, "error_frame", "ERROR"},
    {Service::unknown, "unknown", "?"},
};

inline constexpr std::size_t service_count = std::size(services);

[[nodiscard]] constexpr const ServiceRow& row_of(Service service) {
  return services[static_cast<std::size_t>(service)];
}

struct WordText;

/// The value of an object in a PDO or a finished SDO transfer.
struct MessageValue {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::string_view name;                       ///< empty if the object is in no known EDS
  const canopen::DataTypeRow* type = nullptr;  ///< null if unknown
  const Meaning* meaning = nullptr;            ///< of an integer of the length of its type; null without one
  const Quantity* quantity = nullptr;          ///< of a number of the length of its type; null without one
  std::optional<std::int64_t> other;           ///< the value of the object on which fields depend, if known
  WordText* word = nullptr;                    ///< of a word with fields in a PDO, until the next frame
  std::uint64_t number = 0;                    ///< of a PDO: the bits
  std::uint8_t bits = 0;                       ///< of a PDO: their number; 0 if `bytes` holds the value
  std::span<const std::uint8_t> bytes;         ///< of an SDO, until the next frame
  std::size_t text_begin = 0;                  ///< position of the value in the text of the message
  std::size_t text_end = 0;
};

/// A violation of the SDO protocol (CiA 301, 7.2.4.3).
enum class SdoFault : std::uint8_t {
  none,
  length,       ///< not 8 bytes, or a remote frame
  command,      ///< unknown, or does not fit the transfer in progress
  unrequested,  ///< a response without a request
  unfinished,   ///< a new request before the end of the transfer
  toggle,       ///< wrong toggle bit of a segment, its request or its confirmation
  sequence,     ///< wrong sequence number in a block transfer
  size,         ///< other number of bytes than announced
  crc,          ///< wrong CRC of a block transfer
};

/// The progress of an SDO transfer.
enum class TransferStep : std::uint8_t { none, part, finished, aborted };

struct PdoLayout;

struct Message {
  Service service = Service::unknown;
  std::uint8_t node_id = 0;        ///< 0: none, or all
  std::uint8_t values_node = 0;    ///< of a multiplex PDO: the node with the object; 0: `node_id`
  std::uint16_t number = 0;        ///< of a PDO
  const PdoLayout* pdo = nullptr;  ///< the layout in force of a PDO, until the next frame
  std::uint8_t other_sender = 0;   ///< a second node whose TPDO has this CAN-ID; 0: none
  bool from_client = false;        ///< SDO, LSS: to the server or slave
  bool problem = false;            ///< an error or anomaly
  std::string text;
  std::vector<MessageValue> values;

  std::optional<canopen::NmtCommand> command;  ///< of NMT
  std::optional<canopen::NmtState> state;      ///< of boot-up, heartbeat, guarding
  std::uint16_t error_code = 0;                ///< of EMCY
  std::uint8_t error_register = 0;             ///< of EMCY
  std::string_view error_text;                 ///< of EMCY: the name of its code
  std::int16_t counter = -1;                   ///< of SYNC, if present

  TransferStep step = TransferStep::none;
  bool download = false;
  std::uint16_t index = 0;  ///< of an SDO transfer
  std::uint8_t sub_index = 0;
  std::uint32_t size = 0;         ///< bytes so far
  std::int64_t duration_us = -1;  ///< of a finished transfer, if the log has time stamps
  std::uint32_t abort_code = 0;
  std::uint16_t channel = 0;  ///< of SDO: the node-ID for its default SDO; larger numbers for additional servers
  SdoFault fault = SdoFault::none;

  /// Resets to the initial state, but keeps the memory of its texts.
  void clear() {
    Message initial;
    initial.text.swap(text);
    initial.values.swap(values);
    *this = std::move(initial);
    text.clear();
    values.clear();
  }
};

/// Whether the node of a message is its sender.
[[nodiscard]] inline bool is_from_node(const Message& message) {
  switch (message.service) {
    case Service::boot_up:
    case Service::heartbeat:
    case Service::guarding: return message.state.has_value();
    case Service::emcy:
    case Service::tpdo: return true;
    case Service::sdo: return !message.from_client;
    default: return false;
  }
}

/// A frame and its time.
struct TimedFrame {
  canopen::Frame frame;
  bool has_time = false;
  std::int64_t microseconds = 0;
};

}  // namespace edsc
