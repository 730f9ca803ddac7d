/// One sub-index of the communication parameters of all PDOs of a direction; in most devices they are in equally
/// spaced records.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/pdo/pdo_list.hpp"

namespace canopen {

/// `Pdos` is a PdoList, `First` the index of the parameter of PDO 1: 1400h or 1800h.
template <class Device, class Pdos, std::uint16_t First, std::uint8_t SubIndex>
class ParameterColumn {
 public:
  static constexpr std::size_t count = Pdos::count;

  static constexpr std::array<entry::Word, count> words = [] {
    std::array<entry::Word, count> rows{};
    for (std::size_t i = 0; i < count; ++i) {
      rows[i] = Device::dictionary.find(static_cast<std::uint16_t>(First + Pdos::numbers[i] - 1), SubIndex);
    }
    return rows;
  }();

  [[nodiscard]] static constexpr bool is_there(entry::Word word) { return word > Dictionary::no_sub_index; }

  /// Whether any PDO has this sub-index.
  static constexpr bool exists = std::ranges::any_of(words, is_there);

  /// Distance in bytes between consecutive PDOs.
  static constexpr unsigned stride = [] {
    if constexpr (count > 1) {
      return static_cast<unsigned>(words[1] - words[0]);
    } else {
      return 0u;
    }
  }();

  /// Whether all are values of one type in RAM, equally spaced.
  static constexpr bool is_regular = [] {
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_there(words[i]) || entry::place_of(words[i]) != entry::Place::ram) return false;
      if (words[i] != words[0] + stride * i) return false;
    }
    return true;
  }();

  /// Returns the unsigned value for PDO `i` of the list; `missing` if it does not exist.
  [[nodiscard]] static std::uint32_t get(EntryAccess<Device> entries, std::size_t i, std::uint32_t missing) {
    if constexpr (!exists) {
      return missing;
    } else if constexpr (is_regular) {
      return entries.template number_at<entry::size_of(words[0])>(entry::offset_of(words[0]) + stride * i);
    } else {
      return is_there(words[i]) ? entries.number(words[i]) : missing;
    }
  }
};

}  // namespace canopen
