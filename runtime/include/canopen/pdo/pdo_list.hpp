/// The PDOs of a device, by number, and the location of their parameters in its dictionary.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include "canopen/od/dictionary.hpp"
#include "canopen/od/sheet.hpp"
#include "canopen/pdo/pdo.hpp"

namespace canopen {

/// Indices of the parameters of the first PDO of each direction (CiA 301, 7.5.2.35 to 7.5.2.38).
struct PdoIndices {
  std::uint16_t communication;
  std::uint16_t mapping;
};
inline constexpr PdoIndices rpdo_indices{0x1400, 0x1600};
inline constexpr PdoIndices tpdo_indices{0x1800, 0x1A00};

/// Sub-indices of a PDO communication parameter.
namespace pdo_parameter {
inline constexpr std::uint8_t cob_id = 1;
inline constexpr std::uint8_t transmission_type = 2;
inline constexpr std::uint8_t inhibit_time = 3;
inline constexpr std::uint8_t event_timer = 5;
inline constexpr std::uint8_t sync_start = 6;
}  // namespace pdo_parameter

/// A PDO of a device: its number (from 1) and its layout. The parameters are objects 1400h or 1800h + number - 1.
template <std::uint16_t Number, class Layout>
struct NumberedPdo : Layout {
  static constexpr std::uint16_t number = Number;
};

namespace pdo_detail {

/// The keys of the objects of a layout, in their order.
template <class... Objects>
inline constexpr std::array<std::uint32_t, sizeof...(Objects)> layout_keys{
    object_key(Objects::index, Objects::sub_index)...};
template <class... Objects>
[[nodiscard]] constexpr std::span<const std::uint32_t> keys_of(const PdoLayout<Objects...>* /*layout*/) {
  return layout_keys<Objects...>;
}

}  // namespace pdo_detail

/// A device has up to 512 PDOs of a direction. What is needed of each of them is in arrays. The compiler's time for a
/// function whose name contains the list grows with the square of their number: g++ compares each type in the name with
/// all others. Services therefore use a class that derives from the list.
template <class... Pdos>
struct PdoList {
  static constexpr std::size_t count = sizeof...(Pdos);
  using All = PdoList;  ///< of a class that derives from the list

  // Of each PDO:
  static constexpr std::array<std::uint16_t, count> numbers{Pdos::number...};
  static constexpr std::array<std::uint8_t, count> sizes{Pdos::size...};  ///< data bytes of the default mapping
  static constexpr std::array<std::span<const std::uint32_t>, count> keys{
      pdo_detail::keys_of(static_cast<const Pdos*>(nullptr))...};

  /// Calls `visit.template operator()<Pdo, Position>()` for each PDO in order.
  template <class Visit>
  static constexpr void for_each([[maybe_unused]] Visit&& visit) {
    visit_all(visit, std::index_sequence_for<Pdos...>{});
  }

 private:
  template <class Visit, std::size_t... Position>
  [[gnu::always_inline]] static constexpr void visit_all([[maybe_unused]] Visit& visit,
                                                         std::index_sequence<Position...>) {
    // Not a fold: Clang accepts 256 operands at most.
    [[maybe_unused]] const bool visited[] = {true, (visit.template operator()<Pdos, Position>(), true)...};
  }
};

/// Returns how many objects can be mapped into a PDO by SDO; 0: the mapping is static. It is dynamic if the mapping
/// parameter is in RAM, with consecutive entries from sub-index 1 on.
[[nodiscard]] constexpr std::uint8_t mapping_capacity(const Dictionary& dictionary, std::uint16_t mapping) {
  const auto in_ram = [](entry::Word word) {
    return word > Dictionary::no_sub_index && entry::place_of(word) == entry::Place::ram;
  };
  const entry::Word first = dictionary.find(mapping, 1);
  if (!in_ram(dictionary.find(mapping, 0)) || !in_ram(first)) return 0;
  constexpr std::uint8_t most = 64;
  std::uint8_t capacity = 1;
  while (capacity < most) {
    const entry::Word next = dictionary.find(mapping, static_cast<std::uint8_t>(capacity + 1));
    if (!in_ram(next) || entry::offset_of(next) != entry::offset_of(first) + 4u * capacity) break;
    ++capacity;
  }
  return capacity;
}

namespace pdo_detail {

/// Whether a PDO maps an object, or can do so, and its COB-ID is in the dictionary.
[[nodiscard]] constexpr bool is_served(const Dictionary& dictionary, PdoIndices indices, std::uint16_t number,
                                       bool maps_objects) {
  const auto mapping = static_cast<std::uint16_t>(indices.mapping + number - 1);
  const auto communication = static_cast<std::uint16_t>(indices.communication + number - 1);
  return (maps_objects || mapping_capacity(dictionary, mapping) > 0) &&
         dictionary.has(communication, pdo_parameter::cob_id);
}

/// The PDOs of several lists.
template <class... Lists>
struct Joined;
template <>
struct Joined<> {
  using type = PdoList<>;
};
template <class... Application>
struct Joined<PdoList<Application...>> {
  using type = PdoList<Application...>;
};
template <class... First, class... Second, class... Rest>
struct Joined<PdoList<First...>, PdoList<Second...>, Rest...> : Joined<PdoList<First..., Second...>, Rest...> {};
template <class... First, class... Second, class... Third, class... Fourth, class... Fifth, class... Sixth,
          class... Seventh, class... Handler, class... Rest>
struct Joined<PdoList<First...>, PdoList<Second...>, PdoList<Third...>, PdoList<Fourth...>, PdoList<Fifth...>,
              PdoList<Sixth...>, PdoList<Seventh...>, PdoList<Handler...>, Rest...>
    : Joined<PdoList<First..., Second..., Third..., Fourth..., Fifth..., Sixth..., Seventh..., Handler...>, Rest...> {};

template <class List>
struct Whole {
  using type = List;
};

template <const Dictionary& DeviceDictionary, PdoIndices Indices, class List>
struct Some;
template <const Dictionary& DeviceDictionary, PdoIndices Indices, class... PdoType>
struct Some<DeviceDictionary, Indices, PdoList<PdoType...>>
    : Joined<std::conditional_t<is_served(DeviceDictionary, Indices, PdoType::number, PdoType::entries != 0),
                                PdoList<PdoType>, PdoList<>>...> {};

template <const Dictionary& DeviceDictionary, PdoIndices Indices, class List>
struct Served {
  static constexpr bool all = [] {
    for (std::size_t i = 0; i < List::count; ++i) {
      if (!is_served(DeviceDictionary, Indices, List::numbers[i], !List::keys[i].empty())) return false;
    }
    return true;
  }();
  using type = typename std::conditional_t<all, Whole<List>, Some<DeviceDictionary, Indices, typename List::All>>::type;
};

/// Whether the PDOs of a list are numbered from 1 without gaps.
template <class Pdos>
inline constexpr bool counts_from_one = [] {
  for (std::size_t i = 0; i < Pdos::count; ++i) {
    if (Pdos::numbers[i] != i + 1) return false;
  }
  return true;
}();

}  // namespace pdo_detail

/// Returns the numbers of the PDOs of a sheet at the places of the type's list.
template <PdoIndices Indices, class Sheet>
[[nodiscard]] const auto& numbers_in(const Sheet& sheet) {
  if constexpr (Indices.communication == rpdo_indices.communication) {
    return sheet.rpdo_numbers;
  } else {
    return sheet.tpdo_numbers;
  }
}

/// Returns the number of the PDO at a position in a list.
template <class Pdos>
[[nodiscard]] constexpr std::uint16_t number_of_pdo(std::size_t place) {
  if constexpr (pdo_detail::counts_from_one<Pdos>) {
    return static_cast<std::uint16_t>(place + 1);
  } else {
    return Pdos::numbers[place];
  }
}

/// Returns the position in a list of the PDO whose communication or mapping parameter has this index; `Pdos::count` if
/// it does not exist.
template <class Pdos>
[[nodiscard]] constexpr std::size_t place_of_pdo(std::uint16_t index) {
  const std::size_t place = index & 0x1FFu;
  if constexpr (pdo_detail::counts_from_one<Pdos>) {
    return place < Pdos::count ? place : Pdos::count;
  } else {
    std::size_t i = 0;
    while (i < Pdos::count && Pdos::numbers[i] != place + 1) ++i;
    return i;
  }
}

/// The same for the PDO of a node; its sheet may have other numbers than the list.
template <class Device, PdoIndices Indices, class Pdos, class OfNode>
[[nodiscard]] constexpr std::uint16_t number_of_pdo(std::size_t place, [[maybe_unused]] const OfNode& of_node) {
  if constexpr (has_sheet<Device>) {
    const auto& numbers = numbers_in<Indices>(Device::sheet_of(of_node));
    return place < numbers.size() ? numbers[place] : std::uint16_t{0};
  } else {
    return number_of_pdo<Pdos>(place);
  }
}
template <class Device, PdoIndices Indices, class Pdos, class OfNode>
[[nodiscard]] constexpr std::size_t place_of_pdo(std::uint16_t index, [[maybe_unused]] const OfNode& of_node) {
  if constexpr (has_sheet<Device>) {
    const auto& numbers = numbers_in<Indices>(Device::sheet_of(of_node));
    for (std::size_t i = 0; i < numbers.size() && i < Pdos::count; ++i) {
      if (numbers[i] == (index & 0x1FFu) + 1) return i;
    }
    return Pdos::count;
  } else {
    return place_of_pdo<Pdos>(index);
  }
}

/// The PDOs of a list, or of a class that derives from one, that map an object, or can do so, and whose COB-ID is in
/// the dictionary.
template <const Dictionary& DeviceDictionary, PdoIndices Indices, class List>
using ServedPdos = typename pdo_detail::Served<DeviceDictionary, Indices, List>::type;

}  // namespace canopen
