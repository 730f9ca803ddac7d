#include "device/stored_eds.hpp"

#include <algorithm>

#include "system/gzip.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

bool is_read_only(const Entry& entry) { return canopen::readable(entry.access) && !canopen::writable(entry.access); }

Entry* find_entry(Device& device, std::uint16_t index) {
  const auto object = std::ranges::find(device.objects, index, &Object::index);
  if (object == device.objects.end() || object->has_sub_indices()) return nullptr;
  return &object->entries.front();
}

}  // namespace

void resolve_stored_eds(Device& device, const Options& options, Diagnostics& diagnostics) {
  if (options.stored_eds == StoredEds::of_application) return;
  const Entry* const sheet = find_entry(device, store_eds);
  if (sheet == nullptr || sheet->type->kind != canopen::DataClass::domain || !is_read_only(*sheet)) {
    diagnostics.error("options", Position{device.source}, "option stored_eds: the EDS has no read-only DOMAIN 1021h");
    return;
  }
  Entry* const format = find_entry(device, store_format);
  const bool compressed = options.stored_eds == StoredEds::compressed;
  if (format != nullptr && format->type->kind == canopen::DataClass::unsigned_integer && is_read_only(*format)) {
    if (!format->default_value) format->default_value.emplace();
    format->default_value->bits = static_cast<std::uint64_t>(compressed ? StoreFormat::gzip : StoreFormat::text);
  } else if (compressed || format != nullptr) {
    diagnostics.error("options", Position{device.source},
                      "option stored_eds: the EDS has no read-only integer 1022h for the format");
  }
}

std::string stored_eds(const Device& device, const Options& options) {
  switch (options.stored_eds) {
    case StoredEds::of_application: return {};
    case StoredEds::text: return std::string{device.source->text()};
    case StoredEds::compressed: return gzip(device.source->text());
  }
  return {};
}

}  // namespace edsc
