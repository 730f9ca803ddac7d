#include "device/io_loop.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "device/entry_number.hpp"

namespace edsc {
namespace {

/// CiA 401: digital outputs and inputs of 8, 1, 16 and 32 bits, analogue ones of 8, 16 and 32 bits, as REAL32, and
/// those of the manufacturer.
struct WiredObjects {
  std::uint16_t output, input;
};
constexpr WiredObjects wired_objects[] = {{0x6200, 0x6000}, {0x6220, 0x6020}, {0x6300, 0x6100},
                                          {0x6320, 0x6120}, {0x6410, 0x6400}, {0x6411, 0x6401},
                                          {0x6412, 0x6402}, {0x6413, 0x6403}, {0x6414, 0x6404}};

}  // namespace

std::vector<ValueCopy> io_loop(EntryFinder& names) {
  std::vector<ValueCopy> copies;
  for (const auto [output, input] : wired_objects) {
    const FoundEntry from = names.find(fmt::format("{:04X}h", output)), to = names.find(fmt::format("{:04X}h", input));
    if (!from.ok() || !to.ok()) continue;
    for (const Entry& entry : from.object->entries) {
      const Entry* const wired = entry.sub_index != 0 ? to.object->find(entry.sub_index) : nullptr;
      if (wired != nullptr && has_number(entry) && has_number(*wired)) copies.push_back({&entry, wired, 0});
    }
  }
  return copies;
}

}  // namespace edsc
