/// Copies values of 1..64 bits to and from a bit position of a PDO that is known at compile time: with plain loads
/// and stores where the processor supports them, with shifts and masks elsewhere. Least significant bit first (CiA
/// 301, 7.1).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "canopen/base/bit_copy.hpp"
#include "canopen/od/typed_value.hpp"
#include "canopen/od/value_bits.hpp"

namespace canopen::pdo_detail {

using value_detail::from_bits;
using value_detail::raw_of;
using value_detail::StringValue;
using value_detail::to_bits;

/// The data bytes of a frame; all eight may be accessed, whatever the length of the PDO.
using Data = std::array<std::uint8_t, 8>;

/// Whether the processor loads and stores words at any address, or only at aligned ones. A project may define
/// it for all its files: 1 or 0.
#ifdef CANOPEN_UNALIGNED_WORDS
inline constexpr bool unaligned_words = CANOPEN_UNALIGNED_WORDS != 0;
#elif defined(__x86_64__) || defined(__i386__) || defined(__ARM_FEATURE_UNALIGNED)
inline constexpr bool unaligned_words = true;
#else
inline constexpr bool unaligned_words = false;
#endif
inline constexpr bool little_endian = std::endian::native == std::endian::little;

[[nodiscard]] constexpr std::uint64_t mask(unsigned bits) {
  return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
}

/// Unsigned integer with at least `Bits` bits: 64-bit shifts are expensive on small controllers.
template <unsigned Bits>
using Raw = std::conditional_t<(Bits <= 32), std::uint32_t, std::uint64_t>;

/// Unsigned integer of 1, 2, 4 or 8 bytes.
template <unsigned Bytes>
using WordOf = std::conditional_t<
    Bytes == 1, std::uint8_t,
    std::conditional_t<Bytes == 2, std::uint16_t, std::conditional_t<Bytes == 4, std::uint32_t, std::uint64_t>>>;

/// Returns a value whose low `Bits` bits are valid; the others are undefined.
template <unsigned Bits, class Type>
[[nodiscard]] constexpr Raw<Bits> unmasked(const Type& value) {
  if constexpr (Bits > 32) {
    return to_bits(value);
  } else {
    return static_cast<std::uint32_t>(raw_of(value));
  }
}

/// Returns the low `Bits` bits of a value; the others are zero.
template <unsigned Bits, class Type>
[[nodiscard]] constexpr Raw<Bits> masked(const Type& value) {
  if constexpr (std::is_same_v<RawOf<Type>, bool>) {
    return unmasked<Bits>(value);
  } else {
    return unmasked<Bits>(value) & static_cast<Raw<Bits>>(mask(Bits));
  }
}

// ---- words in memory ----

/// Returns the alignment of byte `offset` if byte 0 is aligned to `align`.
[[nodiscard]] constexpr unsigned alignment_at(unsigned align, unsigned offset) {
  const unsigned both = align | offset;
  return both & (~both + 1);
}

/// Whether a word of `bytes` bytes may be loaded and stored with this alignment. Two words of 4 bytes replace one of 8.
[[nodiscard]] constexpr bool is_word(unsigned bytes, unsigned align) {
  if (bytes == 1) return true;
  return little_endian && (unaligned_words || align >= (bytes < 4 ? bytes : 4));
}

template <unsigned Bytes, unsigned Align>
[[nodiscard]] inline WordOf<Bytes> load_word(const std::uint8_t* at) {
  WordOf<Bytes> word;
  if constexpr (Align == 1) {
    std::memcpy(&word, at, Bytes);
  } else {
    std::memcpy(&word, __builtin_assume_aligned(at, Align), Bytes);
  }
  return word;
}

template <unsigned Bytes, unsigned Align>
inline void store_word(std::uint8_t* at, WordOf<Bytes> word) {
  std::memcpy(__builtin_assume_aligned(at, Align), &word, Bytes);
}

/// Stores the low `Bytes` bytes of a value with the widest words that are allowed.
template <unsigned Bytes, unsigned Align, class Value>
constexpr void store_bytes(std::uint8_t* at, Value value) {
  if constexpr (Bytes > 0) {
    constexpr unsigned word = is_word(8, Align) && Bytes >= 8   ? 8
                              : is_word(4, Align) && Bytes >= 4 ? 4
                              : is_word(2, Align) && Bytes >= 2 ? 2
                                                                : 1;
    if (std::is_constant_evaluated()) {
      for (unsigned i = 0; i < word; ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * i));
    } else {
      store_word<word, Align>(at, static_cast<WordOf<word>>(value));
    }
    if constexpr (Bytes > word) {
      store_bytes<Bytes - word, alignment_at(Align, word)>(at + word, static_cast<Value>(value >> (8 * word)));
    }
  }
}

// ---- entries ----

/// The word within the eight bytes that contains an entry; 0 bytes if it must be accessed byte by byte.
struct Window {
  unsigned first;  ///< byte
  unsigned bytes;
};

[[nodiscard]] constexpr Window window_of(unsigned at, unsigned bits, unsigned align) {
  for (const unsigned bytes : {1u, 2u, 4u, 8u}) {
    const unsigned byte = at / 8;
    const unsigned first = !unaligned_words ? byte / bytes * bytes : byte < 8 - bytes ? byte : 8 - bytes;
    if (is_word(bytes, alignment_at(align, first)) && at + bits <= 8 * (first + bytes)) return {first, bytes};
  }
  return {at / 8, 0};
}

/// Indices of the bytes that contain `Bits` bits from bit `At` on.
template <unsigned At, unsigned Bits>
using TouchedBytes = std::make_index_sequence<(At % 8 + Bits + 7) / 8>;

/// Returns byte `Position` of a value that begins at bit `Shift` of byte 0.
template <unsigned Shift, std::size_t Position, class Value>
[[nodiscard]] constexpr std::uint8_t byte_of(Value value) {
  if constexpr (Position == 0) {
    return static_cast<std::uint8_t>(value << Shift);
  } else {
    return static_cast<std::uint8_t>(value >> (8 * Position - Shift));
  }
}

/// Returns the bits of byte `Position` at their position in the value.
template <class Value, unsigned Shift, std::size_t Position>
[[nodiscard]] constexpr Value bits_of(std::uint8_t byte) {
  if constexpr (Position == 0) {
    return static_cast<Value>(byte >> Shift);
  } else {
    return static_cast<Value>(Value{byte} << (8 * Position - Shift));
  }
}

template <unsigned At, unsigned Bits>
[[nodiscard]] constexpr Raw<Bits> take_bytewise(const std::uint8_t* data) {
  using Value = Raw<Bits>;
  return [&]<std::size_t... Position>(std::index_sequence<Position...>) {
    return (Value{0} | ... | bits_of<Value, At % 8, Position>(data[At / 8 + Position]));
  }
  (TouchedBytes<At, Bits>{}) & static_cast<Value>(mask(Bits));
}

/// Returns the word to load for an entry among others: a shared one if it does not fill a word of its own.
[[nodiscard]] constexpr Window shared_window_of(unsigned at, unsigned bits, unsigned align) {
  const Window own = window_of(at, bits, align);
  const unsigned first = at / 32 * 4;
  const bool shares = 8 * own.bytes != bits && at + bits <= 8 * (first + 4) && is_word(4, align);
  return shares ? Window{first, 4} : own;
}

/// Returns the value of `Bits` bits from bit `At` on, which the window contains.
template <class Type, unsigned At, unsigned Bits, unsigned Align, unsigned First, unsigned Bytes>
[[nodiscard]] Type value_in_window(const Data& data) {
  const WordOf<Bytes> word = load_word<Bytes, alignment_at(Align, First)>(data.data() + First);
  constexpr unsigned shift = At - 8 * First;
  constexpr bool reaches_the_end = shift + Bits == 8 * Bytes;
  if constexpr (std::is_same_v<Type, bool>) {
    return (word & (mask(Bits) << shift)) != 0;
  } else if constexpr (std::is_integral_v<Type> && shift == 0 && Bits == 8 * sizeof(Type) && reaches_the_end) {
    return static_cast<Type>(word);
  } else if constexpr (std::is_signed_v<Type> && std::is_integral_v<Type> && reaches_the_end) {
    return static_cast<Type>(static_cast<std::make_signed_t<WordOf<Bytes>>>(word) >> shift);
  } else if constexpr (std::is_signed_v<Type> && std::is_integral_v<Type>) {
    using Word = Raw<8 * Bytes>;
    constexpr unsigned above = 8 * sizeof(Word) - shift - Bits;
    return static_cast<Type>(static_cast<std::make_signed_t<Word>>(Word{word} << above) >> (above + shift));
  } else {
    return from_bits<Type, Bits>(static_cast<Raw<Bits>>(word >> shift) & static_cast<Raw<Bits>>(mask(Bits)));
  }
}

/// Returns the value of `Bits` bits from bit `At` on, for data aligned to `Align`. `Shared`: other entries
/// are read too.
template <class Type, unsigned At, unsigned Bits, unsigned Align = 1, bool Shared = false>
[[nodiscard]] constexpr Type value_at(const Data& data) {
  if constexpr (Meaningful<Type>) {
    return from_raw<Type>(value_at<RawOf<Type>, At, Bits, Align, Shared>(data));
  } else {
    constexpr Window window = Shared ? shared_window_of(At, Bits, Align) : window_of(At, Bits, Align);
    if constexpr (window.bytes > 0) {
      if (!std::is_constant_evaluated())
        return value_in_window<Type, At, Bits, Align, window.first, window.bytes>(data);
    }
    return from_bits<Type, Bits>(take_bytewise<At, Bits>(data.data()));
  }
}

/// Writes the low `Bits` bits of a value at bit `At` of data, where the bits must be zero.
template <unsigned At, unsigned Bits, unsigned Align = 1, class Type>
constexpr void put(Data& data, const Type& value) {
  const Raw<Bits> raw = masked<Bits>(value);
  if constexpr (At % 8 == 0 && Bits % 8 == 0) {
    store_bytes<Bits / 8, alignment_at(Align, At / 8)>(data.data() + At / 8, raw);
  } else {
    [&]<std::size_t... Position>(std::index_sequence<Position...>) {
      ((data[At / 8 + Position] = static_cast<std::uint8_t>(data[At / 8 + Position] | byte_of<At % 8, Position>(raw))),
       ...);
    }
    (TouchedBytes<At, Bits>{});
  }
}

template <unsigned At, unsigned Bits>
constexpr void replace_bytewise(Data& data, Raw<Bits> raw) {
  constexpr auto all = static_cast<Raw<Bits>>(mask(Bits));
  [&]<std::size_t... Position>(std::index_sequence<Position...>) {
    ((data[At / 8 + Position] = static_cast<std::uint8_t>((data[At / 8 + Position] & ~byte_of<At % 8, Position>(all)) |
                                                          byte_of<At % 8, Position>(raw))),
     ...);
  }
  (TouchedBytes<At, Bits>{});
}

/// Writes the low `Bits` bits of a value at bit `At` of data, replacing the bits there.
template <unsigned At, unsigned Bits, unsigned Align = 1, class Type>
constexpr void replace(Data& data, const Type& value) {
  constexpr Window window = window_of(At, Bits, Align);
  if constexpr (At % 8 == 0 && Bits % 8 == 0) {
    store_bytes<Bits / 8, alignment_at(Align, At / 8)>(data.data() + At / 8, unmasked<Bits>(value));
  } else if constexpr (window.bytes == 0) {
    replace_bytewise<At, Bits>(data, masked<Bits>(value));
  } else {
    if (std::is_constant_evaluated()) return replace_bytewise<At, Bits>(data, masked<Bits>(value));
    constexpr unsigned align = alignment_at(Align, window.first);
    constexpr unsigned shift = At - 8 * window.first;
    constexpr bool reaches_the_end = At + Bits == 8 * (window.first + window.bytes);
    using Word = WordOf<window.bytes>;
    const Raw<Bits> raw = reaches_the_end ? unmasked<Bits>(value) : masked<Bits>(value);
    const Word word = load_word<window.bytes, align>(data.data() + window.first);
    constexpr auto others = static_cast<Word>(~(mask(Bits) << shift));
    const auto shifted = static_cast<Word>(Raw<8 * window.bytes>{raw} << shift);
    store_word<window.bytes, align>(data.data() + window.first, static_cast<Word>((word & others) | shifted));
  }
}

// ---- whole layouts ----

/// Whole bytes that are stored at once: one entry that begins and ends at a byte boundary, or several that share bytes.
struct Chunk {
  unsigned first = 0;  ///< bit
  unsigned bits = 0;
};

struct Chunks {
  std::array<Chunk, 8> rows{};
  std::size_t count = 0;
};

/// Returns the chunks of a layout, given the first bit of each entry and the end of the last one. Entries that share
/// bytes are collected in words of the processor.
template <std::size_t Count>
[[nodiscard]] constexpr Chunks chunks_of(const std::array<unsigned, Count>& offsets) {
  constexpr unsigned word_bits = 8 * sizeof(std::size_t);
  Chunks chunks;
  unsigned first = 0;
  unsigned entries = 0;
  for (std::size_t i = 1; i < Count; ++i) {
    const bool last = i + 1 == Count;
    ++entries;
    if (offsets[i] % 8 != 0 && !last) continue;
    const unsigned end = (offsets[i] + 7) / 8 * 8;
    const unsigned most = entries == 1 ? 64 : word_bits;
    for (; first < end; first += chunks.rows[chunks.count++].bits) {
      chunks.rows[chunks.count] = {first, end - first < most ? end - first : most};
    }
    entries = 0;
  }
  return chunks;
}

/// Unsigned integer for the bits of a chunk, no wider than necessary.
template <unsigned ChunkBits>
using ChunkWord = std::conditional_t<(ChunkBits <= 8), std::uint8_t, Raw<ChunkBits>>;

/// Returns the bits that an entry of `Bits` bits at bit `At` contributes to the chunk of `ChunkBits` bits at
/// bit `First`.
template <unsigned At, unsigned Bits, unsigned First, unsigned ChunkBits, class Type>
[[nodiscard]] constexpr ChunkWord<ChunkBits> part_of_chunk([[maybe_unused]] const Type& value) {
  using Word = ChunkWord<ChunkBits>;
  if constexpr (At >= First + ChunkBits || At + Bits <= First) {
    return 0;
  } else {
    constexpr bool reaches_the_end = At + Bits >= First + ChunkBits;
    const Raw<Bits> raw = reaches_the_end ? unmasked<Bits>(value) : masked<Bits>(value);
    if constexpr (At >= First) {
      return static_cast<Word>(static_cast<Raw<ChunkBits>>(raw) << (At - First));
    } else {
      return static_cast<Word>(raw >> (First - At));
    }
  }
}

}  // namespace canopen::pdo_detail
