/// Decodes the frames of a bus with the names in the EDS files of the nodes.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "decode/message.hpp"
#include "decode/node_model.hpp"
#include "decode/sdo_follower.hpp"
#include "device/device.hpp"

namespace edsc {

/// A node with a known EDS; its formulas must be resolved for the node-ID.
struct KnownNode {
  std::uint8_t node_id = 0;
  const Device* device = nullptr;
};

/// Decodes frames in the order of the bus, with memory that does not grow with their number. NMT, SYNC, TIME, EMCY,
/// error control, LSS and default SDOs are decoded for all nodes; PDOs, additional SDO servers and names for known
/// nodes.
class Decoder {
 public:
  /// The devices must outlive the decoder. Of two with the same node-ID, the last is used.
  explicit Decoder(const std::vector<KnownNode>& nodes);

  /// Clears the message and fills it; its values are valid until the next call.
  void decode(const TimedFrame& frame, Message& message);
  void decode_error_frame(const canopen::Frame& frame, Message& message);

  /// `node 5: read of 1008h:00 Manufacturer device name after 7 bytes`, for each unfinished transfer.
  [[nodiscard]] std::vector<std::string> open_transfers() const;

 private:
  enum class Use : std::uint8_t { none, sync, time, emcy, sdo_request, sdo_response, pdo };

  /// The use of a CAN-ID by a known node.
  struct Route {
    Use use = Use::none;
    std::uint8_t node = 0;    ///< in `nodes_`
    std::uint16_t place = 0;  ///< of a PDO in its node; of an SDO in `followers_`
  };

  static constexpr std::size_t node_ids = 128;
  static constexpr std::size_t can_ids = 0x800;

  void find_routes();
  void add_route(canopen::CobId cob_id, Route route);
  [[nodiscard]] const std::vector<Route>* routes_of(const canopen::Frame& frame) const;
  [[nodiscard]] NodeModel* model_of(std::uint8_t node_id);

  void decode_routed(const TimedFrame& frame, const std::vector<Route>& routes, Message& message);
  void decode_predefined(const TimedFrame& frame, Message& message);
  void decode_nmt(const canopen::Frame& frame, Message& message);
  void decode_sync(const canopen::Frame& frame, Message& message);
  void decode_time(const canopen::Frame& frame, Message& message);
  void decode_emcy(const canopen::Frame& frame, std::uint8_t node_id, Message& message);
  void decode_error_control(const canopen::Frame& frame, Message& message);
  void decode_lss(const canopen::Frame& frame, Message& message);
  void decode_pdo(const canopen::Frame& frame, const std::vector<Route>& routes, Message& message);
  void decode_mpdo(const canopen::Frame& frame, const NodeModel& node, Message& message);
  void decode_sdo(const TimedFrame& frame, std::size_t follower, bool request, Message& message);
  void decode_unknown(const canopen::Frame& frame, Message& message) const;

  std::vector<NodeModel> nodes_;
  std::array<std::uint8_t, node_ids> place_of_node_{};  ///< by node-ID: in `nodes_`, from 1
  std::array<bool, node_ids> guarding_asked_{};         ///< the next error control message is a response
  std::array<std::vector<Route>, can_ids> routes_;
  std::unordered_map<std::uint32_t, std::vector<Route>> extended_routes_;

  /// The default SDO of each node-ID, then the additional servers.
  struct Follower {
    std::uint8_t node_id = 0;
    SdoFollower sdo;
  };
  std::deque<Follower> followers_;
  std::unordered_map<std::uint64_t, std::size_t> further_followers_;  ///< by node and CAN-IDs
};

}  // namespace edsc
