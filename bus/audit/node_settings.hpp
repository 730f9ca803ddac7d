/// The values of a node in force that decide when it sends frames.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "decode/node_model.hpp"

namespace edsc::audit {

struct TpdoSettings {
  bool is_sent = false;  ///< its COB-ID is valid and it maps something
  std::uint8_t transmission_type = 255;
  std::int64_t inhibit_us = 0;
  std::int64_t event_us = 0;
  friend bool operator==(const TpdoSettings&, const TpdoSettings&) = default;

  [[nodiscard]] bool is_event_driven() const { return transmission_type >= 254; }
  [[nodiscard]] bool is_cyclic() const { return transmission_type >= 1 && transmission_type <= 240; }
  [[nodiscard]] bool is_synchronous() const { return transmission_type <= 240; }
  [[nodiscard]] bool is_requested() const { return transmission_type == 252 || transmission_type == 253; }
};

/// An entry of 1016h.
struct ConsumedHeartbeat {
  std::uint8_t sub_index = 0;
  std::uint8_t producer = 0;
  std::int64_t us = 0;
  friend bool operator==(const ConsumedHeartbeat&, const ConsumedHeartbeat&) = default;
};

/// Times of 0 are not used by the node, or not known.
struct NodeSettings {
  std::int64_t heartbeat_us = 0;
  std::vector<ConsumedHeartbeat> consumed;
  std::uint32_t sync_id = 0;  ///< with bit 29 for an extended CAN-ID; bit 31: not used
  bool is_sync_producer = false;
  std::int64_t sync_period_us = 0;
  std::int64_t sync_window_us = 0;
  std::optional<std::uint8_t> sync_overflow;  ///< empty if 1019h is missing
  std::uint32_t emcy_id = 0;                  ///< as sync_id
  std::int64_t emcy_inhibit_us = 0;
  bool starts_itself = false;       ///< 1F80h
  bool is_nmt_master = false;       ///< 1F80h
  std::vector<TpdoSettings> tpdos;  ///< by number - 1
  friend bool operator==(const NodeSettings&, const NodeSettings&) = default;
};

[[nodiscard]] NodeSettings settings_of(const NodeModel& model);

}  // namespace edsc::audit
