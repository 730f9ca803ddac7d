/// Values of a node by the tags of their objects: `node.set(od::pressure{}, 420)`.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/result.hpp"
#include "canopen/node/value_check.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/object_list.hpp"
#include "canopen/od/value.hpp"
#include "canopen/od/value_bits.hpp"
#include "canopen/od/value_for.hpp"
#include "canopen/pdo/mpdo.hpp"
#include "canopen/pdo/remapping.hpp"

namespace canopen {

namespace object_values_detail {

/// An object whose value is a number or a BOOLEAN.
template <class O>
concept Arithmetic = NumberObject<O> && std::is_arithmetic_v<typename O::type>;

/// A type whose values all fit into another one.
template <class V, class T>
concept FitsInto = std::same_as<V, T> ||
                   (value_for_detail::Integer<V>&& value_for_detail::Integer<T>&& std::cmp_greater_equal(
                        std::numeric_limits<V>::min(), std::numeric_limits<T>::min()) &&
                    std::cmp_less_equal(std::numeric_limits<V>::max(), std::numeric_limits<T>::max())) ||
                   (std::same_as<V, float> && std::same_as<T, double>);

template <class Object, class Value>
struct SetValue {
  static_assert(!Arithmetic<Object>, "set: the value is not of the type of the object");
  static constexpr bool is_good = !Arithmetic<Object>;
};

}  // namespace object_values_detail

/// Base of a node. A value has the type of its object, or is a constant, whose limits the compiler checks: a constant
/// outside does not compile, and neither does a number of another type. Without a tag, the object is a template
/// argument: `node.get<od::pressure>()`.
template <class N>
class ObjectValues {
 public:
  /// Also a value of a narrower type.
  template <object_values_detail::Arithmetic O, object_values_detail::FitsInto<typename O::type> V>
  requires(!can_be_refused<O>) AbortCode set(O, V value) { return node().template set<O>(value); }
  template <object_values_detail::Arithmetic O, object_values_detail::FitsInto<typename O::type> V>
  requires(can_be_refused<O>) [[nodiscard]] AbortCode set(O, V value) { return node().template set<O>(value); }

  /// A constant is not refused.
  template <object_values_detail::Arithmetic O>
  requires(!is_communication_index(O::index)) void set(O, std::type_identity_t<ConstantFor<O>> value) {
    static_cast<void>(node().template set<O>(value.value()));
  }
  /// A parameter of a service is refused if it may not be changed now.
  template <object_values_detail::Arithmetic O>
  requires(is_communication_index(O::index)) [[nodiscard]] AbortCode
      set(O, std::type_identity_t<ConstantFor<O>> value) {
    return node().template set<O>(value.value());
  }

  /// The same for a constant of the type `int`: `set<od::target_position, 4'000>()`.
  template <object_values_detail::Arithmetic O, auto Value>
  requires(ValueFor<decltype(Value), O>) AbortCode set() {
    static_assert(check_value<O>(Value) == ok, "this value is outside the limits of the object");
    return node().template set<O>(static_cast<typename O::type>(Value));
  }

  /// A string, a time or a DOMAIN; a value of any other type does not compile.
  template <DictionaryObject O, class V>
  requires(!object_values_detail::Arithmetic<O> || !ValueFor<V, O>) AbortCode set(O, const V& value) {
    if constexpr (object_values_detail::SetValue<O, V>::is_good) return node().template set<O>(value);
    return ok;
  }

  /// Returns an element of an array of numbers by its run-time sub-index: `get(od::outputs{}, i)`. no_sub_index: it
  /// does not exist.
  template <template <std::uint8_t> class Array>
  requires object_values_detail::Arithmetic<Array<whole_array>>
  [[nodiscard]] Result<typename Array<whole_array>::type> get(Array<whole_array>, std::uint8_t sub_index) {
    using Element = Array<whole_array>;
    const entry::Word word = node().entries().find(Element::index, sub_index);
    if (sub_index == 0 || word <= Dictionary::no_sub_index) return AbortCode::no_sub_index;
    std::array<std::uint8_t, 8> bytes{};
    std::ranges::copy(node().entries().read(word, bytes), bytes.begin());
    return value_detail::value_from<Element>(bytes);
  }

  /// Sets an element, with the checks of `set`. no_sub_index: it does not exist.
  template <template <std::uint8_t> class Array>
  requires object_values_detail::Arithmetic<Array<whole_array>>
  [[nodiscard]] AbortCode set(Array<whole_array>, std::uint8_t sub_index, typename Array<whole_array>::type value) {
    using Element = Array<whole_array>;
    if (sub_index == 0) return AbortCode::no_sub_index;
    const std::span<std::uint8_t> bytes{reinterpret_cast<std::uint8_t*>(&value), (Element::bits + 7) / 8};
    if constexpr (is_communication_index(Element::index)) {
      if (const AbortCode code = node().host().check_write(Element::index, sub_index, bytes); code != ok) return code;
    }
    return node().set(Element::index, sub_index, bytes);
  }

  /// Maps these objects into TPDO or RPDO `Number`: `node.map<2, canopen::Tpdo<od::pressure, od::temperature>>()`. The
  /// PDO must have a dynamic mapping; its communication parameter stays as it is.
  template <std::uint16_t Number, class Layout>
  AbortCode map() {
    using Device = typename N::Host::Device;
    return Remapping<Device, Number, Layout>::map(
        [this](std::uint16_t index, std::uint8_t sub_index, std::uint32_t value, std::size_t bytes) {
          return node().set(index, sub_index, {reinterpret_cast<const std::uint8_t*>(&value), bytes});
        });
  }

  /// Sends the value of an object as a DAM-MPDO, like Node::send_mpdo.
  template <DictionaryObject O>
  [[nodiscard]] bool send_mpdo(const MpdoDestination& to) {
    static_assert(O::bits >= 1 && O::bits <= 32, "a multiplex PDO carries a value of 32 bits at most");
    constexpr std::uint32_t mask = 0xFFFF'FFFF >> (32 - O::bits);
    return node().send_mpdo(to, static_cast<std::uint32_t>(value_detail::to_bits(node().template get<O>())) & mask);
  }

  /// Binds a DOMAIN to memory: a download may fill all of it, an upload sends the first `size` bytes.
  template <DictionaryObject O>
  void bind(std::span<std::uint8_t> memory, std::size_t size) {
    static_assert(std::is_same_v<typename O::type, Domain>, "only a DOMAIN is bound to memory");
    node().template bind_domain<O>(
        {memory.data(), static_cast<std::uint32_t>(size), static_cast<std::uint32_t>(memory.size())});
  }
  template <DictionaryObject O>
  void bind(O, std::span<std::uint8_t> memory, std::size_t size) {
    bind<O>(memory, size);
  }

  /// The same, with the whole memory as the value.
  template <DictionaryObject O>
  void bind(std::span<std::uint8_t> memory) {
    bind<O>(memory, memory.size());
  }
  template <DictionaryObject O>
  void bind(O, std::span<std::uint8_t> memory) {
    bind<O>(memory, memory.size());
  }

  /// Binds a read-only DOMAIN to its bytes, which may be in flash.
  template <DictionaryObject O>
  void bind_constant(std::span<const std::uint8_t> bytes) {
    static_assert(!writable(O::access), "this DOMAIN may be written over the bus");
    node().template bind_domain<O>(
        {const_cast<std::uint8_t*>(bytes.data()), static_cast<std::uint32_t>(bytes.size()), 0});
  }
  template <DictionaryObject O>
  void bind_constant(O, std::span<const std::uint8_t> bytes) {
    bind_constant<O>(bytes);
  }

 private:
  [[nodiscard]] N& node() { return static_cast<N&>(*this); }
};

}  // namespace canopen
