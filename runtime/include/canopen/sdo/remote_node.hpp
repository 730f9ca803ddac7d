/// A device on the bus as its master sees it: typed access to its objects over SDO.
///
///     canopen::RemoteNode<cpc_tc1::Device, Bus> drive{bus, canopen::NodeId{5}};
///     drive.write<od::controlword>(0x0F, now);
///     // pass frames and time to drive until it is not busy(), then
///     if (const auto done = drive.result(); !done) log(to_text(done.abort_code()));
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/result.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/od/access.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/value.hpp"
#include "canopen/od/value_for.hpp"
#include "canopen/sdo/sdo_client.hpp"

namespace canopen {

/// An object of this device.
template <class O, class Device>
concept ObjectOf = DictionaryObject<O> && Device::dictionary.has(O::index, O::sub_index);

/// An object that SDO can read.
template <class O>
concept RemoteReadable = DictionaryObject<O> && readable(O::access);

/// An object that SDO can write.
template <class O>
concept RemoteWritable = DictionaryObject<O> && writable(O::access);

/// Typed SDO client of one node. An SDO has one client, so do not use it for a node that an NmtMaster or SdoQueue
/// accesses: two clients receive each other's segments.
///
/// One transfer at a time: `read` or `write` starts it, frames and time are passed in until the node is no longer
/// `busy()`, then `value()`, `data()` or `result()` return its outcome.
///
/// The following do not compile: an object that the device does not have, one that SDO cannot read or write, a value of
/// a type that cannot be converted without loss, and a constant outside the limits in `write<O, value>(now)`.
template <class Device, Bus B>
class RemoteNode {
 public:
  constexpr RemoteNode(B& can_bus, NodeId node_id, SdoClientOptions options = {})
      : client_{can_bus, node_id, options} {}

  /// Starts to read an object; `value<O>()` then returns it. 060A 0023h while busy.
  template <NumberObject O>
  requires ObjectOf<O, Device> && RemoteReadable<O> Result<void> read(TimePoint now) {
    return begun(client_.template read<O>(now));
  }

  /// Starts to read a string or DOMAIN into memory; `data()` then returns its bytes.
  template <DictionaryObject O>
  requires ObjectOf<O, Device> && RemoteReadable<O> &&
      (StringObject<O> || DomainObject<O>)Result<void> read(std::span<std::uint8_t> memory, TimePoint now) {
    return begun(client_.upload(O::index, O::sub_index, memory, now));
  }

  /// Starts to write an object. A value outside the limits is rejected at once and not sent.
  template <NumberObject O, ValueFor<O> V>
  requires ObjectOf<O, Device> && RemoteWritable<O> Result<void> write(V value, TimePoint now) {
    if (const AbortCode code = check_value<O>(value); code != ok) return code;
    return begun(client_.template write<O>(static_cast<typename O::type>(value), now));
  }

  /// Starts to write a constant.
  template <NumberObject O, auto Value>
  requires ObjectOf<O, Device> && RemoteWritable<O> && ValueFor<decltype(Value), O> Result<void> write(TimePoint now) {
    static_assert(check_value<O>(Value) == ok, "this value is outside the limits of the object");
    return begun(client_.template write<O>(static_cast<typename O::type>(Value), now));
  }

  /// Starts to write a string or DOMAIN from memory. A string longer than the capacity of the object is rejected at
  /// once with 0607 0012h.
  template <DictionaryObject O>
  requires ObjectOf<O, Device> && RemoteWritable<O> &&
      (StringObject<O> || DomainObject<O>)Result<void> write(std::span<const std::uint8_t> bytes, TimePoint now) {
    if constexpr (StringObject<O>) {
      if (bytes.size() > O::type::capacity()) return AbortCode::length_too_high;
    }
    return begun(client_.download(O::index, O::sub_index, bytes, now));
  }

  /// Returns the value that `read<O>` has read, or why it is missing. 060A 0023h while busy.
  template <NumberObject O>
  [[nodiscard]] Result<typename O::type> value() {
    if (busy()) return AbortCode::no_resource;
    if (const std::optional<typename O::type> value = client_.template value<O>()) return *value;
    return client_.result();
  }

  /// Returns the bytes of the string or DOMAIN that has been read.
  [[nodiscard]] std::span<const std::uint8_t> data() const { return client_.data(); }

  /// Returns how the last transfer ended.
  [[nodiscard]] Result<void> result() const { return client_.result(); }

  [[nodiscard]] bool busy() const { return client_.busy(); }
  void on_frame(const Frame& frame, TimePoint now) { client_.on_frame(frame, now); }
  void on_time(TimePoint now) { client_.on_time(now); }
  [[nodiscard]] std::optional<TimePoint> next_deadline() const { return client_.next_deadline(); }

  /// Returns the client, for access by index and sub-index and for transfers piece by piece.
  [[nodiscard]] SdoClient<B>& sdo() { return client_; }

 private:
  [[nodiscard]] static Result<void> begun(bool yes) { return yes ? ok : AbortCode::no_resource; }

  SdoClient<B> client_;
};

}  // namespace canopen
