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

#include "canopen/base/constant_errors.hpp"
//
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
template <class Object, class Device>
concept ObjectOf = DictionaryObject<Object> && Device::dictionary.has(Object::index, Object::sub_index);

/// An object that SDO can read.
template <class Object>
concept RemoteReadable = DictionaryObject<Object> && readable(Object::access);

/// An object that SDO can write.
template <class Object>
concept RemoteWritable = DictionaryObject<Object> && writable(Object::access);

namespace remote_detail {

// Conditions of a transfer. The compiler's message has the name with its arguments.

template <class Object, class Device>
inline constexpr bool device_has = Device::dictionary.has(Object::index, Object::sub_index);
template <class Object, class Device>
inline constexpr bool is_of_device = !device_has<Object, Device> || !is_of_another_device<Object, Device>;
template <class Object>
inline constexpr bool is_readable = readable(Object::access);
template <class Object>
inline constexpr bool is_writable = writable(Object::access);
/// A raw number, whose range is checked when it is written.
template <class Object, class ValueType>
inline constexpr bool is_raw_for = is_raw_number<ValueType>&& Meaningful<typename Object::type>;

template <class Object, class ValueType>
inline constexpr bool has_the_type_of = is_raw_for<Object, ValueType> ||
                                        (NumberObject<Object>
                                             ? ValueFor<ValueType, Object>
                                             : std::is_convertible_v<ValueType, std::span<const std::uint8_t>> ||
                                                   (StringObject<Object> &&
                                                    std::is_convertible_v<ValueType, std::string_view>));
template <class Object, auto Value>
inline constexpr bool is_within_the_limits_of = true;
template <class Object, auto Value>
requires ValueFor<std::remove_cv_t<decltype(Value)>, Object>
inline constexpr bool is_within_the_limits_of<Object, Value> = check_value<Object>(Value) == ok;

/// A string, or a literal, for a string object.
template <class Object, class ValueType>
inline constexpr bool is_text_for = TextFor<std::decay_t<const ValueType&>, Object>;

/// An object of this device that SDO can read.
template <class Object, class Device>
[[nodiscard]] constexpr bool can_be_read() {
  static_assert(device_has<Object, Device>, "read: this device does not have the object");
  static_assert(is_of_device<Object, Device>, "read: this is an object of another device");
  static_assert(is_readable<Object>, "read: the object is wo");
  return device_has<Object, Device> && is_of_device<Object, Device> && is_readable<Object>;
}

/// An object of this device that SDO can write with a value of this type. Limits are checked when it is written.
template <class Object, class Device, class ValueType>
[[nodiscard]] constexpr bool can_be_written() {
  constexpr bool exists = device_has<Object, Device> && is_of_device<Object, Device> && is_writable<Object>;
  static_assert(device_has<Object, Device>, "write: this device does not have the object");
  static_assert(is_of_device<Object, Device>, "write: this is an object of another device");
  static_assert(is_writable<Object>, "write: the object is ro or const");
  static_assert(!exists || has_the_type_of<Object, ValueType>, "write: this value is not of the type of the object");
  return exists && has_the_type_of<Object, ValueType>;
}

/// Whether `can_be_written` is true, without a message.
template <class ValueType, class Object, class Device>
concept WrittenTo = device_has<Object, Device> && is_of_device<Object, Device> && is_writable<Object> &&
    has_the_type_of<Object, ValueType>;

/// Whether ConstantOf<Object> checks a value: that of an object with a meaning that can be written.
template <class ValueType, class Object, class Device>
concept IsConstantFor = Meaningful<typename Object::type> && WrittenTo<typename Object::type, Object, Device> &&
    !has_the_type_of<Object, ValueType>;

/// Whether no overload of `write` but the one that fails to compile accepts a value.
template <class ValueType, class Object, class Device>
concept NeverWritten = !WrittenTo<ValueType, Object, Device> && !IsConstantFor<ValueType, Object, Device>;

/// Checks a value or a raw number against the object.
template <class Object, class ValueType>
[[nodiscard]] constexpr AbortCode check(const ValueType& value) {
  if constexpr (is_raw_for<Object, ValueType>) {
    return CheckedValue<Object>::from(value).abort_code();
  } else {
    return check_value<Object>(value);
  }
}
template <class Object, class ValueType>
[[nodiscard]] constexpr typename Object::type converted(const ValueType& value) {
  if constexpr (is_raw_for<Object, ValueType>) {
    return from_raw<typename Object::type>(static_cast<RawOf<typename Object::type>>(value.number));
  } else {
    return static_cast<typename Object::type>(value);
  }
}

/// What `write` returns where it does not compile: the compiler then does not also report that it is not used.
struct NotWritten : Result<void> {
  constexpr NotWritten() : Result{AbortCode::general} {}
};

/// The same with a constant.
template <class Object, class Device, auto Value>
[[nodiscard]] constexpr bool can_be_written_with() {
  static_assert(is_within_the_limits_of<Object, Value>, "write: this value is outside the limits of the object");
  return is_within_the_limits_of<Object, Value> && can_be_written<Object, Device, decltype(Value)>();
}

}  // namespace remote_detail

/// Typed SDO client of one node. An SDO has one client, so do not use it for a node that an NmtMaster or SdoQueue
/// accesses: two clients receive each other's segments.
///
/// One transfer at a time: `read` or `write` starts it, frames and time are passed in until the node is no longer
/// `busy()`, then `value()`, `data()` or `result()` return its outcome.
///
/// The following do not compile: an object that the device does not have, one that SDO cannot read or write, a value of
/// a type that cannot be converted without loss, and a constant outside the limits in `write<Object, value>(now)`.
template <class Device, Bus BusType>
class RemoteNode {
 public:
  constexpr RemoteNode(BusType& can_bus, NodeId node_id, SdoClientOptions options = {})
      : client_{can_bus, node_id, options} {}

  /// Starts to read an object; `value<Object>()` then returns it. 060A 0023h while busy.
  template <NumberObject Object>
  [[nodiscard]] Result<void> read(TimePoint now) {
    if constexpr (remote_detail::can_be_read<Object, Device>()) return begun(client_.template read<Object>(now));
    return AbortCode::general;
  }

  /// Starts to read a string or DOMAIN into memory; `data()` then returns its bytes.
  template <DictionaryObject Object>
  requires(StringObject<Object> || DomainObject<Object>)
      [[nodiscard]] Result<void> read(std::span<std::uint8_t> memory, TimePoint now) {
    if constexpr (remote_detail::can_be_read<Object, Device>())
      return begun(client_.upload(Object::index, Object::sub_index, memory, now));
    return AbortCode::general;
  }

  /// Starts to write an object. A value outside the limits is rejected at once and not sent.
  template <NumberObject Object, remote_detail::WrittenTo<Object, Device> ValueType>
  [[nodiscard]] Result<void> write(ValueType value, TimePoint now) {
    if (const AbortCode code = remote_detail::check<Object>(value); code != ok) return code;
    return begun(client_.template write<Object>(remote_detail::converted<Object>(value), now));
  }
  /// Starts to write a constant of an object with a meaning: with a unit.
  template <NumberObject Object>
  requires(Meaningful<typename Object::type>&& remote_detail::WrittenTo<typename Object::type, Object, Device>)
      [[nodiscard]] Result<void> write(std::type_identity_t<ConstantOf<Object>> constant, TimePoint now) {
    return begun(client_.template write<Object>(constant.value(), now));
  }
  /// What does not compile.
  template <NumberObject Object, class ValueType>
  requires remote_detail::NeverWritten<ValueType, Object, Device> remote_detail::NotWritten write(ValueType,
                                                                                                  TimePoint) {
    static_cast<void>(remote_detail::can_be_written<Object, Device, ValueType>());
    return {};
  }

  /// Starts to write a constant.
  template <NumberObject Object, auto Value>
  [[nodiscard]] Result<void> write(TimePoint now) {
    if constexpr (remote_detail::can_be_written_with<Object, Device, Value>())
      return begun(client_.template write<Object>(static_cast<typename Object::type>(Value), now));
    return AbortCode::general;
  }

  /// Starts to write a string or DOMAIN from memory. A string longer than the capacity of the object is rejected at
  /// once with 0607 0012h.
  template <DictionaryObject Object>
  requires(StringObject<Object> || DomainObject<Object>)
      [[nodiscard]] Result<void> write(std::span<const std::uint8_t> bytes, TimePoint now) {
    if constexpr (remote_detail::can_be_written<Object, Device, std::span<const std::uint8_t>>()) {
      if constexpr (StringObject<Object>) {
        if (bytes.size() > Object::type::capacity()) return AbortCode::length_too_high;
      }
      return begun(client_.download(Object::index, Object::sub_index, bytes, now));
    }
    return AbortCode::general;
  }

  /// Returns the value that `read<Object>` has read, or why it is missing. 060A 0023h while busy.
  template <NumberObject Object>
  [[nodiscard]] Result<typename Object::type> value() {
    if (busy()) return AbortCode::no_resource;
    if (const std::optional<typename Object::type> value = client_.template value<Object>()) return *value;
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
  [[nodiscard]] SdoClient<BusType>& sdo() { return client_; }

 private:
  [[nodiscard]] static Result<void> begun(bool yes) { return yes ? ok : AbortCode::no_resource; }

  SdoClient<BusType> client_;
};

}  // namespace canopen
