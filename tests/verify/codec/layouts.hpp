/// The layouts whose codecs are compared with hand-written ones in instructions and time.
#pragma once

#include <canopen/pdo/pdo.hpp>
#include <cstdint>

namespace codec {

using Data = std::array<std::uint8_t, 8>;

template <std::uint8_t SubIndex, class T, std::uint16_t Bits = canopen::wire_bits<T>>
using Entry = canopen::Object<0x2000, SubIndex, T, canopen::Access::rw, canopen::Mappable::both, Bits>;

/// Four values of 16 bits.
using Words = canopen::PdoLayout<Entry<1, std::uint16_t>, Entry<2, std::uint16_t>, Entry<3, std::int16_t>,
                                 Entry<4, std::uint16_t>>;
/// A statusword and a position.
using Drive = canopen::PdoLayout<Entry<1, std::uint16_t>, Entry<2, std::int32_t>>;
/// Two values of 16 bits and one of 32.
using Mixed = canopen::PdoLayout<Entry<1, std::uint16_t>, Entry<2, std::int16_t>, Entry<3, std::uint32_t>>;
/// Eight bytes.
using Bytes =
    canopen::PdoLayout<Entry<1, std::uint8_t>, Entry<2, std::uint8_t>, Entry<3, std::uint8_t>, Entry<4, std::uint8_t>,
                       Entry<5, std::uint8_t>, Entry<6, std::uint8_t>, Entry<7, std::int8_t>, Entry<8, std::int8_t>>;
/// 24, 16 and 24 bits.
using Triples = canopen::PdoLayout<Entry<1, std::uint32_t, 24>, Entry<2, std::uint16_t>, Entry<3, std::int32_t, 24>>;
/// REAL32 and 32 bits.
using Real = canopen::PdoLayout<Entry<1, float>, Entry<2, std::uint32_t>>;
/// Four values of 4 bits and one of 16.
using Nibbles = canopen::PdoLayout<Entry<1, std::uint8_t, 4>, Entry<2, std::uint8_t, 4>, Entry<3, std::uint8_t, 4>,
                                   Entry<4, std::uint8_t, 4>, Entry<5, std::uint16_t>>;
/// Eight BOOLEANs and 16 bits.
using Flags = canopen::PdoLayout<Entry<1, bool>, Entry<2, bool>, Entry<3, bool>, Entry<4, bool>, Entry<5, bool>,
                                 Entry<6, bool>, Entry<7, bool>, Entry<8, bool>, Entry<9, std::uint16_t>>;
/// Five values of 12 bits.
using Twelves = canopen::PdoLayout<Entry<1, std::uint16_t, 12>, Entry<2, std::int16_t, 12>, Entry<3, std::uint16_t, 12>,
                                   Entry<4, std::uint16_t, 12>, Entry<5, std::int16_t, 12>>;
/// Two BOOLEANs, 33 bits across bytes, and 12 bits.
using Odd = canopen::PdoLayout<Entry<1, bool>, Entry<2, bool>, Entry<3, std::uint64_t, 33>, Entry<4, std::int16_t, 12>>;

/// A value of an entry with fewer bits than its type, for PdoLayout.
template <class Layout, std::size_t Position>
using In = canopen::CheckedValue<typename Layout::template Entry<Position>>;

}  // namespace codec
