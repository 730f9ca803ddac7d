/// Checks of a device's PDOs while it is compiled: of those that edsc generates and of mappings that a user writes.
///
///     static_assert(canopen::CheckedTpdo<drive::dictionary, 1, MyTpdo1, canopen::PdoParameters{.cob_id = 0x180,
///                                        .plus_node_id = true}>::holds);
///
/// The compiler's message names the PDO, the entry, the object and the reason.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

#include "canopen/data_type.hpp"
#include "canopen/dictionary.hpp"
#include "canopen/pdo.hpp"
#include "canopen/pdo_label.hpp"
#include "canopen/pdo_parameters.hpp"

namespace canopen {

namespace pdo_detail {

/// Whether an entry of a mapping is as long as the object that the dictionary holds: a BOOLEAN may take a byte, a
/// string as many bytes as it has room for.
template <class O>
[[nodiscard]] constexpr bool length_fits(entry::Word word) {
  if (entry::is_boolean(word)) return O::bits == 1 || O::bits == 8;
  if constexpr (StringValue<typename O::type>) {
    return entry::is_string(word) && O::bits % 8 == 0 && O::bits <= 8 * O::type::capacity();
  } else {
    return O::bits == 8 * entry::wire_bytes(word);
  }
}

// One entry or PDO each, so that the compiler's message names it. What an earlier assertion says, a later one does not
// repeat.

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
  static_assert(!exists || !maps_nothing, "PDO mapping: the object cannot be mapped, its data sheet says PDOMapping=0");
  static_assert(!exists || maps_nothing || maps_here || Pdo::receive,
                "PDO mapping: a TPDO carries ro, rw, rwr and const objects, none that are rww or wo");
  static_assert(!exists || maps_nothing || maps_here || !Pdo::receive,
                "PDO mapping: an RPDO carries rw, rww and wo objects, none that are ro, rwr or const");
  static_assert(!exists || has_length,
                "PDO mapping: the object has no fixed length; a string needs FixedString, a DOMAIN cannot be mapped");
  static_assert(!exists || !has_length || length_fits<O>(word),
                "PDO mapping: the entry has another length than the object");
  static_assert(O::bits % Granularity == 0,
                "PDO mapping: the entry's length is no multiple of the device's Granularity");
  static_assert(End <= 64, "PDO mapping: the entry ends beyond the 64 bits of a PDO");
  static constexpr bool holds = true;
};

template <const Dictionary& D, class Pdo, class Number, class Label, class O, unsigned End, unsigned Granularity>
requires is_dummy<O>
struct CheckedEntry<D, Pdo, Number, Label, O, End, Granularity> {
  static constexpr const DataTypeRow* type = find_data_type(O::index);
  static constexpr bool has_length = type != nullptr && type->bits > 0;
  static_assert(Pdo::receive, "PDO mapping: only an RPDO has dummies");
  static_assert(has_length, "PDO mapping: a dummy is a data type of fixed length");
  static_assert(!has_length || type->bits == O::bits, "PDO mapping: the dummy has another length than its data type");
  static_assert(O::bits % Granularity == 0,
                "PDO mapping: the entry's length is no multiple of the device's Granularity");
  static_assert(End <= 64, "PDO mapping: the entry ends beyond the 64 bits of a PDO");
  static constexpr bool holds = true;
};

template <const Dictionary& D, class Pdo>
struct CheckedParameterObject {
  static constexpr std::uint16_t index = (Pdo::receive ? 0x1400 : 0x1800) + Pdo::number - 1;
  static_assert(Pdo::number >= 1 && Pdo::number <= 512, "PDO: its number is 1 to 512");
  static_assert(D.has(index, 1), "PDO: the device has no communication parameter for it");
};

template <class Pdo, class Id, bool Legal>
struct CheckedCobId {
  static_assert(Legal, "PDO: its COB-ID is restricted, or has more than 11 bits, for some node-ID (CiA 301, 7.3.5)");
};

template <class Pdo, unsigned TransmissionType>
struct CheckedTransmissionType {
  static_assert(transmission_type_is_legal(Pdo::receive, TransmissionType), "PDO: its transmission type is reserved");
};

template <class Pdo, unsigned TransmissionType, unsigned InhibitTime, unsigned EventTimer>
struct CheckedTimes {
  static_assert(InhibitTime == 0 || inhibit_time_is_used(Pdo::receive, TransmissionType),
                "PDO: an inhibit time is for TPDOs of transmission types 254 and 255");
  static_assert(EventTimer == 0 || event_timer_is_used(Pdo::receive, TransmissionType),
                "PDO: an event timer is for RPDOs, and for TPDOs of transmission types 254 and 255");
};

template <class Pdo, bool HasCompatibilityEntry>
struct CheckedCompatibilityEntry {
  static_assert(!HasCompatibilityEntry, "PDO: sub-index 4 of its communication parameter is reserved");
};

template <class Pdo, std::size_t Entries>
struct CheckedEntryCount {
  static_assert(Entries <= 64, "PDO mapping: a PDO maps 64 objects at most");
};

/// The CAN-ID that a message shows: where the node-ID is added, that of node 1.
[[nodiscard]] constexpr std::uint32_t shown_can_id(const PdoParameters& parameters) {
  return (parameters.cob_id & 0x1FFF'FFFF) + (parameters.plus_node_id ? 1 : 0);
}

template <const Dictionary& D, class Pdo, unsigned Granularity, class... O>
[[nodiscard]] constexpr bool entries_hold(const PdoLayout<O...>* /*layout*/) {
  using Layout = PdoLayout<O...>;
  return []<std::size_t... I>(std::index_sequence<I...>) {
    return (true && ... &&
            CheckedEntry<D, Pdo, EntryNumber<I + 1>, LabelOf<O>, O, Layout::offsets[I + 1], Granularity>::holds);
  }
  (std::index_sequence_for<O...>{});
}

template <const Dictionary& D, class Pdo, class Layout, PdoParameters P, unsigned Granularity>
struct CheckedPdo
    : CheckedParameterObject<D, Pdo>,
      CheckedCobId<Pdo, CanIdLabel<shown_can_id(P)>, cob_id_is_legal(P)>,
      CheckedTransmissionType<Pdo, P.transmission_type>,
      CheckedTimes<Pdo, P.transmission_type, P.inhibit_time, P.event_timer>,
      CheckedCompatibilityEntry<Pdo, !P.compatibility_entry && D.has(CheckedParameterObject<D, Pdo>::index, 4)>,
      CheckedEntryCount<Pdo, Layout::entries> {
  using Label = Pdo;
  static constexpr PdoCobId cob_id{Pdo::receive, P.cob_id, P.plus_node_id};
  static constexpr bool holds = entries_hold<D, Pdo, Granularity>(static_cast<const Layout*>(nullptr));
};

template <class First, class Second, class Id, bool Clash>
struct DistinctCobIds {
  static_assert(!Clash, "PDO: two of the device have the same COB-ID");
  static constexpr bool hold = !Clash;
};

template <class... Checked>
inline constexpr CobIdClash clash_of = [] {
  const std::array<PdoCobId, sizeof...(Checked)> cob_ids{Checked::cob_id...};
  return find_cob_id_clash(cob_ids);
}();

template <std::size_t I, class... Checked>
using NthOf = std::tuple_element_t<I, std::tuple<Checked...>>;

}  // namespace pdo_detail

/// `holds` when a layout may be TPDO `Number` of the device with this dictionary and, where they are given, with these
/// communication parameters; does not compile when it may not. `Granularity` is the one of the data sheet: entries
/// begin and end at multiples of so many bits.
template <const Dictionary& D, std::uint16_t Number, class Layout, PdoParameters P = PdoParameters{},
          unsigned Granularity = 1>
using CheckedTpdo = pdo_detail::CheckedPdo<D, TpdoNumber<Number>, Layout, P, Granularity>;

/// The same for RPDO `Number`.
template <const Dictionary& D, std::uint16_t Number, class Layout, PdoParameters P = PdoParameters{},
          unsigned Granularity = 1>
using CheckedRpdo = pdo_detail::CheckedPdo<D, RpdoNumber<Number>, Layout, P, Granularity>;

/// Whether the valid ones among these CheckedTpdos and CheckedRpdos of a device have COB-IDs of their own; does not
/// compile when two have the same, for whatever node-ID. Several RPDOs may have the same.
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
