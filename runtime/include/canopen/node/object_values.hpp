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
#include "canopen/node/object_setters.hpp"
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
template <class Object>
concept Arithmetic = NumberObject<Object> && std::is_arithmetic_v<RawOf<typename Object::type>>;

}  // namespace object_values_detail

/// Base of a node: what it does with objects by their tags. Without a tag, the object is a template argument:
/// `node.get<od::pressure>()`.
template <class NodeType>
class ObjectValues : public ObjectSetters<NodeType> {
 public:
  using ObjectSetters<NodeType>::set;

  /// Returns an element of an array of numbers by its run-time sub-index: `get(od::outputs{}, i)`. no_sub_index: it
  /// does not exist.
  template <template <std::uint8_t> class Array>
  requires object_values_detail::Arithmetic<Array<whole_array>>
  [[nodiscard]] Result<typename Array<whole_array>::type> get(Array<whole_array>, std::uint8_t sub_index) {
    using Element = Array<whole_array>;
    const entry::Word word = node().host().store.entries().find(Element::index, sub_index);
    if (sub_index == 0 || word <= Dictionary::no_sub_index) return AbortCode::no_sub_index;
    std::array<std::uint8_t, 8> bytes{};
    std::ranges::copy(node().host().store.entries().read(word, bytes), bytes.begin());
    return value_detail::value_from<Element>(bytes);
  }

  /// Sets an element, with the checks of `set`. no_sub_index: it does not exist.
  template <template <std::uint8_t> class Array>
  requires object_values_detail::Arithmetic<Array<whole_array>>
  [[nodiscard]] AbortCode set(Array<whole_array>, std::uint8_t sub_index,
                              std::type_identity_t<ValueOf<Array<whole_array>>> value) {
    using Element = Array<whole_array>;
    if (sub_index == 0) return AbortCode::no_sub_index;
    RawOf<typename Element::type> element = to_raw(value.value());
    const std::span<std::uint8_t> bytes{reinterpret_cast<std::uint8_t*>(&element), (Element::bits + 7) / 8};
    if constexpr (is_communication_index(Element::index)) {
      if (const AbortCode code = node().host().services.check_write(node().host(), Element::index, sub_index, bytes);
          code != ok)
        return code;
    }
    return node().set(Element::index, sub_index, bytes);
  }

  /// Changes the value of an object: `modify(od::controlword{}, [](auto& word) { word.quick_stop(true).halt(false);
  /// })`. Its TPDOs are sent as with `set`.
  template <object_values_detail::Arithmetic Object, class Change>
  requires(!can_be_refused<Object>) AbortCode modify(Object, Change change) {
    typename Object::type value = node().template get<Object>();
    change(value);
    return node().template set<Object>(value);
  }
  /// The same for an object that rejects values outside its limits: the value is then not changed.
  template <object_values_detail::Arithmetic Object, class Change>
  requires(can_be_refused<Object>) [[nodiscard]] AbortCode modify(Object, Change change) {
    typename Object::type value = node().template get<Object>();
    change(value);
    return node().template set<Object>(value);
  }

  /// Maps these objects into TPDO or RPDO `Number`: `node.map<2, canopen::Tpdo<od::pressure, od::temperature>>()`. The
  /// PDO must have a dynamic mapping; its communication parameter stays as it is. 0601 0000h: the PDO is valid, and its
  /// mapping may not change (CiA 301, 7.5.2.36 and 7.5.2.38): set bit 31 of its COB-ID before, and clear it afterwards.
  /// An object that the device cannot map in this direction does not compile.
  template <std::uint16_t Number, class Layout>
  [[nodiscard]] AbortCode map() {
    using Device = typename NodeType::DeviceType;
    return Remapping<Device, Number, Layout>::map(
        [this](std::uint16_t index, std::uint8_t sub_index, std::uint32_t value, std::size_t size) {
          const std::span bytes{reinterpret_cast<std::uint8_t*>(&value), size};
          const AbortCode code = node().host().services.check_write(node().host(), index, sub_index, bytes);
          return code != ok ? code : node().set(index, sub_index, bytes);
        });
  }

  /// Sends the value of an object as a DAM-MPDO, like Node::send_mpdo.
  template <DictionaryObject Object>
  [[nodiscard]] bool send_mpdo(const MpdoDestination& to) {
    static_assert(Object::bits >= 1 && Object::bits <= 32, "a multiplex PDO carries a value of 32 bits at most");
    constexpr std::uint32_t mask = 0xFFFF'FFFF >> (32 - Object::bits);
    return node().send_mpdo(to,
                            static_cast<std::uint32_t>(value_detail::to_bits(node().template get<Object>())) & mask);
  }

  /// Binds a DOMAIN to memory: a download may fill all of it, an upload sends the first `size` bytes.
  template <DictionaryObject Object>
  void bind(std::span<std::uint8_t> memory, std::size_t size) {
    static_assert(std::is_same_v<typename Object::type, Domain>, "only a DOMAIN is bound to memory");
    node().template bind_domain<Object>(
        {memory.data(), static_cast<std::uint32_t>(size), static_cast<std::uint32_t>(memory.size())});
  }
  template <DictionaryObject Object>
  void bind(Object, std::span<std::uint8_t> memory, std::size_t size) {
    bind<Object>(memory, size);
  }

  /// The same, with the whole memory as the value.
  template <DictionaryObject Object>
  void bind(std::span<std::uint8_t> memory) {
    bind<Object>(memory, memory.size());
  }
  template <DictionaryObject Object>
  void bind(Object, std::span<std::uint8_t> memory) {
    bind<Object>(memory, memory.size());
  }

  /// Binds a read-only DOMAIN to its bytes, which may be in flash.
  template <DictionaryObject Object>
  void bind_constant(std::span<const std::uint8_t> bytes) {
    static_assert(!writable(Object::access), "this DOMAIN may be written over the bus");
    node().template bind_domain<Object>(
        {const_cast<std::uint8_t*>(bytes.data()), static_cast<std::uint32_t>(bytes.size()), 0});
  }
  template <DictionaryObject Object>
  void bind_constant(Object, std::span<const std::uint8_t> bytes) {
    bind_constant<Object>(bytes);
  }

 private:
  [[nodiscard]] NodeType& node() { return static_cast<NodeType&>(*this); }
};

}  // namespace canopen
