/// A node whose EDS is loaded at run time, with the protocol services of the runtime.
#pragma once

#include <canopen/can/bus_status.hpp>
#include <canopen/can/node_id.hpp>
#include <canopen/emcy/error_register.hpp>
#include <canopen/nmt/nmt.hpp>
#include <canopen_sim/simulated_node.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/node_watch.hpp"
#include "device/sheet.hpp"

namespace edsc {

class DynamicNode : public canopen::SimulatedNode {
 public:
  /// Returns the bytes of a value as in SDO; nothing if the device does not have the entry.
  [[nodiscard]] virtual std::optional<std::vector<std::uint8_t>> get(std::uint16_t index, std::uint8_t sub_index) = 0;
  /// Executes an NMT command by local control: Node::request.
  virtual void request(canopen::NmtCommand command, canopen::TimePoint now) = 0;
  /// The state of the CAN controller has changed: Node::on_bus_status.
  virtual void on_bus_status(const canopen::BusStatus& status, canopen::TimePoint now) = 0;
  [[nodiscard]] virtual canopen::NodeId node_id() const = 0;
  /// Sets bits of 1001h for an error that the node has reported: Node::hold_error.
  virtual void hold_error(canopen::ErrorRegister bits) = 0;
};

/// Makes a node with this sheet, which it keeps. LSS uses `memory`, and so do the stored values of 1010h, unless `file`
/// names a file for them. Bus and memory must outlive the node, and so must `watch`, if there is one. A DOMAIN has
/// memory for 1024 bytes, of which 16 are its value if it can be read.
[[nodiscard]] std::unique_ptr<DynamicNode> make_dynamic_node(std::shared_ptr<const Sheet> sheet,
                                                             canopen::SimulatedBus& bus,
                                                             canopen::SimulatedMemory& memory,
                                                             const std::string& file = {}, NodeWatch* watch = nullptr);

}  // namespace edsc
