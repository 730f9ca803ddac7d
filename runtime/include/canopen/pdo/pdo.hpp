/// PDO layouts as types, which are computed, checked, packed and unpacked at compile time (CiA 301, 7.2.2).
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <tuple>
#include <utility>

#include "canopen/base/label.hpp"
#include "canopen/base/verdict.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/value_for.hpp"
#include "canopen/pdo/pdo_codec.hpp"

namespace canopen {

/// A dummy entry of an RPDO, which this device ignores (CiA 301, 7.4.7.1: indices 0001h..0008h).
template <std::uint16_t DataTypeIndex, std::uint16_t Bits>
struct Dummy {
  using type = std::uint64_t;
  static constexpr std::uint16_t index = DataTypeIndex;
  static constexpr std::uint8_t sub_index = 0;
  static constexpr Access access = Access::wo;
  static constexpr Mappable mappable = Mappable::rpdo;
  static constexpr std::uint16_t bits = Bits;
};

/// An entry that occupies more bits in a PDO than its type has: a BOOLEAN in a whole byte, as many devices send it.
template <class Object, std::uint16_t Bits>
struct Padded : Object {
  static_assert(Bits >= Object::bits);
  static constexpr std::uint16_t bits = Bits;
};

/// A string with a fixed number of bytes in a PDO: text is padded with 00h and ends at the first one, octet strings
/// always have this length.
template <class Object, std::uint16_t Bytes>
struct FixedString : Object {
  static constexpr std::uint16_t bits = Bytes * 8;
  static_assert(value_detail::StringValue<typename Object::type>, "only a string has a length to be fixed");
  static_assert(Bytes <= Object::type::capacity(), "the entry is longer than the string can be");
};

inline constexpr std::uint16_t first_object = 0x0020;  ///< indices below are those of data types

template <class Object>
inline constexpr bool is_dummy = Object::index < first_object;

/// An object whose length does not depend on its value: not a string or DOMAIN.
template <class Object>
concept FixedLength = DictionaryObject<Object> &&(Object::bits > 0);

/// An object that can be mapped into a TPDO: the EDS has PDOMapping=1 and access ro, rw, rwr or const.
template <class Object>
concept TpdoMappable = DictionaryObject<Object> && allows(Object::mappable, Mappable::tpdo);

/// An object that can be mapped into an RPDO: the EDS has PDOMapping=1 and access rw, rww or wo.
template <class Object>
concept RpdoMappable = DictionaryObject<Object> && allows(Object::mappable, Mappable::rpdo);

namespace pdo_detail {

inline constexpr unsigned frame_data_align = 4;
static_assert(offsetof(Frame, data) % frame_data_align == 0 && alignof(Frame) % frame_data_align == 0);

template <class OneObject, class OtherObject>
inline constexpr bool same_object =
    OneObject::index == OtherObject::index&& OneObject::sub_index == OtherObject::sub_index;

template <class Layout, class Label, bool Found, class Object>
struct MappedObject {
  static constexpr bool is_good = true;
  static_assert(Found, "this PDO does not map the object");
};

template <class Object, class Call>
struct CalledParameter : value_for_detail::CheckedParameter<Object> {};

/// CheckedParameterFor<Object> of a function template, which the compiler makes only for a function that is called: a
/// device with a thousand layouts compiles in half the time.
template <class Object, class Call>
using ParameterOfCall = typename CalledParameter<Object, Call>::type;

// Checks one entry at a time, so that the compiler's message names the wrong one.

template <class Number, class Label, class Object, bool HasLength, bool Fits>
struct PdoEntry {
  static constexpr bool is_good = true;
  static_assert(HasLength, "a PDO carries no value without a fixed length: no DOMAIN, and strings as FixedString only");
  static_assert(Fits, "the objects of this PDO are longer than its 64 bits together (CiA 301, 7.5.2.36)");
};

template <class Number, class Label, class Object>
struct TpdoEntry {
  static constexpr bool passes = TpdoMappable<Object>;
  static constexpr bool is_good = true;
  static_assert(Object::mappable != Mappable::no, "a TPDO may not carry this object: PDOMapping=0");
  static_assert(Object::mappable == Mappable::no || passes,
                "a TPDO may not carry this object: its access is wo or rww");
};

template <class Number, class Label, class Object>
struct RpdoEntry {
  static constexpr bool passes = RpdoMappable<Object>;
  static constexpr bool is_good = true;
  static_assert(Object::mappable != Mappable::no, "an RPDO may not carry this object: PDOMapping=0");
  static_assert(Object::mappable == Mappable::no || passes,
                "an RPDO may not carry this object: its access is ro, rwr or const");
};

/// Whether each object can be mapped into a PDO of this direction.
template <class... Objects, std::size_t... Position>
[[nodiscard]] constexpr auto check_tpdo(std::index_sequence<Position...> /*entries*/) {
  if constexpr ((allows(Objects::mappable, Mappable::tpdo) && ...))
    return canopen::first_failure();
  else
    return canopen::first_failure(
        VerdictOf<TpdoMappable<Objects>, TpdoEntry<EntryNumber<Position + 1>, LabelOf<Objects>, Objects>>{}...);
}
template <class... Objects, std::size_t... Position>
[[nodiscard]] constexpr auto check_rpdo(std::index_sequence<Position...> /*entries*/) {
  if constexpr ((allows(Objects::mappable, Mappable::rpdo) && ...))
    return canopen::first_failure();
  else
    return canopen::first_failure(
        VerdictOf<RpdoMappable<Objects>, RpdoEntry<EntryNumber<Position + 1>, LabelOf<Objects>, Objects>>{}...);
}

/// First bit of each entry of these lengths, and the end of the last one.
template <std::size_t Entries>
[[nodiscard]] constexpr std::array<unsigned, Entries + 1> offsets_of(const std::array<unsigned, Entries>& bits) {
  std::array<unsigned, Entries + 1> at{};
  for (std::size_t i = 0; i < Entries; ++i) at[i + 1] = at[i] + bits[i];
  return at;
}

/// Whether entries of these lengths, none of which is 0, fit into a frame.
[[nodiscard]] constexpr bool fit_into_a_frame(std::initializer_list<unsigned> bits) {
  unsigned end = 0;
  for (const unsigned length : bits) {
    if (length == 0) return false;
    end += length;
  }
  return end <= 64;
}

template <class... Objects>
inline constexpr std::array<unsigned, sizeof...(Objects)> lengths_of{Objects::bits...};

/// Whether an object has a fixed length and ends within the frame. Only the first object that does not end within it is
/// reported; more than 64 objects are reported by the layout.
template <class Number, class Object, unsigned Begin, bool IsReported>
[[nodiscard]] constexpr auto check_entry_room() {
  constexpr bool has_length = Object::bits > 0;
  constexpr bool fits = Begin > 64 || Begin + Object::bits <= 64;
  constexpr bool passes = !IsReported || (has_length && fits);
  return VerdictOf<passes, PdoEntry<Number, LabelOf<Object>, Object, has_length, fits>>{};
}
template <class... Objects, std::size_t... Position>
[[nodiscard]] constexpr auto check_room(std::index_sequence<Position...> /*entries*/) {
  if constexpr (fit_into_a_frame({Objects::bits...}))
    return canopen::first_failure();
  else
    return canopen::first_failure(
        check_entry_room<EntryNumber<Position + 1>, Objects, offsets_of(lengths_of<Objects...>)[Position],
                         sizeof...(Objects) <= 64>()...);
}

}  // namespace pdo_detail

/// The layout of a PDO made of `Objects`, in their order, least significant bit first. It does not need a dictionary: a
/// master or an analyser can use it as well as the device.
///
/// Each function takes the data bytes of a frame, or the frame. The alignment of a frame's data is known, which saves
/// instructions on processors that need aligned words.
template <DictionaryObject... Objects>
struct PdoLayout {
  static constexpr std::size_t entries = sizeof...(Objects);
  static_assert(entries <= 64, "a PDO maps 64 objects at most (CiA 301, 7.5.2.36)");
  static_assert(decltype(pdo_detail::check_room<Objects...>(std::index_sequence_for<Objects...>{}))::type::is_good);
  static constexpr unsigned bits = (0u + ... + Objects::bits);
  static constexpr std::uint8_t size = (bits + 7) / 8;  ///< data bytes of the frame

  using Data = std::array<std::uint8_t, 8>;
  using Values = std::tuple<typename Objects::type...>;

  /// First bit of each entry, and the end of the last one.
  static constexpr std::array<unsigned, entries + 1> offsets =
      pdo_detail::offsets_of(pdo_detail::lengths_of<Objects...>);

  /// The object of entry `Position`.
  template <std::size_t Position>
  using Entry = std::tuple_element_t<Position, std::tuple<Objects...>>;

  /// Whether an object is mapped.
  template <class Object>
  static constexpr bool maps = (pdo_detail::same_object<Object, Objects> || ...);

  /// Position of the entry that maps an object, from 0; the first one if there are several.
  template <class Object>
  static constexpr std::size_t position_of = [] {
    std::size_t position = 0;
    static_cast<void>(((pdo_detail::same_object<Object, Objects> || (++position, false)) || ...));
    return maps<Object> ? position : 0;
  }();

  /// Returns the data bytes for these values. A value has the type of its object or a narrower one, or is a constant,
  /// whose limits the compiler checks. A variable for an object with limits, or with fewer bits than its type, is a
  /// CheckedValue. Anything else does not compile.
  template <class Call = void>
  [[nodiscard]] static constexpr Data pack(pdo_detail::ParameterOfCall<Objects, Call>... values) {
    Data data{};
    pack_aligned<1>(data, value_for_detail::value_in(values)...);
    return data;
  }

  /// Writes these values to the first `size` bytes.
  template <class Call = void>
  static constexpr void pack_into(Data& data, pdo_detail::ParameterOfCall<Objects, Call>... values) {
    pack_aligned<1>(data, value_for_detail::value_in(values)...);
  }

  /// The same for values of exactly the types of the objects, whose range and limits have been checked, and data at an
  /// address that is a multiple of four, as in a frame.
  template <class... Types>
  requires(std::same_as<Types, typename Objects::type>&&...) static constexpr void pack_into_words(
      Data& data, const Types&... values) {
    pack_aligned<pdo_detail::frame_data_align>(data, values...);
  }

  /// The same for a frame; sets its length.
  template <class Call = void>
  static constexpr void pack_into(Frame& frame, pdo_detail::ParameterOfCall<Objects, Call>... values) {
    frame.size = size;
    pack_aligned<pdo_detail::frame_data_align>(frame.data, value_for_detail::value_in(values)...);
  }

  /// Returns the values in these data bytes.
  [[nodiscard]] static constexpr Values unpack(const Data& data) {
    return unpack_aligned<1>(data, std::index_sequence_for<Objects...>{});
  }
  [[nodiscard]] static constexpr Values unpack(const Frame& frame) {
    return unpack_aligned<pdo_detail::frame_data_align>(frame.data, std::index_sequence_for<Objects...>{});
  }

  /// Returns the value of entry `Position` of these data bytes.
  template <std::size_t Position>
  [[nodiscard]] static constexpr typename Entry<Position>::type get(const Data& data) {
    return get_aligned<Position, 1>(data);
  }
  template <std::size_t Position>
  [[nodiscard]] static constexpr typename Entry<Position>::type get(const Frame& frame) {
    return get_from_words<Position>(frame.data);
  }

  /// The same for data at an address that is a multiple of four.
  template <std::size_t Position>
  [[nodiscard]] static constexpr typename Entry<Position>::type get_from_words(const Data& data) {
    return get_aligned<Position, pdo_detail::frame_data_align>(data);
  }

  /// Returns the value of an object in these data bytes.
  template <DictionaryObject Object>
  [[nodiscard]] static constexpr typename Object::type get(const Data& data) {
    static_assert(pdo_detail::MappedObject<PdoLayout, pdo_detail::LabelOf<Object>, maps<Object>, Object>::is_good);
    return get_aligned<position_of<Object>, 1>(data);
  }
  template <DictionaryObject Object>
  [[nodiscard]] static constexpr typename Object::type get(const Frame& frame) {
    static_assert(pdo_detail::MappedObject<PdoLayout, pdo_detail::LabelOf<Object>, maps<Object>, Object>::is_good);
    return get_aligned<position_of<Object>, pdo_detail::frame_data_align>(frame.data);
  }

  /// Sets the value of entry `Position`. All other bits keep their value.
  template <std::size_t Position>
  static constexpr void set(Data& data, CheckedParameterFor<Entry<Position>> value) {
    replace<Position, 1>(data, value_for_detail::value_in(value));
  }
  template <std::size_t Position>
  static constexpr void set(Frame& frame, CheckedParameterFor<Entry<Position>> value) {
    replace<Position, pdo_detail::frame_data_align>(frame.data, value_for_detail::value_in(value));
  }

  /// Sets the value of an object. All other bits keep their value.
  template <DictionaryObject Object>
  static constexpr void set(Data& data, CheckedParameterFor<Object> value) {
    static_assert(pdo_detail::MappedObject<PdoLayout, pdo_detail::LabelOf<Object>, maps<Object>, Object>::is_good);
    replace<position_of<Object>, 1>(data, value_for_detail::value_in(value));
  }
  template <DictionaryObject Object>
  static constexpr void set(Frame& frame, CheckedParameterFor<Object> value) {
    static_assert(pdo_detail::MappedObject<PdoLayout, pdo_detail::LabelOf<Object>, maps<Object>, Object>::is_good);
    replace<position_of<Object>, pdo_detail::frame_data_align>(frame.data, value_for_detail::value_in(value));
  }

  /// Sets the value of entry `Position`, whose bits must be zero.
  template <std::size_t Position>
  static constexpr void put(Data& data, CheckedParameterFor<Entry<Position>> value) {
    pdo_detail::put<offsets[Position], Entry<Position>::bits>(data, value_for_detail::value_in(value));
  }
  template <std::size_t Position>
  static constexpr void put(Frame& frame, CheckedParameterFor<Entry<Position>> value) {
    pdo_detail::put<offsets[Position], Entry<Position>::bits, pdo_detail::frame_data_align>(
        frame.data, value_for_detail::value_in(value));
  }

  /// Calls `visit.template operator()<Object, Position>()` for each entry in order.
  template <class Visit>
  static constexpr void for_each(Visit&& visit) {
    [&]<std::size_t... Position>(std::index_sequence<Position...>) {
      (visit.template operator()<Objects, Position>(), ...);
    }
    (std::index_sequence_for<Objects...>{});
  }

 private:
  template <std::size_t Position, unsigned Align>
  static constexpr void replace(Data& data, const typename Entry<Position>::type& value) {
    pdo_detail::replace<offsets[Position], Entry<Position>::bits, Align>(data, value);
  }

  template <unsigned Align>
  static constexpr void pack_aligned([[maybe_unused]] Data& data, const typename Objects::type&... values) {
    constexpr pdo_detail::Chunks chunks = pdo_detail::chunks_of(offsets);
    [&]<std::size_t... Part>(std::index_sequence<Part...>) {
      (store_chunk<Align, chunks.rows[Part].first, chunks.rows[Part].bits>(data, std::index_sequence_for<Objects...>{},
                                                                           values...),
       ...);
    }
    (std::make_index_sequence<chunks.count>{});
  }

  template <unsigned Align, unsigned First, unsigned Bits, std::size_t... Position>
  static constexpr void store_chunk(Data& data, std::index_sequence<Position...>,
                                    const typename Objects::type&... values) {
    pdo_detail::store_bytes<Bits / 8, pdo_detail::alignment_at(Align, First / 8)>(
        data.data() + First / 8,
        static_cast<pdo_detail::ChunkWord<Bits>>(
            (pdo_detail::ChunkWord<Bits>{0} | ... |
             pdo_detail::part_of_chunk<offsets[Position], Objects::bits, First, Bits>(values))));
  }

  template <std::size_t Position, unsigned Align>
  [[nodiscard]] static constexpr typename Entry<Position>::type get_aligned(const Data& data) {
    return pdo_detail::value_at<typename Entry<Position>::type, offsets[Position], Entry<Position>::bits, Align>(data);
  }

  template <unsigned Align, std::size_t... Position>
  [[nodiscard]] static constexpr Values unpack_aligned([[maybe_unused]] const Data& data,
                                                       std::index_sequence<Position...>) {
    return Values{pdo_detail::value_at<typename Objects::type, offsets[Position], Objects::bits, Align, true>(data)...};
  }
};

/// A PDO that a device transmits.
template <DictionaryObject... Objects>
struct Tpdo : PdoLayout<Objects...> {
  static constexpr bool has_direction = true;
  static_assert(decltype(pdo_detail::check_tpdo<Objects...>(std::index_sequence_for<Objects...>{}))::type::is_good);
};

/// A PDO that a device receives.
template <DictionaryObject... Objects>
struct Rpdo : PdoLayout<Objects...> {
  static constexpr bool has_direction = true;
  static_assert(decltype(pdo_detail::check_rpdo<Objects...>(std::index_sequence_for<Objects...>{}))::type::is_good);
};

}  // namespace canopen
