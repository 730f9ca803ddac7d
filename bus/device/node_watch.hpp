/// Calls for all objects and events of a dynamic node, whose objects are not known when edsc is compiled.
#pragma once

#include <canopen/base/abort_code.hpp>
#include <canopen/nmt/nmt.hpp>
#include <canopen/node/handled.hpp>
#include <cstdint>
#include <span>
#include <type_traits>

#include "device/dynamic_device.hpp"

namespace edsc {

/// `key` is canopen::object_key of the object.
class NodeWatch {
 public:
  /// Before a value that was received by SDO or PDO is stored; another code than `ok` rejects it.
  [[nodiscard]] virtual canopen::AbortCode before_write(std::uint32_t key, std::span<std::uint8_t> bytes) = 0;
  /// After it has been stored.
  virtual void after_write(std::uint32_t key) = 0;
  /// Before an SDO upload.
  [[nodiscard]] virtual canopen::AbortCode before_read(std::uint32_t key) = 0;
  /// The node has entered an NMT state; Initialisation at each reset, after the default values have been set.
  virtual void on_state(canopen::NmtState state) = 0;
  /// After the PDOs of a SYNC.
  virtual void on_sync() = 0;
  /// The node reports an error by EMCY, with this emergency error code.
  virtual void on_error(std::uint16_t code) = 0;

 protected:
  ~NodeWatch() = default;
};

/// The handler of a node for it; null: nothing is called.
struct WatchedBy {
  NodeWatch* watch;

  [[nodiscard]] canopen::AbortCode before_write(std::uint32_t key, std::span<std::uint8_t> bytes) const {
    return watch != nullptr ? watch->before_write(key, bytes) : canopen::ok;
  }
  void after_write(std::uint32_t key) const {
    if (watch != nullptr) watch->after_write(key);
  }
  [[nodiscard]] canopen::AbortCode before_read(std::uint32_t key) const {
    return watch != nullptr ? watch->before_read(key) : canopen::ok;
  }
};

}  // namespace edsc

namespace canopen::handler_detail {

template <>
inline constexpr bool is_handler<edsc::WatchedBy> = true;

template <class Node>
struct Handled<edsc::DynamicDevice, Node, edsc::WatchedBy> : HandlesNothing {
  static constexpr bool takes_any_object = true;
  template <class Event>
  static constexpr bool has_event_function =
      std::is_same_v<Event, function::OnState> || std::is_same_v<Event, function::OnSync> ||
      std::is_same_v<Event, function::OnError>;

  template <class Event, class... Arguments>
  static void notify(edsc::WatchedBy& handler, Node&, const Arguments&... arguments) {
    if (handler.watch == nullptr) return;
    if constexpr (std::is_same_v<Event, function::OnState>) handler.watch->on_state(arguments...);
    if constexpr (std::is_same_v<Event, function::OnSync>) handler.watch->on_sync();
    if constexpr (std::is_same_v<Event, function::OnError>) handler.watch->on_error(arguments...);
  }
};

}  // namespace canopen::handler_detail
