/// PDO layouts as types: computed, checked and coded at compile time (CiA 301, 7.2.2).
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <tuple>
#include <type_traits>
#include <utility>

#include "canopen/dictionary.hpp"
#include "canopen/frame.hpp"
#include "canopen/object.hpp"

namespace canopen {

/// An entry of an RPDO that carries nothing for this device (CiA 301, 7.4.7.1: indices 0001h..0007h).
template <std::uint16_t DataTypeIndex, std::uint16_t Bits>
struct Dummy {
  using type = std::uint64_t;
  static constexpr std::uint16_t index = DataTypeIndex;
  static constexpr std::uint8_t sub_index = 0;
  static constexpr Access access = Access::wo;
  static constexpr Mappable mappable = Mappable::rpdo;
  static constexpr std::uint16_t bits = Bits;
};

/// An entry that takes more bits in a PDO than its type has: a BOOLEAN in a whole byte, as many devices send it.
template <class O, std::uint16_t Bits>
struct Padded : O {
  static_assert(Bits >= O::bits);
  static constexpr std::uint16_t bits = Bits;
};

template <class O>
inline constexpr bool is_dummy = O::index < 0x0020;

/// Has a length that is known without a value: strings and domains have not.
template <class O>
concept FixedLength = DictionaryObject<O> &&(O::bits > 0);

/// A TPDO may carry it: its data sheet says PDOMapping=1 and an access of ro, rw, rwr or const.
template <class O>
concept TpdoMappable = DictionaryObject<O> && allows(O::mappable, Mappable::tpdo);

/// An RPDO may carry it: its data sheet says PDOMapping=1 and an access of rw, rww or wo.
template <class O>
concept RpdoMappable = DictionaryObject<O> && allows(O::mappable, Mappable::rpdo);

namespace pdo_detail {

// One object each, so that the compiler's message names the one that is wrong.

template <class O>
struct PdoEntry {
  static_assert(FixedLength<O>, "a PDO carries no value without a fixed length: no strings and no domains");
  static constexpr bool fits = true;
};

template <class O>
struct TpdoEntry {
  static_assert(TpdoMappable<O>, "a TPDO may not carry this object: PDOMapping=0, or access wo or rww");
  static constexpr bool fits = true;
};

template <class O>
struct RpdoEntry {
  static_assert(RpdoMappable<O>, "an RPDO may not carry this object: PDOMapping=0, or access ro, rwr or const");
  static constexpr bool fits = true;
};

[[nodiscard]] constexpr std::uint64_t mask(unsigned bits) {
  return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
}

template <class T>
[[nodiscard]] constexpr std::uint64_t to_bits(const T& value) {
  if constexpr (std::is_same_v<T, float>) {
    return std::bit_cast<std::uint32_t>(value);
  } else if constexpr (std::is_same_v<T, double>) {
    return std::bit_cast<std::uint64_t>(value);
  } else if constexpr (std::is_same_v<T, TimeOfDay> || std::is_same_v<T, TimeDifference>) {
    return value.milliseconds | (static_cast<std::uint64_t>(value.days) << 32);
  } else {
    return static_cast<std::uint64_t>(value);
  }
}

template <class T, unsigned Bits>
[[nodiscard]] constexpr T from_bits(std::uint64_t raw) {
  if constexpr (std::is_same_v<T, float>) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(raw));
  } else if constexpr (std::is_same_v<T, double>) {
    return std::bit_cast<double>(raw);
  } else if constexpr (std::is_same_v<T, TimeOfDay> || std::is_same_v<T, TimeDifference>) {
    return T{static_cast<std::uint32_t>(raw), static_cast<std::uint16_t>(raw >> 32)};
  } else if constexpr (std::is_signed_v<T>) {
    constexpr unsigned unused = 64 - Bits;
    return static_cast<T>(static_cast<std::int64_t>(raw << unused) >> unused);
  } else {
    return static_cast<T>(raw);
  }
}

/// Bytes that `Bits` bits from bit `At` on touch.
template <unsigned At, unsigned Bits>
using TouchedBytes = std::make_index_sequence<(At % 8 + Bits + 7) / 8>;

/// Wide enough for `Bits` bits: shifts of 64 bits are dear on small controllers.
template <unsigned Bits>
using Raw = std::conditional_t<(Bits <= 32), std::uint32_t, std::uint64_t>;

/// What byte `I` of a value that begins at bit `Shift` of byte 0 holds.
template <unsigned Shift, std::size_t I, class Value>
[[nodiscard]] constexpr std::uint8_t byte_of(Value value) {
  if constexpr (I == 0) {
    return static_cast<std::uint8_t>(value << Shift);
  } else {
    return static_cast<std::uint8_t>(value >> (8 * I - Shift));
  }
}

/// The bits of a value that stand in byte `I`, at their place in the value.
template <class Value, unsigned Shift, std::size_t I>
[[nodiscard]] constexpr Value bits_of(std::uint8_t byte) {
  if constexpr (I == 0) {
    return static_cast<Value>(byte >> Shift);
  } else {
    return static_cast<Value>(Value{byte} << (8 * I - Shift));
  }
}

/// Puts the low `Bits` bits of `raw` at bit `At` of the data; what stood there is zero. Whole bytes become plain
/// stores.
template <unsigned At, unsigned Bits>
constexpr void put(std::array<std::uint8_t, 8>& data, std::uint64_t raw) {
  const auto value = static_cast<Raw<Bits>>(raw & mask(Bits));
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    if constexpr (At % 8 == 0 && Bits % 8 == 0) {
      ((data[At / 8 + I] = byte_of<0, I>(value)), ...);
    } else {
      ((data[At / 8 + I] = static_cast<std::uint8_t>(data[At / 8 + I] | byte_of<At % 8, I>(value))), ...);
    }
  }
  (TouchedBytes<At, Bits>{});
}

template <unsigned At, unsigned Bits>
[[nodiscard]] constexpr std::uint64_t take(const std::array<std::uint8_t, 8>& data) {
  using Value = Raw<Bits>;
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return (Value{0} | ... | bits_of<Value, At % 8, I>(data[At / 8 + I]));
  }
  (TouchedBytes<At, Bits>{}) & mask(Bits);
}

}  // namespace pdo_detail

/// The layout of a PDO made of `Objects`, in their order, low bit first. Known without a dictionary: a master or an
/// analyser uses it as well as the device.
template <DictionaryObject... Objects>
struct PdoLayout {
  static_assert((true && ... && pdo_detail::PdoEntry<Objects>::fits));
  static constexpr std::size_t entries = sizeof...(Objects);
  static constexpr unsigned bits = (0u + ... + Objects::bits);
  static_assert(entries <= 64, "a PDO maps 64 objects at most (CiA 301, 7.5.2.36)");
  static_assert(bits <= 64, "the objects of this PDO are longer than its 64 bits together (CiA 301, 7.5.2.36)");
  static constexpr std::uint8_t size = (bits + 7) / 8;  ///< data bytes of the frame

  using Data = std::array<std::uint8_t, 8>;
  using Values = std::tuple<typename Objects::type...>;

  /// First bit of each entry.
  static constexpr std::array<unsigned, entries + 1> offsets = [] {
    std::array<unsigned, entries + 1> at{};
    unsigned i = 0;
    ((at[i + 1] = at[i] + Objects::bits, ++i), ...);
    return at;
  }();

  /// Whether an object is among the entries.
  template <class O>
  static constexpr bool maps = ((O::index == Objects::index && O::sub_index == Objects::sub_index) || ...);

  /// The data bytes for these values.
  [[nodiscard]] static constexpr Data pack(const typename Objects::type&... values) {
    return pack_values(std::index_sequence_for<Objects...>{}, values...);
  }

  /// The values in these data bytes.
  [[nodiscard]] static constexpr Values unpack(const Data& data) {
    return unpack_values(data, std::index_sequence_for<Objects...>{});
  }

  /// Entry `I` of these data bytes.
  template <std::size_t I>
  [[nodiscard]] static constexpr auto get(const Data& data) {
    using O = std::tuple_element_t<I, std::tuple<Objects...>>;
    return pdo_detail::from_bits<typename O::type, O::bits>(pdo_detail::take<offsets[I], O::bits>(data));
  }

  /// Puts the value of entry `I` into data bytes where it is zero so far.
  template <std::size_t I>
  static constexpr void put(Data& data, const typename std::tuple_element_t<I, std::tuple<Objects...>>::type& value) {
    using O = std::tuple_element_t<I, std::tuple<Objects...>>;
    pdo_detail::put<offsets[I], O::bits>(data, pdo_detail::to_bits(value));
  }

  /// Calls `visit.template operator()<O, I>()` for each entry in order.
  template <class Visit>
  static constexpr void for_each(Visit&& visit) {
    [&]<std::size_t... I>(std::index_sequence<I...>) { (visit.template operator()<Objects, I>(), ...); }
    (std::index_sequence_for<Objects...>{});
  }

 private:
  template <std::size_t... I>
  [[nodiscard]] static constexpr Data pack_values(std::index_sequence<I...>, const typename Objects::type&... values) {
    Data data{};
    (pdo_detail::put<offsets[I], Objects::bits>(data, pdo_detail::to_bits(values)), ...);
    return data;
  }

  template <std::size_t... I>
  [[nodiscard]] static constexpr Values unpack_values([[maybe_unused]] const Data& data, std::index_sequence<I...>) {
    return Values{get<I>(data)...};
  }
};

/// A PDO that a device sends.
template <DictionaryObject... Objects>
struct Tpdo : PdoLayout<Objects...> {
  static_assert((true && ... && pdo_detail::TpdoEntry<Objects>::fits));
};

/// A PDO that a device receives.
template <DictionaryObject... Objects>
struct Rpdo : PdoLayout<Objects...> {
  static_assert((true && ... && pdo_detail::RpdoEntry<Objects>::fits));
};

}  // namespace canopen
