/// Which PDOs of a device are multiplex PDOs, or can become one by SDO.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "canopen/can/cob_id.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/pdo/mpdo_lists.hpp"
#include "canopen/pdo/pdo_list.hpp"
#include "canopen/pdo/pdo_mapping.hpp"
#include "canopen/pdo/transmission_type.hpp"

namespace canopen {

/// The PDOs of one direction that are MPDOs or can become one by SDO; `Pdos` is the device's list. With a static
/// mapping, a PDO is an MPDO if it does not have a layout.
template <class Device, PdoIndices Indices, class Pdos>
class MultiplexedPdos {
  [[nodiscard]] static constexpr std::uint16_t communication_of(std::size_t place) {
    return static_cast<std::uint16_t>(Indices.communication + Pdos::numbers[place] - 1);
  }
  [[nodiscard]] static constexpr std::uint16_t mapping_of(std::size_t place) {
    return static_cast<std::uint16_t>(Indices.mapping + Pdos::numbers[place] - 1);
  }

  [[nodiscard]] static constexpr bool may_be(std::size_t place) {
    const Dictionary& dictionary = Device::dictionary;
    if (!dictionary.has(communication_of(place), pdo_parameter::cob_id)) return false;
    if (entry::wire_bytes(dictionary.find(mapping_of(place), 0)) != 1) return false;
    return Pdos::keys[place].empty() || mapping_capacity(dictionary, mapping_of(place)) != 0;
  }

 public:
  /// Location of its parameters; 0 or 1 is one that does not exist.
  struct Parameters {
    std::uint16_t number;
    entry::Word mapped_objects;
    entry::Word cob_id;
    entry::Word transmission_type;
    entry::Word inhibit_time;
  };

  static constexpr std::size_t count = [] {
    std::size_t sum = 0;
    if constexpr (Device::options.mpdo) {
      for (std::size_t i = 0; i < Pdos::count; ++i) sum += may_be(i) ? 1u : 0u;
    }
    return sum;
  }();

  static constexpr std::array<Parameters, count> rows = [] {
    std::array<Parameters, count> found{};
    if constexpr (count > 0) {
      const Dictionary& dictionary = Device::dictionary;
      std::size_t at = 0;
      for (std::size_t i = 0; i < Pdos::count; ++i) {
        if (!may_be(i)) continue;
        const std::uint16_t index = communication_of(i);
        found[at++] = {Pdos::numbers[i], dictionary.find(mapping_of(i), 0),
                       dictionary.find(index, pdo_parameter::cob_id),
                       dictionary.find(index, pdo_parameter::transmission_type),
                       dictionary.find(index, pdo_parameter::inhibit_time)};
      }
    }
    return found;
  }();

  /// Returns the one with this communication or mapping parameter; null if it cannot be an MPDO.
  [[nodiscard]] static const Parameters* with_parameter(std::uint16_t index) {
    for (const Parameters& row : rows) {
      if (((static_cast<unsigned>(row.number - 1) ^ index) & 0x1FF) == 0) return &row;
    }
    return nullptr;
  }

  /// Returns `source_multiplexed`, `destination_multiplexed`, or the number of mapped objects.
  [[nodiscard]] static std::uint32_t mode(EntryAccess<Device> entries, const Parameters& row) {
    return entries.number(row.mapped_objects);
  }

  [[nodiscard]] static bool event_driven(EntryAccess<Device> entries, const Parameters& row) {
    return row.transmission_type <= Dictionary::no_sub_index ||
           transmission_of(entries.number(row.transmission_type)) == Transmission::event_driven;
  }

  /// Returns the first usable one with this mode; null if there is none.
  [[nodiscard]] static const Parameters* find(EntryAccess<Device> entries, std::uint8_t wanted) {
    for (const Parameters& row : rows) {
      const auto is_usable = [&](auto... of_node) {
        return is_usable_by_pdo<Device>(entries.number(row.cob_id), of_node...);
      };
      if (mode(entries, row) == wanted && with_sheet<Device>(entries, is_usable) && event_driven(entries, row)) {
        return &row;
      }
    }
    return nullptr;
  }
};

/// The MPDOs that a device can have.
template <class Device>
struct MpdoFeatures {
  struct ListedRpdos : Device::Rpdos {};
  struct ListedTpdos : Device::Tpdos {};
  using Rpdos = MultiplexedPdos<Device, rpdo_indices, ListedRpdos>;
  using Tpdos = MultiplexedPdos<Device, tpdo_indices, ListedTpdos>;
  using Scanned = MpdoLists<Device, ScannedObjects>;
  using Dispatched = MpdoLists<Device, DispatchedObjects>;

  /// Whether an MPDO of this direction can contain an entry.
  [[nodiscard]] static constexpr bool carries(entry::Word word, entry::Word direction) {
    const std::uint8_t bytes = entry::wire_bytes(word);
    return word > Dictionary::no_sub_index && (word & direction) != 0 && bytes >= 1 && bytes <= 4;
  }

  /// Number of objects that a SAM-MPDO can contain.
  static constexpr std::size_t scannable = [] {
    std::size_t count = 0;
    if (!Device::options.mpdo) return count;
    Device::dictionary.for_each_entry(
        [&](std::uint16_t, std::uint8_t, entry::Word word) { count += carries(word, entry::tpdo) ? 1u : 0u; });
    return count;
  }();

  static constexpr bool receives = Rpdos::count > 0;
  static constexpr bool sends_destination = Tpdos::count > 0;
  static constexpr bool sends_source = sends_destination && Scanned::room > 0 && scannable > 0;
  static constexpr bool exists = receives || sends_destination;
};

}  // namespace canopen
