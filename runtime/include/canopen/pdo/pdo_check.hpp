/// Compile-time checks of a device's PDOs: those that edsc generates, and mappings that a user writes.
///
///     static_assert(canopen::CheckedTpdo<drive::dictionary, 1, MyTpdo1, canopen::PdoParameters{.cob_id = 0x180,
///                                        .plus_node_id = true}>::holds);
///
/// The compiler's message names the PDO, the entry, the object and the reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

#include "canopen/base/label.hpp"
#include "canopen/od/data_type.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/pdo/pdo.hpp"
#include "canopen/pdo/pdo_parameters.hpp"

namespace canopen {

namespace pdo_detail {

/// Whether the length of a mapping entry fits the object in the dictionary: a BOOLEAN may occupy a byte, a string up to
/// its capacity.
template <class O>
[[nodiscard]] constexpr bool length_fits(entry::Word word) {
  if (entry::is_boolean(word)) return O::bits == 1 || O::bits == 8;
  if constexpr (StringValue<typename O::type>) {
    return entry::is_string(word) && O::bits % 8 == 0 && O::bits <= 8 * O::type::capacity();
  } else {
    return O::bits == 8 * entry::wire_bytes(word);
  }
}

// One check per entry or PDO, so that the compiler's message names it. A failed assertion is not repeated by
// later ones.

template <const Dictionary& D, class Pdo, class Number, class Label, class O, unsigned End, unsigned Granularity>
struct CheckedEntry {
  static constexpr entry::Word word = D.find(O::index, O::sub_index);
  static constexpr bool has_object = word != Dictionary::no_object;
  static constexpr bool exists = has_object && word != Dictionary::no_sub_index;
  static constexpr bool maps_nothing = (word & (entry::tpdo | entry::rpdo)) == 0;
  static constexpr bool maps_here = (word & (Pdo::receive ? entry::rpdo : entry::tpdo)) != 0;
  static constexpr bool has_length = !entry::is_domain(word) && O::bits > 0;

  static_assert(has_object, "PDO mapping: the device has no such object");
  static_assert(!has_object || exists, "PDO mapping: the object has no such sub-index");
  static_assert(!exists || !maps_nothing, "PDO mapping: the object cannot be mapped, its EDS says PDOMapping=0");
  static_assert(!exists || maps_nothing || maps_here || Pdo::receive,
                "PDO mapping: a TPDO carries ro, rw, rwr and const objects, none that are rww or wo");
  static_assert(!exists || maps_nothing || maps_here || !Pdo::receive,
                "PDO mapping: an RPDO carries rw, rww and wo objects, none that are ro, rwr or const");
  static_assert(!exists || has_length,
                "PDO mapping: the object has no fixed length; a string needs FixedString, a DOMAIN cannot be mapped");
  static_assert(!exists || !has_length || length_fits<O>(word),
                "PDO mapping: the entry has another length than the object");
  static_assert(O::bits % Granularity == 0,
                "PDO mapping: the entry's length is not a multiple of the device's Granularity");
  static_assert(End <= 64, "PDO mapping: the entry ends beyond the 64 bits of a PDO");
  static constexpr bool holds = true;
};

template <const Dictionary& D, class Pdo, class Number, class Label, class O, unsigned End, unsigned Granularity>
requires is_dummy<O>
struct CheckedEntry<D, Pdo, Number, Label, O, End, Granularity> {
  static_assert(Pdo::receive, "PDO mapping: only an RPDO has dummies");
  static_assert(O::index > 0x0008 || O::bits == dummy_bits[O::index > 0x0008 ? 0 : O::index],
                "PDO mapping: the dummy has another length than its data type");
  static_assert(O::bits % Granularity == 0,
                "PDO mapping: the entry's length is not a multiple of the device's Granularity");
  static_assert(End <= 64, "PDO mapping: the entry ends beyond the 64 bits of a PDO");
  static constexpr bool holds = true;
};

/// Returns the CAN-ID for messages: that of node-ID 1, if the node-ID is added.
[[nodiscard]] constexpr std::uint32_t shown_can_id(const PdoParameters& parameters) {
  return (parameters.cob_id & 0x1FFF'FFFF) + (parameters.plus_node_id ? 1 : 0);
}

template <class Pdo, class Id, bool Legal>
struct CheckedCobId {
  static_assert(Legal, "PDO: its COB-ID is restricted, or has more than 11 bits, for some node-ID (CiA 301, 7.3.5)");
  static constexpr bool is_legal = true;
};

template <const Dictionary& D, class Pdo, unsigned Granularity, class Positions, class... O>
struct CheckedEntries;
template <const Dictionary& D, class Pdo, unsigned Granularity, std::size_t... I, class... O>
struct CheckedEntries<D, Pdo, Granularity, std::index_sequence<I...>, O...> {
  static constexpr bool hold =
      (true && ... &&
       CheckedEntry<D, Pdo, EntryNumber<I + 1>, LabelOf<O>, O, offsets_of<O...>[I + 1], Granularity>::holds);
};

template <const Dictionary& D, class Pdo, unsigned Granularity, class... O>
CheckedEntries<D, Pdo, Granularity, std::index_sequence_for<O...>, O...> checked_entries(const PdoLayout<O...>*);

template <const Dictionary& D, class Pdo, class Layout, PdoParameters P, unsigned Granularity>
struct CheckedPdo {
  using Label = Pdo;
  static constexpr std::uint16_t index = (Pdo::receive ? 0x1400 : 0x1800) + Pdo::number - 1;
  static constexpr PdoCobId cob_id{Pdo::receive, P.cob_id, P.plus_node_id};

  static_assert(Pdo::number >= 1 && Pdo::number <= 512, "PDO: its number is 1 to 512");
  static_assert(D.has(index, 1), "PDO: the device has no communication parameter for it");
  static_assert(P.compatibility_entry || !D.has(index, 4),
                "PDO: sub-index 4 of its communication parameter is reserved");
  static_assert(CheckedCobId<Pdo, CanIdLabel<shown_can_id(P)>, cob_id_is_legal(P)>::is_legal);
  static_assert(transmission_type_is_legal(Pdo::receive, P.transmission_type),
                "PDO: its transmission type is reserved");
  static_assert(P.inhibit_time == 0 || inhibit_time_is_used(Pdo::receive, P.transmission_type),
                "PDO: an inhibit time is for TPDOs of transmission types 254 and 255");
  static_assert(P.event_timer == 0 || event_timer_is_used(Pdo::receive, P.transmission_type),
                "PDO: an event timer is for RPDOs, and for TPDOs of transmission types 254 and 255");
  static_assert(Layout::entries <= 64, "PDO mapping: a PDO maps 64 objects at most");
  static constexpr bool holds =
      decltype(checked_entries<D, Pdo, Granularity>(static_cast<const Layout*>(nullptr)))::hold;
};

template <class First, class Second, class Id, bool Clash>
struct DistinctCobIds {
  static_assert(!Clash, "PDO: two of the device have the same COB-ID");
  static constexpr bool hold = !Clash;
};

template <class... Checked>
inline constexpr CobIdClash clash_of = [] {
  const PdoCobId cob_ids[] = {Checked::cob_id...};
  return find_cob_id_clash(cob_ids, sizeof...(Checked));
}();

template <std::size_t I, class... Checked>
using NthOf = std::tuple_element_t<I, std::tuple<Checked...>>;

}  // namespace pdo_detail

/// `holds` if a layout can be TPDO `Number` of the device with this dictionary and, if specified, with these
/// communication parameters; does not compile if it cannot. `Granularity` is that of the EDS: entries begin and end at
/// multiples of this number of bits.
template <const Dictionary& D, std::uint16_t Number, class Layout, PdoParameters P = PdoParameters{},
          unsigned Granularity = 1>
using CheckedTpdo = pdo_detail::CheckedPdo<D, TpdoNumber<Number>, Layout, P, Granularity>;

/// The same for RPDO `Number`.
template <const Dictionary& D, std::uint16_t Number, class Layout, PdoParameters P = PdoParameters{},
          unsigned Granularity = 1>
using CheckedRpdo = pdo_detail::CheckedPdo<D, RpdoNumber<Number>, Layout, P, Granularity>;

/// Whether the valid ones among these CheckedTpdos and CheckedRpdos of a device have different COB-IDs for every
/// node-ID; does not compile if two are equal. Several RPDOs may have the same COB-ID.
template <class... Checked>
[[nodiscard]] constexpr bool distinct_cob_ids() {
  if constexpr (constexpr CobIdClash clash = pdo_detail::clash_of<Checked...>; clash.found) {
    using First = pdo_detail::NthOf<clash.first, Checked...>;
    using Second = pdo_detail::NthOf<clash.second, Checked...>;
    constexpr std::uint32_t id = First::cob_id.cob_id & 0x1FFF'FFFF;
    return pdo_detail::DistinctCobIds<typename First::Label, typename Second::Label, pdo_detail::CanIdLabel<id>,
                                      clash.found>::hold;
  }
  return true;
}

}  // namespace canopen
