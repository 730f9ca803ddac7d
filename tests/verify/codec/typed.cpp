/// Codecs of PdoLayout. by_hand.cpp has the same functions without it.
#include "codecs.hpp"

namespace codec::typed {

void pack_words(Data& data, std::uint16_t a, std::uint16_t b, std::int16_t c, std::uint16_t d) {
  Words::pack_into(data, a, b, c, d);
}
void pack_drive(Data& data, std::uint16_t a, std::int32_t b) { Drive::pack_into(data, a, b); }
void pack_mixed(Data& data, std::uint16_t a, std::int16_t b, std::uint32_t c) { Mixed::pack_into(data, a, b, c); }
void pack_bytes(Data& data, std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d, std::uint8_t e,
                std::uint8_t f, std::int8_t g, std::int8_t h) {
  Bytes::pack_into(data, a, b, c, d, e, f, g, h);
}
void pack_triples(Data& data, In<Triples, 0> a, std::uint16_t b, In<Triples, 2> c) {
  Triples::pack_into(data, a, b, c);
}
void pack_real(Data& data, float a, std::uint32_t b) { Real::pack_into(data, a, b); }
void pack_nibbles(Data& data, In<Nibbles, 0> a, In<Nibbles, 1> b, In<Nibbles, 2> c, In<Nibbles, 3> d, std::uint16_t e) {
  Nibbles::pack_into(data, a, b, c, d, e);
}
void pack_flags(Data& data, bool a, bool b, bool c, bool d, bool e, bool f, bool g, bool h, std::uint16_t i) {
  Flags::pack_into(data, a, b, c, d, e, f, g, h, i);
}
void pack_twelves(Data& data, In<Twelves, 0> a, In<Twelves, 1> b, In<Twelves, 2> c, In<Twelves, 3> d,
                  In<Twelves, 4> e) {
  Twelves::pack_into(data, a, b, c, d, e);
}
void pack_odd(Data& data, bool a, bool b, In<Odd, 2> c, In<Odd, 3> d) { Odd::pack_into(data, a, b, c, d); }

Data make_words(std::uint16_t a, std::uint16_t b, std::int16_t c, std::uint16_t d) { return Words::pack(a, b, c, d); }
Data make_drive(std::uint16_t a, std::int32_t b) { return Drive::pack(a, b); }

Words::Values unpack_words(const Data& data) { return Words::unpack(data); }
Drive::Values unpack_drive(const Data& data) { return Drive::unpack(data); }
Mixed::Values unpack_mixed(const Data& data) { return Mixed::unpack(data); }
Bytes::Values unpack_bytes(const Data& data) { return Bytes::unpack(data); }
Triples::Values unpack_triples(const Data& data) { return Triples::unpack(data); }
Real::Values unpack_real(const Data& data) { return Real::unpack(data); }
Nibbles::Values unpack_nibbles(const Data& data) { return Nibbles::unpack(data); }
Flags::Values unpack_flags(const Data& data) { return Flags::unpack(data); }
Twelves::Values unpack_twelves(const Data& data) { return Twelves::unpack(data); }
Odd::Values unpack_odd(const Data& data) { return Odd::unpack(data); }

std::int32_t get_drive(const Data& data) { return Drive::get<1>(data); }
std::int32_t get_triples(const Data& data) { return Triples::get<2>(data); }
std::uint8_t get_nibbles(const Data& data) { return Nibbles::get<1>(data); }
bool get_flags(const Data& data) { return Flags::get<5>(data); }
std::int16_t get_twelves(const Data& data) { return Twelves::get<1>(data); }
std::uint64_t get_odd(const Data& data) { return Odd::get<2>(data); }

void set_drive(Data& data, std::int32_t value) { Drive::set<1>(data, value); }
void set_nibbles(Data& data, In<Nibbles, 1> value) { Nibbles::set<1>(data, value); }
void set_flags(Data& data, bool value) { Flags::set<5>(data, value); }
void set_twelves(Data& data, In<Twelves, 1> value) { Twelves::set<1>(data, value); }
void set_odd(Data& data, In<Odd, 2> value) { Odd::set<2>(data, value); }

}  // namespace codec::typed
