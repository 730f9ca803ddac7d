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
#include "canopen/od/device_object.hpp"
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

namespace remote_detail {

// Conditions of a transfer. The compiler's message has the name with its arguments.

template <class O, class Device>
inline constexpr bool device_has = Device::dictionary.has(O::index, O::sub_index);
template <class O, class Device>
inline constexpr bool is_of_device = !device_has<O, Device> || !is_of_another_device<O, Device>;
template <class O>
inline constexpr bool is_readable = readable(O::access);
template <class O>
inline constexpr bool is_writable = writable(O::access);
template <class O, class V>
inline constexpr bool has_the_type_of = NumberObject<O>
                                            ? ValueFor<V, O>
                                            : std::is_convertible_v<V, std::span<const std::uint8_t>> ||
                                                  (StringObject<O> && std::is_convertible_v<V, std::string_view>);
template <class O, auto Value>
inline constexpr bool is_within_the_limits_of = true;
template <class O, auto Value>
requires ValueFor<decltype(Value), O>
inline constexpr bool is_within_the_limits_of<O, Value> = check_value<O>(Value) == ok;

/// A string, or a literal, for a string object.
template <class O, class V>
inline constexpr bool is_text_for = TextFor<std::decay_t<const V&>, O>;

/// An object of this device that SDO can read.
template <class O, class Device>
[[nodiscard]] constexpr bool can_be_read() {
  static_assert(device_has<O, Device>, "read: this device does not have the object");
  static_assert(is_of_device<O, Device>, "read: this is an object of another device");
  static_assert(is_readable<O>, "read: the object is wo");
  return device_has<O, Device> && is_of_device<O, Device> && is_readable<O>;
}

/// An object of this device that SDO can write with a value of this type. Limits are checked when it is written.
template <class O, class Device, class V>
[[nodiscard]] constexpr bool can_be_written() {
  constexpr bool exists = device_has<O, Device> && is_of_device<O, Device> && is_writable<O>;
  static_assert(device_has<O, Device>, "write: this device does not have the object");
  static_assert(is_of_device<O, Device>, "write: this is an object of another device");
  static_assert(is_writable<O>, "write: the object is ro or const");
  static_assert(!exists || has_the_type_of<O, V>, "write: this value is not of the type of the object");
  return exists && has_the_type_of<O, V>;
}

/// Whether `can_be_written` is true, without a message.
template <class V, class O, class Device>
concept WrittenTo = device_has<O, Device> && is_of_device<O, Device> && is_writable<O> && has_the_type_of<O, V>;

/// What `write` returns where it does not compile: the compiler then does not also report that it is not used.
struct NotWritten : Result<void> {
  constexpr NotWritten() : Result{AbortCode::general} {}
};

/// The same with a constant.
template <class O, class Device, auto Value>
[[nodiscard]] constexpr bool can_be_written_with() {
  static_assert(is_within_the_limits_of<O, Value>, "write: this value is outside the limits of the object");
  return is_within_the_limits_of<O, Value> && can_be_written<O, Device, decltype(Value)>();
}

}  // namespace remote_detail

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
  [[nodiscard]] Result<void> read(TimePoint now) {
    if constexpr (remote_detail::can_be_read<O, Device>()) return begun(client_.template read<O>(now));
    return AbortCode::general;
  }

  /// Starts to read a string or DOMAIN into memory; `data()` then returns its bytes.
  template <DictionaryObject O>
  requires(StringObject<O> || DomainObject<O>)
      [[nodiscard]] Result<void> read(std::span<std::uint8_t> memory, TimePoint now) {
    if constexpr (remote_detail::can_be_read<O, Device>())
      return begun(client_.upload(O::index, O::sub_index, memory, now));
    return AbortCode::general;
  }

  /// Starts to write an object. A value outside the limits is rejected at once and not sent.
  template <NumberObject O, remote_detail::WrittenTo<O, Device> V>
  [[nodiscard]] Result<void> write(V value, TimePoint now) {
    if (const AbortCode code = check_value<O>(value); code != ok) return code;
    return begun(client_.template write<O>(static_cast<typename O::type>(value), now));
  }
  /// What does not compile.
  template <NumberObject O, class V>
  remote_detail::NotWritten write(V, TimePoint) {
    static_cast<void>(remote_detail::can_be_written<O, Device, V>());
    return {};
  }

  /// Starts to write a constant.
  template <NumberObject O, auto Value>
  [[nodiscard]] Result<void> write(TimePoint now) {
    if constexpr (remote_detail::can_be_written_with<O, Device, Value>())
      return begun(client_.template write<O>(static_cast<typename O::type>(Value), now));
    return AbortCode::general;
  }

  /// Starts to write a string or DOMAIN from memory. A string longer than the capacity of the object is rejected at
  /// once with 0607 0012h.
  template <DictionaryObject O>
  requires(StringObject<O> || DomainObject<O>)
      [[nodiscard]] Result<void> write(std::span<const std::uint8_t> bytes, TimePoint now) {
    if constexpr (remote_detail::can_be_written<O, Device, std::span<const std::uint8_t>>()) {
      if constexpr (StringObject<O>) {
        if (bytes.size() > O::type::capacity()) return AbortCode::length_too_high;
      }
      return begun(client_.download(O::index, O::sub_index, bytes, now));
    }
    return AbortCode::general;
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
