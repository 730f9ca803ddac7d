/// Decodes the frames of a bus with the names in the EDS files of the nodes.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "decode/message.hpp"
#include "decode/node_model.hpp"
#include "decode/sdo_follower.hpp"
#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// A node with a known EDS; its formulas must be resolved for the node-ID.
struct KnownNode {
  std::uint8_t node_id = 0;
  const Device* device = nullptr;
  std::uint32_t inhibit_time_unit = usual_inhibit_time_unit;  ///< of its PDOs, in microseconds
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

  /// The node with the values in force after the frames so far; null if it is not known.
  [[nodiscard]] const NodeModel* find_model(std::uint8_t node_id) const;

  /// `node 5: read of 1008h:00 Manufacturer device name after 7 bytes`, for each unfinished transfer.
  [[nodiscard]] std::vector<std::string> open_transfers() const;

  enum class Use : std::uint8_t { unknown, nmt, sync, time, emcy, error_control, lss, sdo_request, sdo_response, pdo };

 private:
  /// The use of a CAN-ID, by a known node or in the pre-defined connection set.
  struct Route {
    Use use = Use::unknown;
    std::uint8_t node_id = 0;
    std::uint16_t place = 0;  ///< of a PDO in its node; of an SDO in `followers_`
  };

  static constexpr std::size_t node_ids = 128;
  static constexpr std::size_t can_ids = 0x800;

  [[nodiscard]] static Route predefined_route(const canopen::Frame& frame);
  void find_routes();
  void add_route(canopen::CobId cob_id, Route route);
  void add_sdo_server(const NodeModel& model, const SdoServerIds& ids);
  [[nodiscard]] std::span<const Route> routes_of(const canopen::Frame& frame) const;
  [[nodiscard]] NodeModel* model_of(std::uint8_t node_id);

  void decode_error_control(const canopen::Frame& frame, Message& message);
  void decode_pdo(const canopen::Frame& frame, std::span<const Route> routes, Message& message);
  void decode_sdo(const TimedFrame& frame, std::size_t follower, bool request, Message& message);

  std::vector<NodeModel> nodes_;
  std::array<bool, node_ids> guarding_asked_{};  ///< the next error control message is a response
  std::array<std::vector<Route>, can_ids> routes_;
  std::unordered_map<std::uint32_t, std::vector<Route>> extended_routes_;

  struct Follower {
    std::uint8_t node_id = 0;
    SdoFollower sdo;
  };
  std::deque<Follower> followers_;  ///< the default SDO of each node-ID, then the additional servers
  using ServerKey = std::tuple<std::uint8_t, std::uint32_t, std::uint32_t>;  ///< node-ID and COB-IDs
  std::map<ServerKey, std::uint16_t> further_followers_;
};

}  // namespace edsc
