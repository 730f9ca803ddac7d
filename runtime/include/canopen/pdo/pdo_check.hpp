/// Compile-time checks of a device's PDOs: those that edsc generates, and mappings that a user writes.
///
///     static_assert(canopen::CheckedTpdo<drive::dictionary, 1, MyTpdo1, canopen::PdoParameters{.cob_id = 0x180,
///                                        .plus_node_id = true}>::holds);
///
/// The compiler's message names the PDO, the entry, the object and the reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <tuple>
#include <utility>

#include "canopen/base/label.hpp"
#include "canopen/od/data_type.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/pdo/pdo.hpp"
#include "canopen/pdo/pdo_parameters.hpp"

namespace canopen {

namespace pdo_detail {

// One check per entry or PDO, so that the compiler's message names it. A failed assertion is not repeated by
// later ones.

/// What is wrong with an entry of a mapping.
enum class EntryFault : std::uint8_t {
  none,
  no_object,
  no_sub_index,
  not_mappable,
  not_in_a_tpdo,
  not_in_an_rpdo,
  no_fixed_length,
  other_length,
  dummy_in_a_tpdo,
  dummy_of_another_length,
  granularity,
};

/// What a check reads of a mapped object. Not a template, so that the compiler makes one check for all objects.
struct CheckedObject {
  std::uint16_t index;
  std::uint8_t sub_index;
  unsigned bits;
  Mappable mappable;
  unsigned string_bits;  ///< of a string that fills its capacity; 0 for other values
};

template <class Type>
inline constexpr unsigned string_bits = 0;
template <StringValue Type>
inline constexpr unsigned string_bits<Type> = 8 * Type::capacity();

template <class Object>
inline constexpr CheckedObject checked_object{Object::index, Object::sub_index, Object::bits, Object::mappable,
                                              string_bits<typename Object::type>};

/// Whether the length of a mapping entry fits the object in the dictionary: a BOOLEAN may occupy a byte, a string up to
/// its capacity.
[[nodiscard]] constexpr bool length_fits(const CheckedObject& object, entry::Word word) {
  if (entry::is_boolean(word)) return object.bits == 1 || object.bits == 8;
  if (object.string_bits != 0)
    return entry::is_string(word) && object.bits % 8 == 0 && object.bits <= object.string_bits;
  return object.bits == 8 * entry::wire_bytes(word);
}

/// A layout with a direction (`is_directed`) has checked it, and each layout its length.
[[nodiscard]] constexpr EntryFault fault_of(const CheckedObject& object, const Dictionary& dictionary, bool is_directed,
                                            bool receive, unsigned granularity) {
  if (object.index < first_object) {
    if (!receive) return EntryFault::dummy_in_a_tpdo;
    if (object.index < std::size(dummy_bits) && object.bits != dummy_bits[object.index])
      return EntryFault::dummy_of_another_length;
  } else {
    const entry::Word word = dictionary.find(object.index, object.sub_index);
    if (word == Dictionary::no_object) return EntryFault::no_object;
    if (word == Dictionary::no_sub_index) return EntryFault::no_sub_index;
    const bool maps_nothing = (word & (entry::tpdo | entry::rpdo)) == 0;
    const bool maps_here = (word & (receive ? entry::rpdo : entry::tpdo)) != 0;
    if (maps_nothing)
      return is_directed && object.mappable == Mappable::no ? EntryFault::none : EntryFault::not_mappable;
    if (!maps_here) return receive ? EntryFault::not_in_an_rpdo : EntryFault::not_in_a_tpdo;
    if (entry::is_domain(word)) return EntryFault::no_fixed_length;
    if (object.bits == 0) return EntryFault::none;
    if (!length_fits(object, word)) return EntryFault::other_length;
  }
  return object.bits % granularity != 0 ? EntryFault::granularity : EntryFault::none;
}

template <class Layout>
inline constexpr bool is_directed = requires {
  Layout::has_direction;
};

/// Whether no entry of a layout has a fault. A loop over a list: the compiler makes less code for each layout.
[[nodiscard]] constexpr bool are_right(std::initializer_list<CheckedObject> objects, const Dictionary& dictionary,
                                       bool is_directed, bool receive, unsigned granularity) {
  for (const CheckedObject& object : objects) {
    if (fault_of(object, dictionary, is_directed, receive, granularity) != EntryFault::none) return false;
  }
  return true;
}
template <class... Objects>
[[nodiscard]] constexpr bool entries_are_right(const PdoLayout<Objects...>* /*layout*/,
                                               [[maybe_unused]] const Dictionary& dictionary,
                                               [[maybe_unused]] bool directed, [[maybe_unused]] bool receive,
                                               [[maybe_unused]] unsigned granularity) {
  return are_right({checked_object<Objects>...}, dictionary, directed, receive, granularity);
}

template <const Dictionary& DeviceDictionary, class Pdo, class Number, class Label, class Object, EntryFault Fault>
struct CheckedEntry {
  static constexpr bool is_good = true;
  static_assert(Fault != EntryFault::no_object, "PDO mapping: the device has no such object");
  static_assert(Fault != EntryFault::no_sub_index, "PDO mapping: the object has no such sub-index");
  static_assert(Fault != EntryFault::not_mappable,
                "PDO mapping: the object cannot be mapped, its EDS says PDOMapping=0");
  static_assert(Fault != EntryFault::not_in_a_tpdo,
                "PDO mapping: a TPDO carries ro, rw, rwr and const objects, none that are rww or wo");
  static_assert(Fault != EntryFault::not_in_an_rpdo,
                "PDO mapping: an RPDO carries rw, rww and wo objects, none that are ro, rwr or const");
  static_assert(Fault != EntryFault::no_fixed_length,
                "PDO mapping: the object has no fixed length; a string needs FixedString, a DOMAIN cannot be mapped");
  static_assert(Fault != EntryFault::other_length, "PDO mapping: the entry has another length than the object");
  static_assert(Fault != EntryFault::dummy_in_a_tpdo, "PDO mapping: only an RPDO has dummies");
  static_assert(Fault != EntryFault::dummy_of_another_length,
                "PDO mapping: the dummy has another length than its data type");
  static_assert(Fault != EntryFault::granularity,
                "PDO mapping: the entry's length is not a multiple of the device's Granularity");
};

/// Returns the CAN-ID for messages: that of node-ID 1, if the node-ID is added.
[[nodiscard]] constexpr std::uint32_t shown_can_id(const PdoParameters& parameters) {
  return (parameters.cob_id & 0x1FFF'FFFF) + (parameters.plus_node_id ? 1 : 0);
}

template <class Pdo, class Id, bool Legal>
struct CheckedCobId {
  static constexpr bool is_legal = true;
  static_assert(Legal, "PDO: its COB-ID is restricted, or has more than 11 bits, for some node-ID (CiA 301, 7.3.5)");
};

template <const Dictionary& DeviceDictionary, class Pdo, class Number, class Layout, class Object, unsigned Granularity>
[[nodiscard]] constexpr auto check_entry() {
  constexpr EntryFault fault =
      fault_of(checked_object<Object>, DeviceDictionary, is_directed<Layout>, Pdo::receive, Granularity);
  return VerdictOf<fault == EntryFault::none,
                   CheckedEntry<DeviceDictionary, Pdo, Number, LabelOf<Object>, Object, fault>>{};
}
/// Looks at single entries only if one has a fault: most of the compile time of a device with many PDOs was theirs.
template <const Dictionary& DeviceDictionary, class Pdo, class Layout, unsigned Granularity, std::size_t... Position>
[[nodiscard]] constexpr auto check_entries(std::index_sequence<Position...> /*entries*/) {
  if constexpr (entries_are_right(static_cast<const Layout*>(nullptr), DeviceDictionary, is_directed<Layout>,
                                  Pdo::receive, Granularity))
    return canopen::first_failure();
  else
    return canopen::first_failure(check_entry<DeviceDictionary, Pdo, EntryNumber<Position + 1>, Layout,
                                              typename Layout::template Entry<Position>, Granularity>()...);
}

template <const Dictionary& DeviceDictionary, class Pdo, class Layout, PdoParameters Communication,
          unsigned Granularity>
struct CheckedPdo {
  using Label = Pdo;
  static constexpr bool holds = true;
  static constexpr std::uint16_t index = (Pdo::receive ? 0x1400 : 0x1800) + Pdo::number - 1;
  static constexpr PdoCobId cob_id{Pdo::receive, Communication.cob_id, Communication.plus_node_id};

  static_assert(Pdo::number >= 1 && Pdo::number <= 512, "PDO: its number is 1 to 512");
  static_assert(DeviceDictionary.has(index, 1), "PDO: the device has no communication parameter for it");
  static_assert(Communication.compatibility_entry || !DeviceDictionary.has(index, 4),
                "PDO: sub-index 4 of its communication parameter is reserved");
  static_assert(CheckedCobId<Pdo, CanIdLabel<shown_can_id(Communication)>, cob_id_is_legal(Communication)>::is_legal);
  static_assert(transmission_type_is_legal(Pdo::receive, Communication.transmission_type),
                "PDO: its transmission type is reserved");
  static_assert(Communication.inhibit_time == 0 || inhibit_time_is_used(Pdo::receive, Communication.transmission_type),
                "PDO: an inhibit time is for TPDOs of transmission types 254 and 255");
  static_assert(Communication.event_timer == 0 || event_timer_is_used(Pdo::receive, Communication.transmission_type),
                "PDO: an event timer is for RPDOs, and for TPDOs of transmission types 254 and 255");
  static_assert(decltype(check_entries<DeviceDictionary, Pdo, Layout, Granularity>(
      std::make_index_sequence<Layout::entries>{}))::type::is_good);
};

template <class First, class Second, class Id, bool Clash>
struct DistinctCobIds {
  static constexpr bool hold = true;
  static_assert(!Clash, "PDO: two of the device have the same COB-ID");
};

template <std::size_t Position, class... Checked>
using NthOf = std::tuple_element_t<Position, std::tuple<Checked...>>;

}  // namespace pdo_detail

/// `holds` if a layout can be TPDO `Number` of the device with this dictionary and, if specified, with these
/// communication parameters; does not compile if it cannot. `Granularity` is that of the EDS: entries begin and end at
/// multiples of this number of bits.
template <const Dictionary& DeviceDictionary, std::uint16_t Number, class Layout,
          PdoParameters Communication = PdoParameters{}, unsigned Granularity = 1>
using CheckedTpdo = pdo_detail::CheckedPdo<DeviceDictionary, TpdoNumber<Number>, Layout, Communication, Granularity>;

/// The same for RPDO `Number`.
template <const Dictionary& DeviceDictionary, std::uint16_t Number, class Layout,
          PdoParameters Communication = PdoParameters{}, unsigned Granularity = 1>
using CheckedRpdo = pdo_detail::CheckedPdo<DeviceDictionary, RpdoNumber<Number>, Layout, Communication, Granularity>;

/// Whether the valid ones among these CheckedTpdos and CheckedRpdos of a device have different COB-IDs for every
/// node-ID; does not compile if two are equal. Several RPDOs may have the same COB-ID.
///
/// A single function: each name of all PDOs takes g++ half a second for 1024 of them.
template <class... Checked>
[[nodiscard]] consteval bool distinct_cob_ids() {
  constexpr PdoCobId cob_ids[] = {Checked::cob_id...};
  if constexpr (constexpr CobIdClash clash = find_cob_id_clash(cob_ids, sizeof...(Checked)); clash.found) {
    using First = pdo_detail::NthOf<clash.first, Checked...>;
    using Second = pdo_detail::NthOf<clash.second, Checked...>;
    constexpr std::uint32_t id = First::cob_id.cob_id & 0x1FFF'FFFF;
    return pdo_detail::DistinctCobIds<typename First::Label, typename Second::Label, pdo_detail::CanIdLabel<id>,
                                      clash.found>::hold;
  }
  return true;
}

}  // namespace canopen
