/// A node that several contexts use, one at a time.
///
///     std::mutex mutex;
///     canopen::Locked pump{node, mutex};
///     pump.on_time(now());                       // the task of the node
///     pump.set(od::pressure{}, 420);             // another task
///     pump.with([](auto& locked) { ... });       // several calls, or those that are not listed here
#pragma once

#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/lock.hpp"
#include "canopen/can/bus_status.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/emcy/error_register.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/node/object_setters.hpp"
#include "canopen/node/value_check.hpp"
#include "canopen/od/object.hpp"

namespace canopen {

/// Holds the lock during each call. Handlers are called with the lock held and get the node itself: they must not use
/// this class, unless the lock may be taken twice. A context that makes the node due, as `set` does, wakes the loop
/// afterwards. With an InterruptLock no interrupt is served during `on_frame` and `on_time`; a Mailbox does not have
/// this delay. The node and the lock must outlive this object.
template <class Node, Lock LockType = NoLock>
class Locked : public ObjectSetters<Locked<Node, LockType>> {
 public:
  using DeviceType = typename Node::DeviceType;

  constexpr explicit Locked(Node& node) requires(std::is_same_v<LockType, NoLock>) : node_{node} {}
  constexpr Locked(Node& node, LockType& lock) : node_{node}, lock_{lock} {}

  /// Calls `use(node)` and returns its result.
  template <class Use>
  decltype(auto) with(Use&& use) {
    const Guard guard{lock_};
    return std::forward<Use>(use)(node_);
  }

  // The same functions as those of Node.

  void start(TimePoint now) {
    with([&](Node& node) { node.start(now); });
  }
  void start(NodeId node_id, TimePoint now) {
    with([&](Node& node) { node.start(node_id, now); });
  }
  void on_frame(const Frame& frame, TimePoint now) {
    with([&](Node& node) { node.on_frame(frame, now); });
  }
  void on_time(TimePoint now) {
    with([&](Node& node) { node.on_time(now); });
  }
  void on_bus_status(const BusStatus& status, TimePoint now) {
    with([&](Node& node) { node.on_bus_status(status, now); });
  }
  [[nodiscard]] std::optional<TimePoint> next_deadline() {
    return with([](Node& node) { return node.next_deadline(); });
  }
  [[nodiscard]] std::optional<TimePoint> next_periodic_call() {
    return with([](Node& node) { return node.next_periodic_call(); });
  }
  [[nodiscard]] NmtState state() {
    return with([](Node& node) { return node.state(); });
  }
  void request(NmtCommand command, TimePoint now) {
    with([&](Node& node) { node.request(command, now); });
  }
  template <DictionaryObject Object>
  [[nodiscard]] typename Object::type get(Object = {}) {
    return with([](Node& node) { return node.template get<Object>(); });
  }
  using ObjectSetters<Locked>::set;
  /// Changes the value of an object while the lock is held, so that no other context changes it.
  template <DictionaryObject Object, class Change>
  requires(!can_be_refused<Object>) AbortCode modify(Object object, Change change) {
    return with([&](Node& node) { return node.modify(object, change); });
  }
  template <DictionaryObject Object, class Change>
  requires(can_be_refused<Object>) [[nodiscard]] AbortCode modify(Object object, Change change) {
    return with([&](Node& node) { return node.modify(object, change); });
  }
  template <std::uint16_t Number, class Layout>
  [[nodiscard]] AbortCode map() {
    return with([](Node& node) { return node.template map<Number, Layout>(); });
  }
  void emergency(EmergencyCode code, ErrorRegister bits) {
    with([&](Node& node) { node.emergency(code, bits); });
  }
  void emergency_over(ErrorRegister bits) {
    with([&](Node& node) { node.emergency_over(bits); });
  }

 private:
  friend ObjectSetters<Locked>;

  template <DictionaryObject Object>
  [[nodiscard]] AbortCode assign(const typename Object::type& value) {
    return with([&](Node& node) { return node.template set<Object>(value); });
  }

  using LockMember = std::conditional_t<std::is_empty_v<LockType>, LockType, LockType&>;

  struct Guard {
    explicit constexpr Guard(LockMember& held) : lock{held} { lock.lock(); }
    ~Guard() { lock.unlock(); }
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;
    std::remove_reference_t<LockMember>& lock;
  };

  Node& node_;
  [[no_unique_address]] LockMember lock_{};
};

template <class Node>
Locked(Node&) -> Locked<Node, NoLock>;
template <class Node, Lock LockType>
Locked(Node&, LockType&) -> Locked<Node, LockType>;

/// For a port that filters frames: the frames of the node (accepted_frames.hpp), read while the lock is held.
template <class Node, class LockType, class Visit>
void for_each_accepted_frame(Locked<Node, LockType>& locked, Visit&& visit) {
  locked.with([&](Node& node) { for_each_accepted_frame(node, visit); });
}

}  // namespace canopen
