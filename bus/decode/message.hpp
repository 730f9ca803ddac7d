/// What a frame says: the service that it belongs to, and what that tells, for people and for programs.
#pragma once

#include <canopen/data_type.hpp>
#include <canopen/frame.hpp>
#include <cstdint>
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

/// The value of an object that a PDO or a finished SDO transfer carries.
struct MessageValue {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::string_view name;                       ///< empty where no data sheet knows the object
  const canopen::DataTypeRow* type = nullptr;  ///< null where it is not known
  std::string_view unit;
  std::uint64_t number = 0;             ///< of a PDO: the bits
  std::uint8_t bits = 0;                ///< of a PDO: how many; 0 where `bytes` holds the value
  std::span<const std::uint8_t> bytes;  ///< of an SDO, until the next frame
  std::size_t text_begin = 0;           ///< where the value stands in the message's text
  std::size_t text_end = 0;
};

/// How far an SDO transfer is.
enum class TransferStep : std::uint8_t { none, part, finished, aborted };

struct Message {
  Service service = Service::unknown;
  std::uint8_t node_id = 0;  ///< 0: none, or all
  std::uint16_t number = 0;  ///< of a PDO
  bool from_client = false;  ///< SDO, LSS: to the server or slave
  bool problem = false;      ///< an error, or something that should not be
  std::string text;
  std::vector<MessageValue> values;

  std::string_view command;         ///< of NMT
  std::string_view state;           ///< of boot-up, heartbeat, guarding
  std::uint16_t error_code = 0;     ///< of EMCY
  std::uint8_t error_register = 0;  ///< of EMCY
  std::int16_t counter = -1;        ///< of SYNC, if it has one

  TransferStep step = TransferStep::none;
  bool download = false;
  std::uint16_t index = 0;  ///< of an SDO transfer
  std::uint8_t sub_index = 0;
  std::uint32_t size = 0;         ///< bytes so far
  std::int64_t duration_us = -1;  ///< of a transfer that has ended, where the log has times
  std::uint32_t abort_code = 0;

  /// As it was made, but for the memory that its texts have taken.
  void clear() {
    std::string kept_text = std::move(text);
    std::vector<MessageValue> kept_values = std::move(values);
    *this = Message{};
    kept_text.clear();
    kept_values.clear();
    text = std::move(kept_text);
    values = std::move(kept_values);
  }
};

/// A frame, and when it was seen.
struct TimedFrame {
  canopen::Frame frame;
  bool has_time = false;
  std::int64_t microseconds = 0;
};

}  // namespace edsc
