#include "shared/default_scales.hpp"

#include <set>
#include <string>

#include "text/printable.hpp"

namespace edsc {

void report_default_scales(std::uint8_t node, const Device& device) {
  std::set<std::string> sources;
  for (const Object& object : device.objects) {
    for (const Entry& entry : object.entries) {
      const bool can_change = entry.meaning && entry.meaning->quantity && !entry.meaning->quantity->stated_by.empty();
      if (can_change) sources.insert(entry.meaning->quantity->text);
    }
  }
  for (const std::string& source : sources) {
    print_to_stderr("edsc: node {}: units {} in the EDS\n", node, source);
  }
}

}  // namespace edsc
