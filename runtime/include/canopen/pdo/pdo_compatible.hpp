/// Whether one device's RPDO can consume another's TPDO: both layouts agree on each bit that is used.
///
///     static_assert(canopen::compatible<drive::Tpdo2, plc::Rpdo1>);
///     static_assert(canopen::CompatiblePdos<drive::Tpdo2, plc::Rpdo1>::hold);  // names the entry that differs
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "canopen/base/fraction.hpp"
#include "canopen/base/label.hpp"
#include "canopen/base/verdict.hpp"
#include "canopen/od/typed_value.hpp"
#include "canopen/pdo/pdo.hpp"

namespace canopen {

namespace pdo_detail {

/// Meaning of an entry's bits; types of the same kind and length are compatible.
enum class EntryKind : std::uint8_t { boolean, unsigned_integer, signed_integer, real, time, string };

template <class Type>
[[nodiscard]] constexpr EntryKind kind_of() {
  if constexpr (Meaningful<Type>) {
    return kind_of<RawOf<Type>>();
  } else if constexpr (std::is_same_v<Type, bool>) {
    return EntryKind::boolean;
  } else if constexpr (std::is_floating_point_v<Type>) {
    return EntryKind::real;
  } else if constexpr (std::is_same_v<Type, TimeOfDay> || std::is_same_v<Type, TimeDifference>) {
    return EntryKind::time;
  } else if constexpr (StringValue<Type>) {
    return EntryKind::string;
  } else {
    return std::is_signed_v<Type> ? EntryKind::signed_integer : EntryKind::unsigned_integer;
  }
}

/// Whether each raw number is the same physical value in both units of a dimension: 0.001 s and ms.
template <class Unit, class Scale, class Offset, class OtherUnit, class OtherScale, class OtherOffset>
[[nodiscard]] constexpr bool has_same_raw_numbers() {
  if constexpr (std::is_same_v<Unit, OtherUnit>) {
    return std::is_same_v<Scale, OtherScale> && std::is_same_v<Offset, OtherOffset>;
  } else if constexpr (Unit::row.dimension != OtherUnit::row.dimension ||
                       !is_exact_conversion(Unit::row, OtherUnit::row)) {
    return false;
  } else {
    constexpr Fraction scale{Scale::num, Scale::den}, offset{Offset::num, Offset::den};
    constexpr Fraction other_scale{OtherScale::num, OtherScale::den}, other_offset{OtherOffset::num, OtherOffset::den};
    return convert(offset, Unit::row, OtherUnit::row) == other_offset &&
           convert(scale + offset, Unit::row, OtherUnit::row) == other_scale + other_offset;
  }
}

/// Whether two quantities have the same raw numbers. A value without unit is what its consumer takes it for.
template <class One, class Other>
inline constexpr bool is_same_quantity = true;
template <class One, class Unit, class Scale, class Offset, class Other, class OtherUnit, class OtherScale,
          class OtherOffset>
inline constexpr bool
    is_same_quantity<Quantity<One, Unit, Scale, Offset>, Quantity<Other, OtherUnit, OtherScale, OtherOffset>> =
        has_same_raw_numbers<Unit, Scale, Offset, OtherUnit, OtherScale, OtherOffset>();

enum class Link : std::uint8_t { fits, too_short, nothing_begins_there, other_length, other_kind, other_unit };

/// Placeholder in a message for a missing object.
struct NoObject {
  static constexpr std::uint16_t index = 0;
  static constexpr std::uint8_t sub_index = 0;
};

/// Returns the entry of a layout that begins at this bit; `entries` if none does.
template <class Layout>
[[nodiscard]] constexpr std::size_t entry_at(unsigned bit) {
  std::size_t i = 0;
  while (i < Layout::entries && Layout::offsets[i] != bit) ++i;
  return i;
}

template <class Layout, std::size_t Position>
[[nodiscard]] constexpr auto entry_or_none() {
  if constexpr (Position < Layout::entries) {
    return std::type_identity<typename Layout::template Entry<Position>>{};
  } else {
    return std::type_identity<NoObject>{};
  }
}

/// Entry `Position` of the consumer, and the producer's entry at the same bit. A dummy ignores its bits.
template <class Produced, class Consumed, std::size_t Position>
struct LinkOf {
  using Consumer = typename Consumed::template Entry<Position>;
  using Producer = typename decltype(entry_or_none<Produced, entry_at<Produced>(Consumed::offsets[Position])>())::type;

  static constexpr Link value = [] {
    if (Consumed::offsets[Position + 1] > Produced::bits) return Link::too_short;
    if constexpr (is_dummy<Consumer>) {
      return Link::fits;
    } else if constexpr (std::is_same_v<Producer, NoObject>) {
      return Link::nothing_begins_there;
    } else if constexpr (Producer::bits != Consumer::bits) {
      return Link::other_length;
    } else {
      if (kind_of<typename Producer::type>() != kind_of<typename Consumer::type>()) return Link::other_kind;
      return is_same_quantity<typename Producer::type, typename Consumer::type> ? Link::fits : Link::other_unit;
    }
  }();
};

template <class Produced, class Consumed>
[[nodiscard]] constexpr bool all_links_fit() {
  return []<std::size_t... Position>(std::index_sequence<Position...>) {
    return (true && ... && (LinkOf<Produced, Consumed, Position>::value == Link::fits));
  }
  (std::make_index_sequence<Consumed::entries>{});
}

/// Checks one entry of an RPDO, so that the compiler's message names both objects.
template <class Number, class ConsumerLabel, class Consumer, class ProducerLabel, class Producer, Link Found>
struct CompatibleEntry {
  static constexpr bool is_good = true;
  static_assert(Found != Link::too_short, "PDO link: the TPDO ends before this entry of the RPDO does");
  static_assert(Found != Link::nothing_begins_there,
                "PDO link: no entry of the TPDO begins where this one of the RPDO does");
  static_assert(Found != Link::other_length,
                "PDO link: the entry of the TPDO has another length than that of the RPDO");
  static_assert(Found != Link::other_kind, "PDO link: the entry of the TPDO is of another kind than that of the RPDO");
  static_assert(Found != Link::other_unit,
                "PDO link: the entry of the TPDO has another unit, scale or offset than that of the RPDO");
};

template <std::size_t Position, class Link>
using CheckedLink =
    CompatibleEntry<EntryNumber<Position + 1>, LabelOf<typename Link::Consumer>, typename Link::Consumer,
                    LabelOf<typename Link::Producer>, typename Link::Producer, Link::value>;

template <class Produced, class Consumed, std::size_t... Position>
[[nodiscard]] constexpr auto check_links(std::index_sequence<Position...> /*entries*/) {
  return canopen::first_failure(VerdictOf<LinkOf<Produced, Consumed, Position>::value == Link::fits,
                                          CheckedLink<Position, LinkOf<Produced, Consumed, Position>>>{}...);
}

}  // namespace pdo_detail

/// Whether the TPDO has, for every entry of the RPDO, one at the same bit, of the same length and kind: BOOLEAN,
/// unsigned, signed, real, time or string. A dummy is compatible with anything. The TPDO may be longer.
template <class Produced, class Consumed>
inline constexpr bool compatible = pdo_detail::all_links_fit<Produced, Consumed>();

/// The same check with a message that names the entry that differs and the objects on both sides.
template <class Produced, class Consumed>
struct CompatiblePdos {
  static constexpr bool hold = decltype(pdo_detail::check_links<Produced, Consumed>(
      std::make_index_sequence<Consumed::entries>{}))::type::is_good;
};

}  // namespace canopen
