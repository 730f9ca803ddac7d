/// Object scanner lists and object dispatching lists of MPDOs (CiA 301, 7.5.2.39 and 7.5.2.40).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/pdo/mpdo.hpp"

namespace canopen {

/// An element of an object scanner list, 1FA0h..1FCFh: objects of this device that are sent as SAM-MPDOs.
struct ScannedObjects {
  static constexpr std::uint16_t first_list = 0x1FA0;
  static constexpr std::uint16_t last_list = 0x1FCF;
  using Value = std::uint32_t;

  Value value;

  /// Number of consecutive sub-indices. A block of size 0 contains one object.
  [[nodiscard]] std::uint8_t size() const { return (value >> 24) != 0 ? static_cast<std::uint8_t>(value >> 24) : 1; }
  [[nodiscard]] std::uint16_t index() const { return static_cast<std::uint16_t>(value >> 8); }
  [[nodiscard]] std::uint8_t sub_index() const { return static_cast<std::uint8_t>(value); }
};

/// An element of an object dispatching list, 1FD0h..1FFFh: destination of the values of received SAM-MPDOs.
struct DispatchedObjects {
  static constexpr std::uint16_t first_list = 0x1FD0;
  static constexpr std::uint16_t last_list = 0x1FFF;
  using Value = std::uint64_t;

  Value value;

  [[nodiscard]] std::uint8_t size() const { return (value >> 56) != 0 ? static_cast<std::uint8_t>(value >> 56) : 1; }
  [[nodiscard]] std::uint16_t index() const { return static_cast<std::uint16_t>(value >> 40); }
  [[nodiscard]] std::uint8_t sub_index() const { return static_cast<std::uint8_t>(value >> 32); }
  [[nodiscard]] std::uint16_t sender_index() const { return static_cast<std::uint16_t>(value >> 16); }
  [[nodiscard]] std::uint8_t sender_sub_index() const { return static_cast<std::uint8_t>(value >> 8); }
  [[nodiscard]] std::uint8_t sender() const { return static_cast<std::uint8_t>(value); }

  /// Whether an MPDO contains one of the objects; `offset()` is its position.
  [[nodiscard]] bool match(const Mpdo& mpdo) const {
    return sender() == mpdo.node_id() && sender_index() == mpdo.index() && mpdo.sub_index() >= sender_sub_index() &&
           offset(mpdo) < size();
  }
  [[nodiscard]] unsigned offset(const Mpdo& mpdo) const {
    return static_cast<unsigned>(mpdo.sub_index() - sender_sub_index());
  }
};

/// All lists of one kind, `ScannedObjects` or `DispatchedObjects`, that a dictionary has.
template <class Device, class Element>
class MpdoLists {
 public:
  [[nodiscard]] static constexpr bool contain(std::uint16_t index) {
    return index >= Element::first_list && index <= Element::last_list;
  }

  /// Returns how many elements an object can contain; 0: none, or it does not have the type of CiA 301.
  [[nodiscard]] static constexpr std::uint8_t capacity(std::uint16_t index) {
    const entry::Word count = Device::dictionary.find(index, 0);
    if (count <= Dictionary::no_sub_index || entry::wire_bytes(count) != 1) return 0;
    std::uint8_t capacity = 0;
    while (capacity < 254) {
      const entry::Word next = Device::dictionary.find(index, static_cast<std::uint8_t>(capacity + 1));
      if (next <= Dictionary::no_sub_index || entry::wire_bytes(next) != sizeof(typename Element::Value)) break;
      ++capacity;
    }
    return capacity;
  }

  static constexpr std::size_t room = [] {
    std::size_t sum = 0;
    for (unsigned index = Element::first_list; index <= Element::last_list; ++index) {
      sum += capacity(static_cast<std::uint16_t>(index));
    }
    return sum;
  }();

  /// Calls `visit(element, index, sub_index)`, with its position in the list, for each element that is not empty, up to
  /// the number in sub-index 0 of its list.
  template <class Visit>
  static void for_each(EntryAccess<Device> entries, Visit&& visit) {
    for (const List& list : lists) {
      const std::uint32_t used = entries.number(list.count);
      for (std::uint32_t i = 0; i < used && list.begin + i < list.end; ++i) {
        std::array<std::uint8_t, 8> scratch;
        Element element{};
        std::memcpy(&element.value, entries.read(words[list.begin + i], scratch).data(), sizeof element.value);
        if (element.value != 0) visit(element, list.index, static_cast<std::uint8_t>(i + 1));
      }
    }
  }

 private:
  struct List {
    entry::Word count;
    std::uint16_t index;
    std::uint16_t begin;  ///< position of its first element among all
    std::uint16_t end;
  };

  static constexpr std::size_t list_count = [] {
    std::size_t count = 0;
    for (unsigned index = Element::first_list; index <= Element::last_list; ++index) {
      count += capacity(static_cast<std::uint16_t>(index)) != 0 ? 1u : 0u;
    }
    return count;
  }();

  static constexpr std::array<List, list_count> lists = [] {
    std::array<List, list_count> rows{};
    std::size_t i = 0;
    std::size_t begin = 0;
    for (unsigned at = Element::first_list; at <= Element::last_list; ++at) {
      const auto index = static_cast<std::uint16_t>(at);
      const std::size_t end = begin + capacity(index);
      if (end == begin) continue;
      rows[i++] = {Device::dictionary.find(index, 0), index, static_cast<std::uint16_t>(begin),
                   static_cast<std::uint16_t>(end)};
      begin = end;
    }
    return rows;
  }();

  static constexpr std::array<entry::Word, room> words = [] {
    std::array<entry::Word, room> rows{};
    for (const List& list : lists) {
      for (std::size_t i = list.begin; i < list.end; ++i) {
        rows[i] = Device::dictionary.find(list.index, static_cast<std::uint8_t>(i - list.begin + 1));
      }
    }
    return rows;
  }();
};

}  // namespace canopen
