/// Hand-written versions of the codecs of typed.cpp: memcpy for whole bytes, shifts and masks for bits.
#include <cstring>

#include "codecs.hpp"

namespace codec::by_hand {

namespace {

template <class T>
void store(std::uint8_t* at, T value) {
  std::memcpy(at, &value, sizeof value);
}

template <class T>
T load(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

}  // namespace

void pack_words(Data& data, std::uint16_t a, std::uint16_t b, std::int16_t c, std::uint16_t d) {
  store(&data[0], a);
  store(&data[2], b);
  store(&data[4], c);
  store(&data[6], d);
}
void pack_drive(Data& data, std::uint16_t a, std::int32_t b) {
  store(&data[0], a);
  store(&data[2], b);
}
void pack_mixed(Data& data, std::uint16_t a, std::int16_t b, std::uint32_t c) {
  store(&data[0], a);
  store(&data[2], b);
  store(&data[4], c);
}
void pack_bytes(Data& data, std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d, std::uint8_t e,
                std::uint8_t f, std::int8_t g, std::int8_t h) {
  data = {a, b, c, d, e, f, static_cast<std::uint8_t>(g), static_cast<std::uint8_t>(h)};
}
void pack_triples(Data& data, std::uint32_t a, std::uint16_t b, std::int32_t c) {
  std::memcpy(&data[0], &a, 3);
  store(&data[3], b);
  std::memcpy(&data[5], &c, 3);
}
void pack_real(Data& data, float a, std::uint32_t b) {
  store(&data[0], a);
  store(&data[4], b);
}
void pack_nibbles(Data& data, std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d, std::uint16_t e) {
  data[0] = static_cast<std::uint8_t>((a & 0xF) | (b << 4));
  data[1] = static_cast<std::uint8_t>((c & 0xF) | (d << 4));
  store(&data[2], e);
}
void pack_flags(Data& data, bool a, bool b, bool c, bool d, bool e, bool f, bool g, bool h, std::uint16_t i) {
  data[0] = static_cast<std::uint8_t>(a | (b << 1) | (c << 2) | (d << 3) | (e << 4) | (f << 5) | (g << 6) | (h << 7));
  store(&data[1], i);
}
void pack_twelves(Data& data, std::uint16_t a, std::int16_t b, std::uint16_t c, std::uint16_t d, std::int16_t e) {
  const std::uint32_t first = (a & 0xFFFU) | ((static_cast<std::uint32_t>(b) & 0xFFFU) << 12);
  const std::uint32_t second = (c & 0xFFFU) | ((d & 0xFFFU) << 12);
  std::memcpy(&data[0], &first, 3);
  std::memcpy(&data[3], &second, 3);
  store(&data[6], static_cast<std::uint16_t>(e & 0xFFF));
}
void pack_odd(Data& data, bool a, bool b, std::uint64_t c, std::int16_t d) {
  // 2 + 33 + 12 = 47 bits: four bytes of a, b and c, then the rest of c, and d
  const auto low = static_cast<std::uint32_t>(c);
  const auto high = static_cast<std::uint32_t>(c >> 32) & 1U;
  store(&data[0], static_cast<std::uint32_t>(a) | (static_cast<std::uint32_t>(b) << 1) | (low << 2));
  store(&data[4],
        static_cast<std::uint16_t>((low >> 30) | (high << 2) | ((static_cast<std::uint32_t>(d) & 0xFFFU) << 3)));
}

Data make_words(std::uint16_t a, std::uint16_t b, std::int16_t c, std::uint16_t d) {
  Data data;
  store(&data[0], a);
  store(&data[2], b);
  store(&data[4], c);
  store(&data[6], d);
  return data;
}
Data make_drive(std::uint16_t a, std::int32_t b) {
  Data data{};
  store(&data[0], a);
  store(&data[2], b);
  return data;
}

Words::Values unpack_words(const Data& data) {
  return {load<std::uint16_t>(&data[0]), load<std::uint16_t>(&data[2]), load<std::int16_t>(&data[4]),
          load<std::uint16_t>(&data[6])};
}
Drive::Values unpack_drive(const Data& data) { return {load<std::uint16_t>(&data[0]), load<std::int32_t>(&data[2])}; }
Mixed::Values unpack_mixed(const Data& data) {
  return {load<std::uint16_t>(&data[0]), load<std::int16_t>(&data[2]), load<std::uint32_t>(&data[4])};
}
Bytes::Values unpack_bytes(const Data& data) {
  return {data[0],
          data[1],
          data[2],
          data[3],
          data[4],
          data[5],
          static_cast<std::int8_t>(data[6]),
          static_cast<std::int8_t>(data[7])};
}
Triples::Values unpack_triples(const Data& data) {
  return {load<std::uint32_t>(&data[0]) & 0xFFFFFFU, load<std::uint16_t>(&data[3]), load<std::int32_t>(&data[4]) >> 8};
}
Real::Values unpack_real(const Data& data) { return {load<float>(&data[0]), load<std::uint32_t>(&data[4])}; }
Nibbles::Values unpack_nibbles(const Data& data) {
  const unsigned first = data[0];
  const unsigned second = data[1];
  return {static_cast<std::uint8_t>(first & 0xF), static_cast<std::uint8_t>(first >> 4),
          static_cast<std::uint8_t>(second & 0xF), static_cast<std::uint8_t>(second >> 4),
          load<std::uint16_t>(&data[2])};
}
Flags::Values unpack_flags(const Data& data) {
  const unsigned flags = data[0];
  return {(flags & 1) != 0,      (flags >> 1 & 1) != 0, (flags >> 2 & 1) != 0,
          (flags >> 3 & 1) != 0, (flags >> 4 & 1) != 0, (flags >> 5 & 1) != 0,
          (flags >> 6 & 1) != 0, (flags >> 7) != 0,     load<std::uint16_t>(&data[1])};
}
Twelves::Values unpack_twelves(const Data& data) {
  const auto first = load<std::uint32_t>(&data[0]);
  const auto second = load<std::uint32_t>(&data[3]);
  const auto third = load<std::uint16_t>(&data[6]);
  return {static_cast<std::uint16_t>(first & 0xFFF),
          static_cast<std::int16_t>(static_cast<std::int32_t>(first << 8) >> 20),
          static_cast<std::uint16_t>(second & 0xFFF), static_cast<std::uint16_t>(second >> 12 & 0xFFF),
          static_cast<std::int16_t>(static_cast<std::int32_t>(std::uint32_t{third} << 20) >> 20)};
}
Odd::Values unpack_odd(const Data& data) {
  const auto low = load<std::uint32_t>(&data[0]);
  const auto high = load<std::uint16_t>(&data[4]);
  const std::uint64_t value = (low >> 2) | (std::uint64_t{high & 7U} << 30);
  return {(low & 1) != 0, (low >> 1 & 1) != 0, value,
          static_cast<std::int16_t>(static_cast<std::int32_t>(std::uint32_t{high} << 17) >> 20)};
}

std::int32_t get_drive(const Data& data) { return load<std::int32_t>(&data[2]); }
std::int32_t get_triples(const Data& data) { return load<std::int32_t>(&data[4]) >> 8; }
std::uint8_t get_nibbles(const Data& data) { return data[0] >> 4; }
bool get_flags(const Data& data) { return (data[0] >> 5 & 1) != 0; }
std::int16_t get_twelves(const Data& data) { return static_cast<std::int16_t>(load<std::int16_t>(&data[1]) >> 4); }
std::uint64_t get_odd(const Data& data) { return load<std::uint64_t>(&data[0]) >> 2 & 0x1'FFFF'FFFF; }

void set_drive(Data& data, std::int32_t value) { store(&data[2], value); }
void set_nibbles(Data& data, std::uint8_t value) {
  data[0] = static_cast<std::uint8_t>((data[0] & 0x0F) | (value << 4));
}
void set_flags(Data& data, bool value) { data[0] = static_cast<std::uint8_t>((data[0] & ~0x20) | (value << 5)); }
void set_twelves(Data& data, std::int16_t value) {
  store(&data[1], static_cast<std::uint16_t>((load<std::uint16_t>(&data[1]) & 0xF) | (value << 4)));
}
void set_odd(Data& data, std::uint64_t value) {
  constexpr std::uint64_t mask = 0x1'FFFF'FFFF;
  store(&data[0], (load<std::uint64_t>(&data[0]) & ~(mask << 2)) | ((value & mask) << 2));
}

}  // namespace codec::by_hand
