#include "layout_table.hpp"

#include <fmt/format.h>

namespace demo {

void print_layouts(std::string_view device, std::span<const PdoDescription> pdos,
                   std::span<const canopen::EntryDescription> names) {
  fmt::print("{}: {} entries\n", device, names.size());
  for (const PdoDescription& pdo : pdos) {
    fmt::print("  {} {:<2} {:>2} bits\n", pdo.transmit ? "TPDO" : "RPDO", pdo.number, pdo.bits);
    for (const PdoField& field : pdo.fields) {
      const auto* name = canopen::find_description(names, field.index, field.sub_index);
      const auto* type = name == nullptr ? nullptr : canopen::find_data_type(static_cast<std::uint32_t>(name->type));
      fmt::print("    {:>2}..{:<2}  byte {}.{}  {:04X}h:{:02X}  {:<11} {}\n", field.offset,
                 field.offset + field.bits - 1, field.offset / 8, field.offset % 8, field.index, field.sub_index,
                 type == nullptr ? "" : type->name, name == nullptr ? "(dummy)" : name->name());
    }
  }
}

}  // namespace demo
