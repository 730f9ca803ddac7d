#include "conform/named_entries.hpp"

#include <cstddef>

#include "lookup/find_entry.hpp"
#include "text/ascii.hpp"

namespace edsc::conform {

std::vector<EntryAddress> entries_in(std::string_view text) {
  constexpr std::size_t label_size = std::string_view{"1800h:02"}.size();
  std::vector<EntryAddress> entries;
  for (std::size_t colon = text.find("h:"); colon != std::string_view::npos; colon = text.find("h:", colon + 1)) {
    if (colon < 4) continue;
    const bool begins = colon == 4 || !is_hex_digit(text[colon - 5]);
    const std::string_view label = text.substr(colon - 4, label_size);
    const auto address = begins && label.size() == label_size ? parse_entry_address(label) : std::nullopt;
    if (address) entries.push_back(*address);
  }
  return entries;
}

}  // namespace edsc::conform
