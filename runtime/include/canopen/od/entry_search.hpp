/// The run-time search for an entry. The method is chosen at compile time for each dictionary: by runs of consecutive
/// indices, or by a perfect hash, which takes fewer instructions and usually more bytes.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "canopen/base/optimization.hpp"
#include "canopen/od/dictionary.hpp"

namespace canopen {

namespace entry_search {

using entry::Word;

/// Finds the last run that begins at or before the index, in the same number of steps for every index: unrolled, or for
/// size as a loop, which takes 28 bytes less and 30 instructions more of a Cortex-M0+.
template <class Device>
struct ByRuns {
  static constexpr const Dictionary& dictionary = Device::dictionary;
  static constexpr std::size_t bytes = dictionary.runs.size() * sizeof(Run);

  [[nodiscard]] static Word find(std::uint16_t index) {
    if constexpr (prefers_size) return dictionary.find_index(index);
    return dictionary.word_in(last_run<dictionary.runs.size() - 1>(dictionary.runs.data(), index), index);
  }

 private:
  template <std::size_t Count>
  [[nodiscard]] static const Run& last_run(const Run* runs, std::uint16_t index) {
    if constexpr (Count > 1) {
      if (runs[Count / 2].first <= index) runs += Count / 2;
      return last_run<Count - Count / 2>(runs, index);
    } else {
      return *runs;
    }
  }
};

/// A perfect hash by displacement: the high bits of a product select a bucket, the bits below them a position in a ring
/// of slots, and the displacement of the bucket moves that position to a slot that no other index uses. Only the first
/// slots are used, slightly more than there are indices.
template <class Device>
struct ByHash {
  static constexpr const Dictionary& dictionary = Device::dictionary;
  static constexpr std::size_t count = dictionary.entries.size();
  static constexpr unsigned slot_bits = static_cast<unsigned>(std::bit_width(count > 1 ? count - 1 : 1));
  static constexpr unsigned bucket_bits = slot_bits;
  static constexpr std::uint32_t slots = std::uint32_t{1} << slot_bits;
  static constexpr std::uint32_t buckets = std::uint32_t{1} << bucket_bits;
  static constexpr std::uint32_t last_slot = slots - 1;
  static constexpr std::uint32_t used_slots = std::min<std::uint32_t>(slots, count + count / 8 + 1);
  using Displacement = std::conditional_t<slot_bits <= 8, std::uint8_t, std::uint16_t>;
  static constexpr std::size_t bytes =
      slots * sizeof(std::uint16_t) + buckets * sizeof(Displacement) + (used_slots - count) * sizeof(Word);

  [[nodiscard]] static constexpr std::uint32_t hash(std::uint16_t index, std::uint32_t multiplier) {
    return index * multiplier;
  }
  [[nodiscard]] static constexpr std::uint32_t bucket_of(std::uint32_t hash) { return hash >> (32 - bucket_bits); }
  [[nodiscard]] static constexpr std::uint32_t place_of(std::uint32_t hash) {
    return hash >> (32 - bucket_bits - slot_bits);
  }

  struct Table {
    bool found = false;
    std::uint32_t multiplier = 0;
    std::array<std::uint16_t, slots> indices{};  ///< index in each slot; 0 for a free slot while the table is built
    std::array<Displacement, buckets> displacements{};
    std::array<Word, used_slots> words{};
  };

 private:
  /// The indices, grouped by bucket.
  struct Buckets {
    std::uint16_t ends[buckets]{};  ///< position after the last entry of each bucket
    std::uint16_t indices[count]{};
    Word words[count]{};
  };

  static constexpr void fill(Buckets& filled, std::uint32_t multiplier) {
    const Dictionary& source = dictionary;
    for (std::size_t run = 0; run + 1 < source.runs.size(); ++run) {
      const std::uint32_t length =
          static_cast<std::uint32_t>(source.runs[run + 1].position) - source.runs[run].position;
      for (std::uint32_t i = 0; i < length; ++i) {
        ++filled.ends[bucket_of(hash(static_cast<std::uint16_t>(source.runs[run].first + i), multiplier))];
      }
    }
    std::uint16_t begin = 0;
    for (std::uint16_t& end : filled.ends) {
      const std::uint16_t size = end;
      end = begin;
      begin = static_cast<std::uint16_t>(begin + size);
    }
    for (std::size_t run = 0; run + 1 < source.runs.size(); ++run) {
      for (std::uint32_t at = source.runs[run].position; at < source.runs[run + 1].position; ++at) {
        const auto index = static_cast<std::uint16_t>(source.runs[run].first + at - source.runs[run].position);
        std::uint16_t& end = filled.ends[bucket_of(hash(index, multiplier))];
        filled.indices[end] = index;
        filled.words[end++] = source.entries[at];
      }
    }
  }

  /// Places all indices of a bucket in free slots with this displacement; false if a slot is taken.
  static constexpr bool put(Table& made, const Buckets& filled, std::uint32_t begin, std::uint32_t end,
                            std::uint32_t displacement) {
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint32_t slot = (place_of(hash(filled.indices[i], made.multiplier)) + displacement) & last_slot;
      if (slot < used_slots && made.indices[slot] == 0) {
        made.indices[slot] = filled.indices[i];
        made.words[slot] = filled.words[i];
        continue;
      }
      while (i-- > begin)
        made.indices[(place_of(hash(filled.indices[i], made.multiplier)) + displacement) & last_slot] = 0;
      return false;
    }
    return true;
  }

  /// Builds a table, largest buckets first. The index of a bucket with a single one takes the next free slot.
  static constexpr Table table_by(std::uint32_t multiplier, std::uint32_t& tries) {
    Table made;
    made.multiplier = multiplier;
    Buckets filled;
    fill(filled, multiplier);
    std::uint32_t largest = 0;
    for (std::uint32_t bucket = 0, begin = 0; bucket < buckets; begin = filled.ends[bucket++]) {
      if (filled.ends[bucket] - begin > largest) largest = filled.ends[bucket] - begin;
    }
    std::uint32_t free = 0;
    for (std::uint32_t size = largest; size > 0; --size) {
      for (std::uint32_t bucket = 0, begin = 0; bucket < buckets; begin = filled.ends[bucket++]) {
        const std::uint32_t end = filled.ends[bucket];
        if (end - begin != size) continue;
        std::uint32_t displacement = 0;
        if (size == 1) {
          while (made.indices[free] != 0) ++free;
          displacement = (free - place_of(hash(filled.indices[begin], multiplier))) & last_slot;
        }
        while (displacement < slots && tries > 0 && !put(made, filled, begin, end, displacement)) {
          ++displacement;
          --tries;
        }
        if (displacement == slots || tries == 0) return made;
        made.displacements[bucket] = static_cast<Displacement>(displacement);
      }
    }
    // Unused slots get an index that is never looked up in them.
    for (std::uint16_t& index : made.indices) {
      if (index == 0) index = filled.indices[0];
    }
    made.found = true;
    return made;
  }

 public:
  /// Two indices of a bucket may have the same position. Other multipliers are then tried, up to a number of steps that
  /// compilers accept.
  static constexpr Table table = [] {
    Table made;
    std::uint32_t tries = 8192 + 4 * count;
    for (std::uint32_t multiplier = 0x9E37'79B1; !made.found && tries > 0; multiplier += 0x0101'0102) {
      tries -= std::min<std::uint32_t>(tries, count);
      made = table_by(multiplier, tries);
    }
    return made;
  }();

  [[nodiscard]] static Word find(std::uint16_t index) {
    const std::uint32_t product = hash(index, table.multiplier);
    const std::uint32_t slot = (place_of(product) + table.displacements[bucket_of(product)]) & last_slot;
    return table.indices[slot] == index ? table.words[slot] : Dictionary::no_object;
  }
};

/// Maximum number of indices: with more of them, the table takes too long to compile.
inline constexpr std::size_t max_hashed = 1024;

/// Whether a hash exists and is worthwhile: for speed, or if it takes less flash.
template <class Device, bool Fast>
[[nodiscard]] constexpr bool by_hash() {
  if constexpr (Device::dictionary.entries.size() <= max_hashed && Device::dictionary.runs.size() > 4 &&
                (Fast || ByHash<Device>::bytes < ByRuns<Device>::bytes)) {
    return ByHash<Device>::table.found;
  } else {
    return false;
  }
}

}  // namespace entry_search

/// The search of a device. Code that is compiled for size may use another one. For the device of bench/ref.eds, a hash
/// takes 316 bytes of flash, and saves 19 instructions of a transfer on a Cortex-M4.
template <class Device, bool Fast = !prefers_size>
using EntrySearch = std::conditional_t<entry_search::by_hash<Device, Fast>(), entry_search::ByHash<Device>,
                                       entry_search::ByRuns<Device>>;

}  // namespace canopen
