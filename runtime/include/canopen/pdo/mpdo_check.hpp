/// Checks of writes to the parameters of MPDOs, their scanner lists and their dispatching lists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/pdo/communication_parameters.hpp"
#include "canopen/pdo/mpdo_lists.hpp"
#include "canopen/pdo/multiplexed_pdos.hpp"
#include "canopen/pdo/pdo_list.hpp"
#include "canopen/pdo/pdo_mapping.hpp"
#include "canopen/pdo/transmission_type.hpp"

namespace canopen {

/// Checks of writes to the parameters and lists of MPDOs.
template <class Device>
class MpdoCheck {
  using Features = MpdoFeatures<Device>;
  using Rpdos = typename Features::Rpdos;
  using Tpdos = typename Features::Tpdos;
  using Scanned = typename Features::Scanned;
  using Dispatched = typename Features::Dispatched;

 public:
  /// Checks whether these bytes, whose length is correct, may be written to 1000h..1FFFh, in addition to the checks of
  /// other PDOs.
  ///   0604 0042h  254 or 255 mapped objects in a PDO of another transmission type, 254 without a list, or a second SAM
  ///               producer (or the abort code of the device options); a scanner list with more objects than there are
  ///   0609 0030h  another transmission type for an MPDO, or more elements than the list can contain
  ///   0604 0041h  an element of a list is an object that does not exist, cannot be mapped or has more than 32 bits
  [[nodiscard]] static AbortCode check(EntryAccess<Device> entries, std::uint16_t index, std::uint8_t sub_index,
                                       std::span<const std::uint8_t> bytes) {
    if (is_rpdo_communication(index) || is_rpdo_mapping(index)) {
      return check_pdo<Rpdos>(entries, index, sub_index, bytes[0]);
    }
    if (is_tpdo_communication(index) || is_tpdo_mapping(index)) {
      return check_pdo<Tpdos>(entries, index, sub_index, bytes[0]);
    }
    if constexpr (Features::sends_source) {
      if (Scanned::contain(index)) return check_scanned(entries, index, sub_index, bytes);
    }
    if constexpr (Features::receives && Dispatched::room > 0) {
      if (Dispatched::contain(index))
        return check_list<Dispatched, DispatchedObjects>(index, sub_index, bytes, entry::rpdo);
    }
    return ok;
  }

 private:
  template <class Pdos>
  [[nodiscard]] static AbortCode check_pdo(EntryAccess<Device> entries, std::uint16_t index, std::uint8_t sub_index,
                                           std::uint8_t value) {
    const auto* const row = Pdos::with_parameter(index);
    if (row == nullptr) return ok;
    const bool mapping = is_rpdo_mapping(index) || is_tpdo_mapping(index);
    if (mapping && sub_index == 0 && value >= source_multiplexed) {
      const bool possible = value == destination_multiplexed || check_source<Pdos>(entries, *row);
      if (possible && Pdos::event_driven(entries, *row)) return ok;
      return static_cast<AbortCode>(Device::options.pdo_mapping_abort_code);
    }
    if (!mapping && sub_index == pdo_parameter::transmission_type && Pdos::mode(entries, *row) >= source_multiplexed) {
      return transmission_of(value) == Transmission::event_driven ? ok : AbortCode::invalid_value;
    }
    return ok;
  }

  /// Whether a PDO can become a SAM-MPDO.
  template <class Pdos>
  [[nodiscard]] static bool check_source(EntryAccess<Device> entries, const typename Pdos::Parameters& wanted) {
    if constexpr (std::is_same_v<Pdos, Rpdos>) return Dispatched::room > 0;
    for (const auto& row : Pdos::rows) {
      if (row.number != wanted.number && Pdos::mode(entries, row) == source_multiplexed) return false;
    }
    return Features::sends_source;
  }

  template <class Lists, class Element>
  [[nodiscard]] static AbortCode check_list(std::uint16_t index, std::uint8_t sub_index,
                                            std::span<const std::uint8_t> bytes, entry::Word direction) {
    const std::uint8_t capacity = Lists::capacity(index);
    if (sub_index == 0) return bytes[0] <= capacity ? ok : AbortCode::invalid_value;
    if (sub_index > capacity) return ok;
    Element element{};
    std::memcpy(&element.value, bytes.data(), sizeof element.value);
    for (unsigned i = 0; element.value != 0 && i < element.size(); ++i) {
      const unsigned at = element.sub_index() + i;
      if (at > 0xFF) return AbortCode::not_mappable;
      const entry::Word word = Device::dictionary.find(element.index(), static_cast<std::uint8_t>(at));
      if (!Features::carries(word, direction)) return AbortCode::not_mappable;
    }
    return ok;
  }

  [[nodiscard]] static AbortCode check_scanned(EntryAccess<Device> entries, std::uint16_t index, std::uint8_t sub_index,
                                               std::span<const std::uint8_t> bytes) {
    const AbortCode code = check_list<Scanned, ScannedObjects>(index, sub_index, bytes, entry::tpdo);
    if (code != ok || sub_index == 0 || sub_index > Scanned::capacity(index)) return code;
    ScannedObjects element{};
    std::memcpy(&element.value, bytes.data(), sizeof element.value);
    std::size_t objects = element.value != 0 ? element.size() : 0;
    Scanned::for_each(entries, [&](ScannedObjects block, std::uint16_t list, std::uint8_t at) {
      if (list != index || at != sub_index) objects += block.size();
    });
    return objects <= Features::scannable ? ok : AbortCode::pdo_length;
  }
};

}  // namespace canopen
