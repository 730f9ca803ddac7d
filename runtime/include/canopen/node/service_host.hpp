/// The functions of a node that its services call.
#pragma once

#include <cstdint>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/emcy/service_error.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/sync/sync.hpp"

namespace canopen {

/// Base of a node, by which its services refer to it. `NodeType` is the Node.
template <class NodeType, class DeviceOfNode, class HandlerTypes>
class ServiceHost {
 public:
  using Device = DeviceOfNode;
  using Handlers = HandlerTypes;

  [[nodiscard]] NodeType& node() { return static_cast<NodeType&>(*this); }
  [[nodiscard]] const NodeType& node() const { return static_cast<const NodeType&>(*this); }

  [[nodiscard]] TimePoint now() const { return node().now_; }
  [[nodiscard]] NmtState state() const { return node().state_; }
  [[nodiscard]] NodeId node_id() const { return node().node_id_; }
  void set_node_id(NodeId node_id) { node().node_id_ = node_id; }

  [[nodiscard]] auto& store() { return node().store_; }
  [[nodiscard]] const auto& store() const { return node().store_; }
  [[nodiscard]] auto entries() { return node().store_.entries(); }
  [[nodiscard]] auto& bus() { return node().bus_; }

  /// Returns another service, which the device must have.
  template <class Service>
  [[nodiscard]] Service& service() {
    return node().services_.template get<Service>();
  }

  // Transmission

  /// Requests that the node checks soon what is due.
  void attend() { node().attention_ = true; }
  void set_attention(bool attention) { node().attention_ = attention; }
  /// Sends what is due.
  void serve() { node().serve(); }
  /// Whether nothing else is waiting to be sent.
  [[nodiscard]] bool may_send_at_once() const { return !node().attention_ && !node().services_.silent(); }
  void on_sync(Sync sync) { node().services_.on_sync(*this, sync); }

  // NMT

  void enter(NmtState state) { node().enter(state); }
  void reset_communication() { node().reset_communication(); }

  // Values

  /// Asks the services whether these bytes may be written.
  [[nodiscard]] AbortCode check_write(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    return node().services_.check_write(*this, index, sub_index, bytes);
  }
  [[nodiscard]] AbortCode before_read(std::uint16_t index, std::uint8_t sub_index) {
    return node().services_.before_read(*this, index, sub_index);
  }
  [[nodiscard]] AbortCode command(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    return node().services_.command(*this, index, sub_index, bytes);
  }
  /// Notifies the services that an object has been written, with a new or the same value.
  void after_write(std::uint16_t index, std::uint8_t sub_index, bool new_value) {
    node().after_write(index, sub_index, new_value);
  }
  template <DictionaryObject Object>
  void on_new_value() {
    node().template on_new_value<Object>();
  }

  // Handlers of the application

  [[nodiscard]] auto& handlers() { return node().handlers_; }
  [[nodiscard]] const auto& handlers() const { return node().handlers_; }
  [[nodiscard]] auto& handler_calls() { return node().handler_calls_; }
  /// Calls the handlers of an event, a row of node/functions.hpp.
  template <class Event, class... Arguments>
  void notify(const Arguments&... arguments) {
    node().handlers_.template notify<Event>(node(), arguments...);
  }

  // Errors

  /// Reports an error that a service has detected, as an EMCY.
  void report(ServiceError error) { node().emergencies().report(*this, error); }
  /// Ends an error.
  void end(ServiceError error) { node().emergencies().end(*this, error); }
  /// Ends those of these errors that no service has any more.
  void end_if_gone(ServiceErrors errors) { node().emergencies().end_if_gone(*this, errors); }
  /// Returns the errors that any service has.
  [[nodiscard]] ServiceErrors errors() const { return node().services_.errors(); }
};

}  // namespace canopen
