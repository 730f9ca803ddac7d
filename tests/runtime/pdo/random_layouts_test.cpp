/// 10,000 random mappings, compared with bits that are copied one by one. A layout is a type: 300 of them are compiled,
/// or a sample of 100 (random_layouts/layouts_*.cpp). The 10,000 mappings known only at run time use bit_copy.hpp.
#include <gtest/gtest.h>

#include <array>
#include <canopen/base/bit_copy.hpp>
#include <cstdint>
#include <set>
#include <vector>

#include "random_layouts/random_layouts.hpp"

namespace {

using random_layouts::Codec;
using random_layouts::Data;
using random_layouts::Field;
using random_layouts::Fields;
using random_layouts::Kind;
using random_layouts::Random;
using Raw = std::array<std::uint64_t, 64>;

// ---- the reference implementation ----

void reference_put(Data& data, unsigned at, unsigned bits, std::uint64_t value) {
  for (unsigned i = 0; i < bits; ++i) {
    const auto bit = static_cast<std::uint8_t>(1u << ((at + i) % 8));
    if ((value >> i & 1) != 0) {
      data[(at + i) / 8] = static_cast<std::uint8_t>(data[(at + i) / 8] | bit);
    } else {
      data[(at + i) / 8] = static_cast<std::uint8_t>(data[(at + i) / 8] & ~bit);
    }
  }
}

std::uint64_t reference_take(const Data& data, unsigned at, unsigned bits) {
  std::uint64_t value = 0;
  for (unsigned i = 0; i < bits; ++i) {
    value |= std::uint64_t{data[(at + i) / 8] >> ((at + i) % 8) & 1u} << i;
  }
  return value;
}

unsigned bits_of(const Fields& fields) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < fields.count; ++i) sum += fields.rows[i].bits;
  return sum;
}

/// The bits of a valid value of an entry: in a text, only zeros follow the first 00h.
std::uint64_t random_raw(Random& random, const Field& field) {
  std::uint64_t raw = random.next();
  if (field.kind == Kind::text) {
    const unsigned length = random.below(field.bits / 8 + 1);
    raw |= 0x0101'0101'0101'0101;
    if (length < 8) raw &= (std::uint64_t{1} << (8 * length)) - 1;
  }
  return field.bits < 64 ? raw & ((std::uint64_t{1} << field.bits) - 1) : raw;
}

Data random_data(Random& random) {
  Data data;
  for (auto& byte : data) byte = static_cast<std::uint8_t>(random.next());
  return data;
}

// ---- layouts as types ----

std::vector<Codec> typed_layouts() {
  std::vector<Codec> codecs;
  random_layouts::add_layouts_1(codecs);
  random_layouts::add_layouts_2(codecs);
  random_layouts::add_layouts_3(codecs);
  random_layouts::add_layouts_4(codecs);
  random_layouts::add_layouts_5(codecs);
  return codecs;
}

void expect_packs_and_unpacks(const Codec& codec, Random& random) {
  const Fields& fields = codec.fields;
  Raw raw{};
  Data expected{};
  for (unsigned i = 0, at = 0; i < fields.count; at += fields.rows[i++].bits) {
    raw[i] = random_raw(random, fields.rows[i]);
    reference_put(expected, at, fields.rows[i].bits, raw[i]);
  }
  ASSERT_EQ(codec.packed(raw.data()), expected);

  canopen::Frame frame;
  frame.data = random_data(random);
  const Data before = frame.data;
  codec.pack(frame, raw.data());
  ASSERT_EQ(frame.size, (bits_of(fields) + 7) / 8);
  for (unsigned byte = 0; byte < 8; ++byte) {
    ASSERT_EQ(frame.data[byte], byte < frame.size ? expected[byte] : before[byte]) << byte;
  }

  Raw unpacked{};
  codec.unpack(frame, unpacked.data());
  ASSERT_EQ(unpacked, raw);
  Raw got{};
  codec.get(frame.data, got.data());
  ASSERT_EQ(got, raw);
}

void expect_sets_one_entry_only(const Codec& codec, Random& random) {
  Data data = random_data(random);
  Data expected = data;
  for (unsigned i = 0, at = 0; i < codec.fields.count; at += codec.fields.rows[i++].bits) {
    const std::uint64_t raw = random_raw(random, codec.fields.rows[i]);
    codec.set(data, i, raw);
    reference_put(expected, at, codec.fields.rows[i].bits, raw);
    ASSERT_EQ(data, expected) << "entry " << i;
  }
}

TEST(RandomLayouts, AreManyOfEveryKindAtManyBits) {
  const std::vector<Codec> codecs = typed_layouts();
  EXPECT_EQ(codecs.size(), random_layouts::layout_files * random_layouts::layouts_a_file);
  std::set<Kind> kinds;
  std::set<std::pair<unsigned, unsigned>> places;
  for (const Codec& codec : codecs) {
    for (unsigned i = 0, at = 0; i < codec.fields.count; at += codec.fields.rows[i++].bits) {
      kinds.insert(codec.fields.rows[i].kind);
      places.insert({at, codec.fields.rows[i].bits});
    }
  }
  EXPECT_EQ(kinds.size(), 7U);
  EXPECT_GT(places.size(), codecs.size() * 5 / 3);
}

TEST(RandomLayouts, PackAndUnpackAsBitByBit) {
  Random random{1};
  for (const Codec& codec : typed_layouts()) {
    for (int i = 0; i < 20; ++i) {
      ASSERT_NO_FATAL_FAILURE(expect_packs_and_unpacks(codec, random));
      ASSERT_NO_FATAL_FAILURE(expect_sets_one_entry_only(codec, random));
    }
  }
}

// ---- mappings known at run time ----

TEST(RandomMappings, TenThousandPackAndUnpackAsBitByBit) {
  std::set<std::vector<unsigned>> mappings;
  for (std::uint64_t seed = 0; mappings.size() < 10'000; ++seed) {
    const Fields fields = random_layouts::random_fields(seed);
    std::vector<unsigned> lengths;
    for (std::size_t i = 0; i < fields.count; ++i) lengths.push_back(fields.rows[i].bits);
    if (!mappings.insert(lengths).second) continue;

    Random random{seed};
    Data data = random_data(random);
    Data expected = data;
    Raw raw{};
    for (unsigned i = 0, at = 0; i < fields.count; at += fields.rows[i++].bits) {
      raw[i] = random.next();
      canopen::put_bits(data.data(), at, fields.rows[i].bits, raw[i]);
      reference_put(expected, at, fields.rows[i].bits, raw[i]);
    }
    ASSERT_EQ(data, expected) << "seed " << seed;
    for (unsigned i = 0, at = 0; i < fields.count; at += fields.rows[i++].bits) {
      ASSERT_EQ(canopen::take_bits(data.data(), at, fields.rows[i].bits), reference_take(data, at, fields.rows[i].bits))
          << "seed " << seed << ", entry " << i;
    }
  }
}

}  // namespace
