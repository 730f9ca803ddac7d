/// PDO layouts as types, generated from pseudo-random numbers at compile time.
#pragma once

#include <array>
#include <canopen/pdo/pdo.hpp>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace random_layouts {

using Data = std::array<std::uint8_t, 8>;

enum class Kind : std::uint8_t { boolean, unsigned_integer, signed_integer, real, time, text, octets };

struct Field {
  Kind kind = Kind::boolean;
  unsigned bits = 0;
};

struct Fields {
  std::array<Field, 64> rows{};
  std::size_t count = 0;
};

/// A linear congruential generator of 64 bits (Knuth, MMIX).
class Random {
 public:
  constexpr explicit Random(std::uint64_t seed) : state_{seed} { static_cast<void>(next()); }

  constexpr std::uint64_t next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return state_ ^ (state_ >> 29);
  }
  /// A number from 0 to limit - 1.
  constexpr unsigned below(unsigned limit) { return static_cast<unsigned>((next() >> 32) % limit); }

 private:
  std::uint64_t state_;
};

/// An entry of at most `room` bits.
constexpr Field random_field(Random& random, unsigned room) {
  const unsigned dice = random.below(16);
  if (dice < 2) return {Kind::boolean, 1};
  if (dice == 2 && room >= 32) return {Kind::real, room >= 64 && random.below(2) == 0 ? 64u : 32u};
  if (dice == 3 && room >= 48) return {Kind::time, 48};
  if (dice == 4 && room >= 8)
    return {random.below(2) == 0 ? Kind::text : Kind::octets, 8 * (1 + random.below(room / 8))};
  const Kind kind = random.below(2) == 0 ? Kind::signed_integer : Kind::unsigned_integer;
  const bool short_one = random.below(2) == 0;
  const unsigned most = short_one && room > 16 ? 16 : room;
  return {kind, 1 + random.below(most)};
}

/// The entries of one PDO: it ends at random or when the frame is full.
constexpr Fields random_fields(std::uint64_t seed) {
  Random random{seed};
  Fields fields;
  unsigned room = 64;
  do {
    const Field field = random_field(random, room);
    fields.rows[fields.count++] = field;
    room -= field.bits;
  } while (room > 0 && random.below(12) != 0);
  return fields;
}

template <unsigned Bits, class OfOne, class OfTwo, class OfFour, class OfEight>
using ByLength =
    std::conditional_t<(Bits <= 8), OfOne,
                       std::conditional_t<(Bits <= 16), OfTwo, std::conditional_t<(Bits <= 32), OfFour, OfEight>>>;

template <Kind K, unsigned Bits>
struct TypeOf;
template <unsigned Bits>
struct TypeOf<Kind::boolean, Bits> {
  using type = bool;
};
template <unsigned Bits>
struct TypeOf<Kind::unsigned_integer, Bits> {
  using type = ByLength<Bits, std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t>;
};
template <unsigned Bits>
struct TypeOf<Kind::signed_integer, Bits> {
  using type = ByLength<Bits, std::int8_t, std::int16_t, std::int32_t, std::int64_t>;
};
template <unsigned Bits>
struct TypeOf<Kind::real, Bits> {
  using type = std::conditional_t<Bits == 32, float, double>;
};
template <unsigned Bits>
struct TypeOf<Kind::time, Bits> {
  using type = canopen::TimeOfDay;
};
template <unsigned Bits>
struct TypeOf<Kind::text, Bits> {
  using type = canopen::VisibleString<8>;
};
template <unsigned Bits>
struct TypeOf<Kind::octets, Bits> {
  using type = canopen::OctetString<8>;
};

template <std::uint64_t Seed>
inline constexpr Fields fields_of = random_fields(Seed);

template <std::uint64_t Seed, std::size_t I>
using EntryOf =
    canopen::Object<0x2000, I + 1, typename TypeOf<fields_of<Seed>.rows[I].kind, fields_of<Seed>.rows[I].bits>::type,
                    canopen::Access::rw, canopen::Mappable::both, fields_of<Seed>.rows[I].bits>;

template <std::uint64_t Seed, class Positions>
struct LayoutOf;
template <std::uint64_t Seed, std::size_t... I>
struct LayoutOf<Seed, std::index_sequence<I...>> {
  using type = canopen::PdoLayout<EntryOf<Seed, I>...>;
};

/// A layout as functions of raw bits, so that one test covers all layouts.
struct Codec {
  Fields fields;
  void (*pack)(canopen::Frame& frame, const std::uint64_t* raw);
  Data (*packed)(const std::uint64_t* raw);
  void (*unpack)(const canopen::Frame& frame, std::uint64_t* raw);
  void (*get)(const Data& data, std::uint64_t* raw);
  void (*set)(Data& data, std::size_t entry, std::uint64_t raw);
};

template <class Entry>
typename Entry::type value_of(std::uint64_t raw) {
  return canopen::value_detail::from_bits<typename Entry::type, Entry::bits>(raw);
}
/// The same as a parameter of a codec.
template <class Entry>
auto parameter_of(std::uint64_t raw) {
  const auto value = value_of<Entry>(raw);
  if constexpr (canopen::rejects_values<Entry>) {
    return *canopen::CheckedValue<Entry>::from(value);
  } else {
    return value;
  }
}
template <class Entry>
std::uint64_t raw_of(const typename Entry::type& value) {
  return canopen::value_detail::to_bits(value) & canopen::pdo_detail::mask(Entry::bits);
}

template <std::uint64_t Seed, std::size_t... I>
Codec codec_of(std::index_sequence<I...> positions) {
  using Layout = typename LayoutOf<Seed, decltype(positions)>::type;
  return {fields_of<Seed>,
          [](canopen::Frame& frame, const std::uint64_t* raw) {
            Layout::pack_into(frame, parameter_of<typename Layout::template Entry<I>>(raw[I])...);
          },
          [](const std::uint64_t* raw) {
            return Layout::pack(parameter_of<typename Layout::template Entry<I>>(raw[I])...);
          },
          [](const canopen::Frame& frame, std::uint64_t* raw) {
            const auto values = Layout::unpack(frame);
            ((raw[I] = raw_of<typename Layout::template Entry<I>>(std::get<I>(values))), ...);
          },
          [](const Data& data, std::uint64_t* raw) {
            ((raw[I] = raw_of<typename Layout::template Entry<I>>(Layout::template get<I>(data))), ...);
          },
          [](Data& data, std::size_t entry, std::uint64_t raw) {
            static_cast<void>(
                ((entry == I &&
                  (Layout::template set<I>(data, parameter_of<typename Layout::template Entry<I>>(raw)), true)) ||
                 ...));
          }};
}

/// The layouts of `Count` seeds, starting with `First`.
template <std::uint64_t First, std::size_t... I>
void add_codecs(std::vector<Codec>& codecs, std::index_sequence<I...>) {
  (codecs.push_back(codec_of<First + I>(std::make_index_sequence<fields_of<First + I>.count>{})), ...);
}

#ifndef EDSC_LAYOUTS_A_FILE
#define EDSC_LAYOUTS_A_FILE 60
#endif
inline constexpr std::size_t layouts_a_file = EDSC_LAYOUTS_A_FILE;
inline constexpr std::size_t layout_files = 5;

// One translation unit each, so that they compile in parallel.
void add_layouts_1(std::vector<Codec>& codecs);
void add_layouts_2(std::vector<Codec>& codecs);
void add_layouts_3(std::vector<Codec>& codecs);
void add_layouts_4(std::vector<Codec>& codecs);
void add_layouts_5(std::vector<Codec>& codecs);

}  // namespace random_layouts
