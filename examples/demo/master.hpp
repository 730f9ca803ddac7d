/// A small master on the simulated bus: NMT commands, SDO by object, and PDOs by layout.
#pragma once

#include <canopen/nmt/nmt.hpp>
#include <canopen/sdo/sdo_client.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace demo {

class Master {
 public:
  explicit Master(canopen::VirtualBus& bus);
  Master(const Master&) = delete;
  Master& operator=(const Master&) = delete;

  /// Nodes whose boot-up message was received.
  [[nodiscard]] const std::set<std::uint8_t>& booted() const { return booted_; }

  /// Sends the command to a node; 0: to all nodes.
  void command(canopen::NmtCommand command, canopen::NodeId node = canopen::all_nodes);

  /// Reads a remote object; std::nullopt if the server aborts: `last_abort()` returns the abort code.
  template <canopen::DictionaryObject O>
  [[nodiscard]] std::optional<typename O::type> read(canopen::NodeId node) {
    canopen::SdoClient client{port_, node, timeout};
    client.read<O>(bus_.now());
    run(client);
    return client.value<O>();
  }

  template <canopen::DictionaryObject O>
  bool write(canopen::NodeId node, const typename O::type& value) {
    canopen::SdoClient client{port_, node, timeout};
    client.write<O>(value, bus_.now());
    return run(client) == canopen::ok;
  }

  /// Reads a remote string.
  template <canopen::DictionaryObject O>
  [[nodiscard]] std::string read_text(canopen::NodeId node) {
    return read_text(node, O::index, O::sub_index);
  }

  [[nodiscard]] canopen::AbortCode last_abort() const { return last_abort_; }

  /// Sends the RPDO `number` of a node, on its CAN-ID of the pre-defined connection set.
  template <class Layout>
  void send_rpdo(canopen::NodeId node, unsigned number, const typename Layout::Data& data) {
    send({.id = 0x100u + 0x100u * number + node.value(), .size = Layout::size, .data = data});
  }

  /// Sets the function that is called with each TPDO `number` of a node.
  void on_tpdo(canopen::NodeId node, unsigned number, std::function<void(const canopen::Frame&)> receiver) {
    receivers_[0x80u + 0x100u * number + node.value()] = std::move(receiver);
  }

 private:
  using Client = canopen::SdoClient<canopen::VirtualBus::Endpoint>;
  static constexpr canopen::Duration timeout = std::chrono::milliseconds{100};

  void on_frame(const canopen::Frame& frame, canopen::TimePoint now);
  void send(const canopen::Frame& frame);
  canopen::AbortCode run(Client& client);
  [[nodiscard]] std::string read_text(canopen::NodeId node, std::uint16_t index, std::uint8_t sub_index);

  canopen::VirtualBus& bus_;
  canopen::VirtualBus::Endpoint& port_;
  Client* active_ = nullptr;
  canopen::AbortCode last_abort_ = canopen::ok;
  std::set<std::uint8_t> booted_;
  std::map<std::uint32_t, std::function<void(const canopen::Frame&)>> receivers_;
};

}  // namespace demo
