/// The functions that typed.cpp and by_hand.cpp both define.
#pragma once

#include "layouts.hpp"

namespace codec::typed {

void pack_words(Data& data, std::uint16_t a, std::uint16_t b, std::int16_t c, std::uint16_t d);
void pack_drive(Data& data, std::uint16_t a, std::int32_t b);
void pack_mixed(Data& data, std::uint16_t a, std::int16_t b, std::uint32_t c);
void pack_bytes(Data& data, std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d, std::uint8_t e,
                std::uint8_t f, std::int8_t g, std::int8_t h);
void pack_triples(Data& data, In<Triples, 0> a, std::uint16_t b, In<Triples, 2> c);
void pack_real(Data& data, float a, std::uint32_t b);
void pack_nibbles(Data& data, In<Nibbles, 0> a, In<Nibbles, 1> b, In<Nibbles, 2> c, In<Nibbles, 3> d, std::uint16_t e);
void pack_flags(Data& data, bool a, bool b, bool c, bool d, bool e, bool f, bool g, bool h, std::uint16_t i);
void pack_twelves(Data& data, In<Twelves, 0> a, In<Twelves, 1> b, In<Twelves, 2> c, In<Twelves, 3> d, In<Twelves, 4> e);
void pack_odd(Data& data, bool a, bool b, In<Odd, 2> c, In<Odd, 3> d);

Data make_words(std::uint16_t a, std::uint16_t b, std::int16_t c, std::uint16_t d);
Data make_drive(std::uint16_t a, std::int32_t b);

Words::Values unpack_words(const Data& data);
Drive::Values unpack_drive(const Data& data);
Mixed::Values unpack_mixed(const Data& data);
Bytes::Values unpack_bytes(const Data& data);
Triples::Values unpack_triples(const Data& data);
Real::Values unpack_real(const Data& data);
Nibbles::Values unpack_nibbles(const Data& data);
Flags::Values unpack_flags(const Data& data);
Twelves::Values unpack_twelves(const Data& data);
Odd::Values unpack_odd(const Data& data);

std::int32_t get_drive(const Data& data);
std::int32_t get_triples(const Data& data);
std::uint8_t get_nibbles(const Data& data);
bool get_flags(const Data& data);
std::int16_t get_twelves(const Data& data);
std::uint64_t get_odd(const Data& data);

void set_drive(Data& data, std::int32_t value);
void set_nibbles(Data& data, In<Nibbles, 1> value);
void set_flags(Data& data, bool value);
void set_twelves(Data& data, In<Twelves, 1> value);
void set_odd(Data& data, In<Odd, 2> value);

}  // namespace codec::typed

namespace codec::by_hand {

void pack_words(Data& data, std::uint16_t a, std::uint16_t b, std::int16_t c, std::uint16_t d);
void pack_drive(Data& data, std::uint16_t a, std::int32_t b);
void pack_mixed(Data& data, std::uint16_t a, std::int16_t b, std::uint32_t c);
void pack_bytes(Data& data, std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d, std::uint8_t e,
                std::uint8_t f, std::int8_t g, std::int8_t h);
void pack_triples(Data& data, std::uint32_t a, std::uint16_t b, std::int32_t c);
void pack_real(Data& data, float a, std::uint32_t b);
void pack_nibbles(Data& data, std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d, std::uint16_t e);
void pack_flags(Data& data, bool a, bool b, bool c, bool d, bool e, bool f, bool g, bool h, std::uint16_t i);
void pack_twelves(Data& data, std::uint16_t a, std::int16_t b, std::uint16_t c, std::uint16_t d, std::int16_t e);
void pack_odd(Data& data, bool a, bool b, std::uint64_t c, std::int16_t d);

Data make_words(std::uint16_t a, std::uint16_t b, std::int16_t c, std::uint16_t d);
Data make_drive(std::uint16_t a, std::int32_t b);

Words::Values unpack_words(const Data& data);
Drive::Values unpack_drive(const Data& data);
Mixed::Values unpack_mixed(const Data& data);
Bytes::Values unpack_bytes(const Data& data);
Triples::Values unpack_triples(const Data& data);
Real::Values unpack_real(const Data& data);
Nibbles::Values unpack_nibbles(const Data& data);
Flags::Values unpack_flags(const Data& data);
Twelves::Values unpack_twelves(const Data& data);
Odd::Values unpack_odd(const Data& data);

std::int32_t get_drive(const Data& data);
std::int32_t get_triples(const Data& data);
std::uint8_t get_nibbles(const Data& data);
bool get_flags(const Data& data);
std::int16_t get_twelves(const Data& data);
std::uint64_t get_odd(const Data& data);

void set_drive(Data& data, std::int32_t value);
void set_nibbles(Data& data, std::uint8_t value);
void set_flags(Data& data, bool value);
void set_twelves(Data& data, std::int16_t value);
void set_odd(Data& data, std::uint64_t value);

}  // namespace codec::by_hand
