#include "device/value_overlay.hpp"

#include <utility>

#include "device/meaning/profile_scales.hpp"
#include "device/pdo/resolve_pdos.hpp"

namespace edsc {

void ValueOverlay::set(const Entry& entry, Value value) {
  settings_.push_back({entry.index, entry.sub_index, std::move(value)});
  last_[{entry.index, entry.sub_index}] = settings_.size() - 1;
}

const Setting* ValueOverlay::find(std::uint16_t index, std::uint8_t sub_index) const {
  const auto last = last_.find({index, sub_index});
  return last != last_.end() ? &settings_[last->second] : nullptr;
}

const Value* ValueOverlay::value_of(const Entry& entry) const {
  if (const Setting* const setting = find(entry.index, entry.sub_index)) return &setting->value;
  return entry.default_value ? &*entry.default_value : nullptr;
}

Device with_values(const Device& device, const ValueOverlay& values, const Options& options, Diagnostics& of_mapping) {
  Device result{device};
  for (Object& object : result.objects) {
    for (Entry& entry : object.entries) {
      if (const Setting* const setting = values.find(entry.index, entry.sub_index))
        entry.default_value = setting->value;
    }
  }
  resolve_profile_scales(result);
  result.pdos.clear();
  resolve_pdos(result, options);
  mark_broken_pdos(result, options, of_mapping);
  return result;
}

}  // namespace edsc
