/// What a network file allows on its bus: frames with their length and rate, and values that the master writes.
#pragma once

#include <canopen/can/frame.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "network/cob_id_use.hpp"
#include "network/network.hpp"

namespace edsc::watch {

/// The frames of a CAN-ID. Times of 0 do not apply.
struct AllowedFrame {
  const NetworkNode* node = nullptr;  ///< the sender; of an SDO the server
  FrameService service = FrameService::pdo;
  SdoFrames sdo = SdoFrames::none;
  std::string name;  ///< `axis TPDO 2`
  std::uint8_t min_bytes = 0, max_bytes = 8;
  bool is_requested = false;      ///< it is sent after a remote frame
  std::uint32_t sync_cycles = 0;  ///< of a TPDO that is sent after every n-th SYNC
  std::int64_t inhibit_us = 0;
  std::int64_t period_us = 0;   ///< shortest mean distance
  std::int64_t longest_us = 0;  ///< longest distance
};

/// Times of a node. Times of 0 do not apply.
struct NodeTimes {
  std::int64_t heartbeat_us = 0;
  std::int64_t timeout_us = 0;  ///< without a heartbeat or a response to guarding
};

class AllowedTraffic {
 public:
  /// The network must outlive this.
  explicit AllowedTraffic(const Network& network);

  [[nodiscard]] const Network& network() const { return *network_; }
  [[nodiscard]] const std::vector<AllowedFrame>& frames() const { return frames_; }
  /// The place in `frames()` of the frames of this CAN-ID; empty if no node sends them.
  [[nodiscard]] std::optional<std::size_t> find(const canopen::Frame& frame) const;
  /// `digital_outputs RPDO 1`: who receives frames that no node sends; empty if no node does.
  [[nodiscard]] std::string receiver_of(const canopen::Frame& frame) const;
  [[nodiscard]] NodeTimes times_of(const NetworkNode& node) const;

  /// Whether the configuration of the node has the entry, so that a master writes it.
  [[nodiscard]] static bool is_configured(const NetworkNode& node, std::uint16_t index, std::uint8_t sub_index);
  /// The value of an entry of the configuration, low byte first; empty if it is not known.
  [[nodiscard]] static std::string configured_value(const NetworkNode& node, std::uint16_t index,
                                                    std::uint8_t sub_index);

 private:
  void add(const CobIdUse& use, const std::vector<CobIdUse>& uses);
  void add_pdo(const CobIdUse& use, const std::vector<CobIdUse>& uses, AllowedFrame& frame) const;

  const Network* network_;
  std::vector<AllowedFrame> frames_;
  std::unordered_map<std::uint32_t, std::size_t> places_;    ///< by COB-ID
  std::unordered_map<std::uint32_t, std::string> received_;  ///< by COB-ID: of RPDOs and others without a sender
};

/// `6040h:00 Controlword`; without a name if the EDS does not have the entry.
[[nodiscard]] std::string entry_name(const NetworkNode& node, std::uint16_t index, std::uint8_t sub_index);

}  // namespace edsc::watch
