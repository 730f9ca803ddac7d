#include "format/dcf/concise_dcf.hpp"

#include <algorithm>

#include "device/index_range.hpp"
#include "device/types/value_bytes.hpp"
#include "format/dcf/configured_values.hpp"

namespace edsc {

std::string concise_dcf(const DataSheet& sheet, const Device& device, Diagnostics& diagnostics) {
  std::vector<ConfiguredValue> values = configured_values(sheet, device, diagnostics);
  std::erase_if(values, [](const ConfiguredValue& value) {
    return !value.differs || contains(command_objects, value.entry->index);
  });
  std::string stream;
  append_bytes(stream, values.size(), 4);
  for (const ConfiguredValue& value : values) {
    append_bytes(stream, value.entry->index, 2);
    append_bytes(stream, value.entry->sub_index, 1);
    append_bytes(stream, value.data.size(), 4);
    stream += value.data;
  }
  return stream;
}

std::optional<std::vector<ConciseEntry>> read_concise_dcf(std::string_view stream) {
  const auto number = [&stream](unsigned count) {
    const std::vector<std::uint8_t> bytes{stream.begin(), stream.begin() + count};
    stream.remove_prefix(count);
    return number_of(bytes);
  };
  constexpr std::size_t head = 7;
  if (stream.size() < 4) return std::nullopt;
  std::vector<ConciseEntry> entries;
  for (std::uint64_t left = number(4); left > 0; --left) {
    if (stream.size() < head) return std::nullopt;
    ConciseEntry entry;
    entry.index = static_cast<std::uint16_t>(number(2));
    entry.sub_index = static_cast<std::uint8_t>(number(1));
    const std::uint64_t size = number(4);
    if (stream.size() < size) return std::nullopt;
    entry.data = stream.substr(0, size);
    stream.remove_prefix(size);
    entries.push_back(entry);
  }
  if (!stream.empty()) return std::nullopt;
  return entries;
}

}  // namespace edsc
