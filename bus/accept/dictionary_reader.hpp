/// Reads the object dictionary of a device entry by entry, with the frames of each read. Writes nothing.
#pragma once

#include <canopen/can/node_id.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "conform/dut/case_frames.hpp"
#include "device/device.hpp"
#include "device/entry_address.hpp"
#include "online/live_bus.hpp"
#include "online/live_entry.hpp"
#include "online/sdo_access.hpp"

namespace edsc::accept {

/// The result of reading an entry. `entry.entry` is null if the EDS does not have it.
struct Reading {
  LiveEntry entry;
  bool was_read = false;
  std::string_view why_not;  ///< the entry was not read
  SdoOutcome outcome;
  std::vector<conform::SeenFrame> frames;  ///< only of `read_again`

  /// The device has the entry, whether or not it gives its value.
  [[nodiscard]] bool exists() const;
  /// The device has said that it does not have the entry: 0602 0000h or 0609 0011h.
  [[nodiscard]] bool is_missing() const;
};

/// By index and sub-index, ascending.
using Readings = std::map<EntryKey, Reading>;

/// Frames of one SDO transfer at a time.
class DictionaryReader : private conform::CaseFrames {
 public:
  DictionaryReader(LiveBus& bus, const Device& sheet, canopen::NodeId node, SdoSettings settings);

  using CaseFrames::clock;
  using CaseFrames::on_record;
  using Progress = std::function<void(std::size_t done, std::size_t of)>;

  /// Reads each entry of the EDS, also write-only ones, unless its ObjFlags exclude it; the sub-indices up to sub-index
  /// 0 that the EDS does not have; and the mandatory entries of CiA 301 that it does not have. Ends early if the device
  /// no longer responds. Throws Interrupted, BusLost.
  [[nodiscard]] Readings read_all(const Progress& progress);
  /// Reads an entry again, with the frames.
  void read_again(Reading& reading);
  /// The device no longer responded.
  [[nodiscard]] bool lost() const { return silent_ >= max_silent; }

 private:
  static constexpr unsigned max_silent = 3;

  void read(Reading& reading);
  void read_missing(Readings& readings, std::uint16_t index, std::uint8_t sub_index);
  void read_object(Readings& readings, const Object& object);
  [[nodiscard]] SdoOutcome upload(const LiveEntry& entry);

  const Device& sheet_;
  canopen::NodeId node_;
  SdoAccess sdo_;
  unsigned silent_ = 0;  ///< reads in a row without a response
};

}  // namespace edsc::accept
