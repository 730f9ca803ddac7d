/// A device in simulated time that is compared with the text of an EDS.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "accept/compare_dictionary.hpp"
#include "dictionary_port.hpp"
#include "support/device_from_text.hpp"

namespace edsc::accept {

using Bytes = DictionaryPort::Bytes;

inline constexpr std::string_view u8 = "0x5", u16 = "0x6", u32 = "0x7", i32 = "0x4", text_type = "0x9";

inline std::string value(std::string_view number) { return fmt::format("DefaultValue={}\n", number); }

/// The objects that each device has, and those of one drive without a TPDO.
inline std::string base_eds(std::string_view product_code = "0x42") {
  return "[DeviceInfo]\nVendorNumber=0x319\nProductNumber=0x42\nRevisionNumber=0x10000\nNrOfRXPDO=0\nNrOfTXPDO=1\n" +
         var("1000", "Device type", u32, "ro", value("0x192")) + var("1001", "Error register", u8, "ro") +
         var("1017", "Producer heartbeat time", u16, "rw", value("0")) + group("1018", "Identity object", "0x9", 4) +
         var("1018sub0", "Count", u8, "ro", value("3")) + var("1018sub1", "Vendor-ID", u32, "ro", value("0x319")) +
         var("1018sub2", "Product code", u32, "ro", value(product_code)) +
         var("1018sub3", "Revision", u32, "ro", value("0x10000"));
}

/// The device of `base_eds`.
inline void fill(DictionaryPort& port) {
  port.values = {{{0x1000, 0}, {0x92, 1, 0, 0}}, {{0x1001, 0}, {0}},
                 {{0x1017, 0}, {0, 0}},          {{0x1018, 0}, {3}},
                 {{0x1018, 1}, {0x19, 3, 0, 0}}, {{0x1018, 2}, {0x42, 0, 0, 0}},
                 {{0x1018, 3}, {0, 0, 1, 0}}};
}

struct Compared {
  std::unique_ptr<DeviceFromText> eds;
  Comparison comparison;
  unsigned downloads = 0;
};

inline Compared run(const std::string& eds, const std::function<void(DictionaryPort&)>& change) {
  auto port = std::make_unique<DictionaryPort>();
  DictionaryPort& device = *port;
  fill(device);
  change(device);
  LiveBus bus{std::move(port)};
  Compared result{std::make_unique<DeviceFromText>(eds, Options{}, DeviceSettings{{}, DictionaryPort::node_id}), {}, 0};
  ComparisonSettings settings;
  settings.node = canopen::NodeId{DictionaryPort::node_id};
  result.comparison = compare_dictionary(bus, result.eds->device, result.eds->sheet, settings);
  result.downloads = device.downloads;
  return result;
}

}  // namespace edsc::accept
