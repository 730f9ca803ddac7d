/// Node-ID and bit rate of a node that is configured by LSS, stored beside its parameters.
#pragma once

#include <array>
#include <canopen/can/node_id.hpp>
#include <canopen/lss/lss_handler.hpp>
#include <canopen/lss/lss_protocol.hpp>
#include <cstdint>
#include <iterator>
#include <string>

#include "surroundings.hpp"

namespace nodes {

/// The port of canopen::configured_by_lss. On a host a node cannot set the bit rate of the bus; it is only logged.
class LssSettings {
 public:
  /// The node-ID is the stored one, else that of the surroundings, else `node_id`.
  LssSettings(Surroundings& around, canopen::NodeId node_id, canopen::LssBitTiming bit_timing)
      : around_{around}, node_id_{around.node_id.value_or(node_id)}, bit_timing_{bit_timing} {
    std::array<std::uint8_t, 3> image{};
    const bool stored = around.lss.open() == canopen::StorageState::whole && around.lss.size() == image.size();
    if (!stored || !around.lss.read(0, image)) return;
    node_id_ = canopen::NodeId{image[0]};
    bit_timing_ = {image[1], image[2]};
  }

  [[nodiscard]] canopen::NodeId node_id() const { return node_id_; }
  [[nodiscard]] canopen::LssBitTiming bit_timing() const { return bit_timing_; }

  [[nodiscard]] canopen::LssError accept(canopen::NodeId node_id) {
    around_.log("LSS: node-ID " + std::to_string(node_id.value()) + " with the next reset communication");
    return canopen::lss::success;
  }
  [[nodiscard]] canopen::LssError accept(canopen::LssBitTiming timing) {
    around_.log("LSS: " + to_text(timing) + " is pending");
    return canopen::lss::success;
  }
  [[nodiscard]] canopen::LssError store(canopen::NodeId node_id, canopen::LssBitTiming timing) {
    const std::array<std::uint8_t, 3> image = {node_id.value(), timing.table, timing.index};
    NodeStorage& to = around_.lss;
    if (!to.begin(image.size()) || !to.write(image) || !to.commit()) {
      around_.log("LSS: the storage has failed");
      return canopen::lss::storage_access_error;
    }
    around_.log("LSS: node-ID " + std::to_string(node_id.value()) + ", " + to_text(timing) + " stored");
    return canopen::lss::success;
  }
  void stop_communication() { around_.log("LSS: silent"); }
  void start_communication(canopen::LssBitTiming timing) { around_.log("LSS: " + to_text(timing)); }

 private:
  [[nodiscard]] static std::string to_text(canopen::LssBitTiming timing) {
    if (timing.table == 0 && timing.index < std::size(canopen::lss::bit_rates)) {
      return std::to_string(canopen::lss::bit_rates[timing.index]) + " kbit/s";
    }
    return "bit rate " + std::to_string(timing.index) + " of table " + std::to_string(timing.table);
  }

  Surroundings& around_;
  canopen::NodeId node_id_;
  canopen::LssBitTiming bit_timing_;
};

}  // namespace nodes
