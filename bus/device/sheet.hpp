/// The tables of a device whose EDS is loaded at run time: what edsc generates as C++ for others.
#pragma once

#include <array>
#include <canopen/base/abort_code.hpp>
#include <canopen/lss/lss_options.hpp>
#include <canopen/od/device_options.hpp>
#include <canopen/od/dictionary.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace edsc {

/// A value to which the node-ID is added.
struct SheetNodeIdRow {
  std::uint32_t offset;
  std::uint32_t size;
};

/// A DOMAIN: where its memory is described, and the bytes that it has at power-on.
struct SheetDomain {
  std::uint32_t offset;
  bool readable;
  std::string bytes;  ///< the stored EDS in 1021h; otherwise empty
};

/// An entry that 1010h stores, with its section (canopen/storage/parameter_ranges.hpp).
struct SheetStoredEntry {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::uint8_t section;
  canopen::entry::Word word;
};

/// Values that an entry accepts, as sign-extended bits.
struct SheetAcceptedRange {
  std::int64_t low, high;
};

/// canopen/od/sheet.hpp describes the members that the services use. A sheet does not change after it has been loaded;
/// nodes share it. It is not copied: its dictionary points to its tables.
struct Sheet {
  Sheet() = default;
  Sheet(const Sheet&) = delete;
  Sheet& operator=(const Sheet&) = delete;

  canopen::Dictionary dictionary{};
  canopen::DeviceOptions options{};
  std::optional<canopen::LssOptions> lss_options;
  std::uint32_t dummies = 0;
  unsigned granularity = 1;
  std::size_t longest_download = 4;
  std::vector<std::uint16_t> rpdo_numbers, tpdo_numbers;

  /// Whether a new value of an entry triggers the event-driven TPDOs that map it.
  [[nodiscard]] bool triggers_event(std::uint16_t index, std::uint8_t sub_index) const;
  /// Returns the manufacturer-specific bytes of an EMCY that the services send.
  [[nodiscard]] std::array<std::uint8_t, 5> emergency_info(std::uint16_t code) const;
  /// Whether an entry accepts only some values between its limits.
  [[nodiscard]] bool is_closed(std::uint16_t index, std::uint8_t sub_index) const;
  /// Returns invalid_value for a value that such an entry does not accept.
  [[nodiscard]] canopen::AbortCode check_closed(std::uint16_t index, std::uint8_t sub_index,
                                                std::span<const std::uint8_t> bytes) const;

  std::vector<canopen::Run> runs;
  std::vector<canopen::entry::Word> entries, subs;
  std::vector<canopen::Shape> shapes;
  std::vector<canopen::Limits> limits;
  std::vector<canopen::WideLimits> wide_limits;
  std::vector<std::uint8_t> constants;

  std::vector<std::uint8_t> image;    ///< of the values after a reset
  std::size_t communication_end = 0;  ///< of the image: 1000h..1FFFh is before it
  std::vector<SheetNodeIdRow> node_id_rows;
  std::vector<SheetDomain> domains;
  std::vector<SheetStoredEntry> stored;  ///< ascending
  std::map<std::uint16_t, std::array<std::uint8_t, 5>> emergency_infos;
  std::map<std::uint32_t, bool> without_event;  ///< by key; true: all entries of the object, whose key has sub-index 0
  std::map<std::uint32_t, std::vector<SheetAcceptedRange>> accepted;  ///< by key
};

}  // namespace edsc
