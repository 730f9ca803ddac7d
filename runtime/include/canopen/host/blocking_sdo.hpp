/// Blocking SDO client for programs on a host:
///
///     canopen::SocketCan bus{"can0"};
///     canopen::BlockingSdo master{bus};
///     auto drive = master.remote<cpc_tc1::Device>(canopen::NodeId{5});
///     const auto mode = drive.read<od::modes_of_operation_display>();
///     if (const auto done = drive.write<od::profile_velocity>(4'000); !done) log(to_text(done.abort_code()));
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/result.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/od/value_bits.hpp"
#include "canopen/sdo/remote_node.hpp"
#include "canopen/sdo/sdo_client.hpp"
#include "canopen/sdo/sdo_queue.hpp"

namespace canopen {

/// A bus with a blocking `receive`: SocketCan, VirtualBusPort.
template <class Type>
concept BlockingBus = Bus<Type> && requires(Type& bus, Duration timeout) {
  { bus.receive(timeout) } -> std::same_as<std::optional<Frame>>;
  { bus.now() } -> std::same_as<TimePoint>;
};

template <class Device, BlockingBus BusType>
class BlockingRemoteNode;

/// Returns the value of a number, or why its bytes are not one: 0607 0010h if there are more or fewer. A server need
/// not indicate how many of the four bytes of an expedited response are valid.
template <NumberObject Object>
[[nodiscard]] Result<typename Object::type> number_from(const SdoAnswer& answer) {
  if (answer.result != ok) return answer.result;
  constexpr std::size_t size = (Object::bits + 7u) / 8u;
  const std::size_t received = answer.data.size();
  if (received != size && (answer.size_known || received < size)) return AbortCode::length_mismatch;
  std::array<std::uint8_t, 8> bytes{};
  std::memcpy(bytes.data(), answer.data.data(), size);
  return value_detail::value_from<Object>(std::span{bytes}.first(size));
}

/// Returns a string of a device from its bytes, or why it is not one: 0607 0012h if it is longer than in the EDS.
template <StringObject Object, class Device>
[[nodiscard]] Result<typename Object::type> text_from(const Result<std::vector<std::uint8_t>>& bytes) {
  if (!bytes) return bytes.abort_code();
  typename Object::type text{};
  std::size_t size = bytes->size();
  constexpr bool terminated =
      Device::dictionary.zero_terminated_strings && std::is_convertible_v<decltype(text.view()), std::string_view>;
  if (terminated && size != 0 && bytes->back() == 0) --size;
  if (size > text.capacity()) return AbortCode::length_too_high;
  std::copy_n(bytes->begin(), size, text.bytes.begin());
  text.size = static_cast<std::uint16_t>(size);
  return text;
}

/// Access to the objects of a device by their generated types, which is also the base of the devices of a master, with
/// an `Sdo` that has
///   read_number(NodeId, index, sub_index, memory) -> SdoAnswer
///   upload(NodeId, index, sub_index) -> Result<std::vector<std::uint8_t>>
///   download(NodeId, index, sub_index, bytes) -> Result<void>
/// What does not compile for a RemoteNode does not compile here.
template <class Device, class Sdo>
class BlockingObjects {
 public:
  BlockingObjects(Sdo& sdo, NodeId node) : sdo_{sdo}, node_{node} {}

  [[nodiscard]] NodeId node_id() const { return node_; }

  /// Reads a number: `read<od::x>()` or `read(od::x{})`.
  template <NumberObject Object>
  [[nodiscard]] Result<typename Object::type> read(Object = {}) {
    if constexpr (remote_detail::can_be_read<Object, Device>()) {
      std::array<std::uint8_t, 8> memory{};
      return number_from<Object>(sdo_.read_number(node_, Object::index, Object::sub_index, memory));
    }
    return AbortCode::general;
  }

  /// Reads a string. 0607 0012h: it is longer than in the EDS.
  template <StringObject Object>
  [[nodiscard]] Result<typename Object::type> read(Object = {}) {
    if constexpr (remote_detail::can_be_read<Object, Device>())
      return text_from<Object, Device>(sdo_.upload(node_, Object::index, Object::sub_index));
    return AbortCode::general;
  }

  /// Reads the bytes of a DOMAIN.
  template <DomainObject Object>
  [[nodiscard]] Result<std::vector<std::uint8_t>> read(Object = {}) {
    if constexpr (remote_detail::can_be_read<Object, Device>())
      return sdo_.upload(node_, Object::index, Object::sub_index);
    return AbortCode::general;
  }

  /// Writes a number, a string or a DOMAIN: `write<od::x>(value)` or `write(od::x{}, value)`. A value outside the
  /// limits is rejected without sending a frame; 0607 0012h: a string is longer than the capacity of the object.
  template <DictionaryObject Object, class ValueType>
  requires remote_detail::WrittenTo<std::decay_t<const ValueType&>, Object, Device>
  [[nodiscard]] Result<void> write(const ValueType& value) {
    if constexpr (NumberObject<Object>) {
      if (const AbortCode code = remote_detail::check<Object>(value); code != ok) return code;
      return write_number<Object>(remote_detail::converted<Object>(value));
    } else if constexpr (std::convertible_to<const ValueType&, std::string_view>) {
      const std::string_view text = value;
      return write_bytes<Object>(std::span{reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    } else {
      return write_bytes<Object>(value);
    }
  }
  template <DictionaryObject Object, class ValueType>
  requires remote_detail::WrittenTo<std::decay_t<const ValueType&>, Object, Device>
  [[nodiscard]] Result<void> write(Object, const ValueType& value) { return write<Object>(value); }
  /// Writes a constant with a unit.
  template <NumberObject Object>
  requires(Meaningful<typename Object::type>&& remote_detail::WrittenTo<typename Object::type, Object, Device>)
      [[nodiscard]] Result<void> write(std::type_identity_t<ConstantOf<Object>> constant) {
    return write_number<Object>(constant.value());
  }
  template <NumberObject Object>
  requires(Meaningful<typename Object::type>&& remote_detail::WrittenTo<typename Object::type, Object, Device>)
      [[nodiscard]] Result<void> write(Object, std::type_identity_t<ConstantOf<Object>> constant) {
    return write_number<Object>(constant.value());
  }
  /// What does not compile.
  template <DictionaryObject Object, class ValueType>
  requires remote_detail::NeverWritten<std::decay_t<const ValueType&>, Object, Device> remote_detail::NotWritten write(
      const ValueType&) {
    static_cast<void>(remote_detail::can_be_written<Object, Device, std::decay_t<const ValueType&>>());
    return {};
  }
  template <DictionaryObject Object, class ValueType>
  requires remote_detail::NeverWritten<std::decay_t<const ValueType&>, Object, Device> remote_detail::NotWritten write(
      Object, const ValueType&) {
    static_cast<void>(remote_detail::can_be_written<Object, Device, std::decay_t<const ValueType&>>());
    return {};
  }
  template <DictionaryObject Object>
  requires(StringObject<Object> || DomainObject<Object>)
      [[nodiscard]] Result<void> write(std::initializer_list<std::uint8_t> bytes) {
    return write<Object>(std::span{bytes.begin(), bytes.size()});
  }

  /// Writes a constant, whose limits the compiler checks.
  template <NumberObject Object, auto Value>
  [[nodiscard]] Result<void> write() {
    if constexpr (remote_detail::can_be_written_with<Object, Device, Value>())
      return write_number<Object>(static_cast<typename Object::type>(Value));
    return AbortCode::general;
  }

 protected:
  [[nodiscard]] Sdo& sdo() const { return sdo_; }

 private:
  template <class Object>
  [[nodiscard]] Result<void> write_bytes(std::span<const std::uint8_t> bytes) {
    if constexpr (StringObject<Object>) {
      if (bytes.size() > Object::type::capacity()) return AbortCode::length_too_high;
    }
    return sdo_.download(node_, Object::index, Object::sub_index, bytes);
  }
  template <class Object>
  [[nodiscard]] Result<void> write_number(typename Object::type value) {
    const std::uint64_t raw = value_detail::to_bits(value);
    std::array<std::uint8_t, sizeof raw> bytes{};
    std::memcpy(bytes.data(), &raw, sizeof raw);
    return sdo_.download(node_, Object::index, Object::sub_index, std::span{bytes}.first((Object::bits + 7u) / 8u));
  }

  Sdo& sdo_;
  NodeId node_;
};

/// Transfers by index and sub-index. Exceptions of the bus's `receive` are passed on. A transfer ends even on a bus
/// that does not accept frames: with 0504 0000h after the timeout.
template <BlockingBus BusType>
class BlockingSdo {
 public:
  static constexpr std::size_t longest_upload = 16 * 1024 * 1024;

  explicit BlockingSdo(BusType& can_bus, SdoClientOptions options = {}) : bus_{can_bus}, options_{options} {}

  /// Called with every frame that is received during a transfer: heartbeats, PDOs, EMCYs. A transfer to the same node
  /// that it starts is rejected with 060A 0023h.
  std::function<void(const Frame&, TimePoint now)> on_frame;

  /// Reads an entry. 0504 0005h: it is longer than `most` bytes.
  [[nodiscard]] Result<std::vector<std::uint8_t>> upload(NodeId node, std::uint16_t index, std::uint8_t sub_index,
                                                         std::size_t most = longest_upload) {
    std::vector<std::uint8_t> value;
    auto take = [&](std::uint32_t /*offset*/, std::span<const std::uint8_t> bytes, bool /*last*/) {
      if (bytes.size() > most - value.size()) return AbortCode::out_of_memory;
      value.insert(value.end(), bytes.begin(), bytes.end());
      return ok;
    };
    const Use use{*this, node};
    if (!use.granted) return AbortCode::no_resource;
    SdoClient<BusType>& client = client_of(node);
    if (!client.upload(index, sub_index, sink_of(take), bus_.now())) return AbortCode::no_resource;
    if (const AbortCode code = run(client); code != ok) return code;
    return value;
  }

  Result<void> download(NodeId node, std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes) {
    const Use use{*this, node};
    if (!use.granted) return AbortCode::no_resource;
    SdoClient<BusType>& client = client_of(node);
    if (!client.download(index, sub_index, bytes, bus_.now())) return AbortCode::no_resource;
    return run(client);
  }

  /// Reads an entry of up to eight bytes.
  [[nodiscard]] SdoAnswer read_number(NodeId node, std::uint16_t index, std::uint8_t sub_index,
                                      std::span<std::uint8_t> memory) {
    const Use use{*this, node};
    if (!use.granted) return {AbortCode::no_resource, {}};
    SdoClient<BusType>& client = client_of(node);
    if (!client.upload(index, sub_index, memory, bus_.now())) return {AbortCode::no_resource, {}};
    const AbortCode result = run(client);
    return {result, client.data(), client.size_known()};
  }

  /// Returns a node with the types of its device. It must not outlive this object.
  template <class Device>
  [[nodiscard]] BlockingRemoteNode<Device, BusType> remote(NodeId node) {
    return {*this, node};
  }

  /// Waits until a transfer has ended. `client` is an SdoClient or RemoteNode on this bus.
  template <class Client>
  AbortCode run(Client& client) {
    constexpr Duration try_again{1'000};  // the bus had no room for a frame
    while (!early_.empty()) {
      const Frame frame = early_.front();
      early_.pop_front();
      if (on_frame) on_frame(frame, bus_.now());
    }
    while (client.busy()) {
      const TimePoint present = bus_.now();
      const std::optional<TimePoint> deadline = client.next_deadline();
      const Duration wait = deadline && *deadline > present ? *deadline - present : try_again;
      if (const std::optional<Frame> frame = bus_.receive(wait)) {
        if (!take(*frame, &client)) client.on_frame(*frame, bus_.now());
        if (on_frame) on_frame(*frame, bus_.now());
      }
      client.on_time(bus_.now());
    }
    if constexpr (std::same_as<decltype(client.result()), AbortCode>) {
      return client.result();
    } else {
      return client.result().abort_code();
    }
  }

  [[nodiscard]] BusType& bus() { return bus_; }
  [[nodiscard]] const SdoClientOptions& options() const { return options_; }

 private:
  /// Reserves a node for one call until it has its result: `on_frame` may see the frame that ends the transfer before
  /// that. Discards a client whose transfer is not complete when the bus throws: its memory no longer exists.
  struct Use {
    Use(BlockingSdo& blocking_sdo, NodeId node_id)
        : sdo{blocking_sdo}, node{node_id.value()}, granted{sdo.in_use_.insert(node).second} {}
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    ~Use() {
      if (!granted) return;
      sdo.in_use_.erase(node);
      const auto found = sdo.clients_.find(node);
      if (found != sdo.clients_.end() && found->second.busy()) sdo.clients_.erase(found);
    }

    BlockingSdo& sdo;
    std::uint8_t node;
    bool granted;
  };

  /// Returns the client of a node, which is kept because it knows which responses of earlier transfers may still
  /// arrive. Those that have arrived are processed first, so that they are not taken for the response to the
  /// next request.
  [[nodiscard]] SdoClient<BusType>& client_of(NodeId node) {
    SdoClient<BusType>& client = clients_.try_emplace(node.value(), bus_, node, options_).first->second;
    constexpr unsigned at_most = 1'000;  // the bus may receive frames continuously
    for (unsigned i = 0; i != at_most; ++i) {
      const std::optional<Frame> frame = bus_.receive(Duration{0});
      if (!frame) break;
      (void)take(*frame, nullptr);
      early_.push_back(*frame);
    }
    return client;
  }

  /// Passes a frame to the clients of all nodes, because a transfer that `on_frame` has started may run inside another
  /// one. Returns whether `client` is one of them.
  bool take(const Frame& frame, const void* client) {
    bool is_one_of_them = false;
    for (auto& [node, one] : clients_) {
      one.on_frame(frame, bus_.now());
      is_one_of_them = is_one_of_them || &one == client;
    }
    return is_one_of_them;
  }

  BusType& bus_;
  SdoClientOptions options_;
  std::map<std::uint8_t, SdoClient<BusType>> clients_;
  std::set<std::uint8_t> in_use_;  ///< node-IDs
  std::deque<Frame> early_;        ///< received before the request was sent; not yet passed to `on_frame`
};

/// A device on the bus, with its generated types.
template <class Device, BlockingBus BusType>
class BlockingRemoteNode : public BlockingObjects<Device, BlockingSdo<BusType>> {
 public:
  using BlockingObjects<Device, BlockingSdo<BusType>>::BlockingObjects;
};

}  // namespace canopen
