#include "online/live_scales.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "device/entry_text.hpp"
#include "device/meaning/profile_scales.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

/// The entry with this quantity, or without one.
std::unique_ptr<const Entry> with_quantity(const Entry& entry, std::optional<Quantity> quantity) {
  Entry scaled = entry;
  if (quantity || (entry.meaning && entry.meaning->quantity)) {
    Meaning meaning = entry.meaning ? *entry.meaning : Meaning{};
    meaning.quantity = std::move(quantity);
    scaled.meaning = std::make_shared<const Meaning>(std::move(meaning));
  }
  return std::make_unique<const Entry>(std::move(scaled));
}

}  // namespace

void LiveScales::apply(LiveEntry& entry) {
  if (entry.entry == nullptr || !has_profile_scale(*entry.device, *entry.entry)) return;
  auto& scaled = scaled_[{entry.index, entry.sub_index}];
  if (!scaled) {
    const NumberOfEntry read = [&](const Entry& one) { return number_of(*entry.device, one); };
    scaled = with_quantity(*entry.entry, profile_scale(*entry.device, *entry.entry, read));
  }
  entry.entry = scaled.get();
}

std::optional<std::uint64_t> LiveScales::number_of(const Device& device, const Entry& entry) {
  const auto [found, is_new] = numbers_.try_emplace({entry.index, entry.sub_index});
  if (!is_new) return found->second;
  const LiveEntry live = live_entry(&device, entry.index, entry.sub_index);
  const SdoOutcome outcome = upload(node_, live);
  if (!outcome.done()) {
    failure_ = title(live) + ": " + failure_text(outcome);
    return std::nullopt;
  }
  if (outcome.bytes.size() != bytes_for(entry.type->bits)) {
    failure_ = fmt::format("{}: its value has {} bytes, not {}", title(live), outcome.bytes.size(),
                           bytes_for(entry.type->bits));
    return std::nullopt;
  }
  found->second = edsc::number_of(outcome.bytes);
  const bool is_of_eds = entry.default_value && !entry.default_value->plus_node_id;
  if (!is_of_eds || entry.default_value->bits != *found->second) {
    std::string text = title(live) + " = " + value_of(live, outcome.bytes);
    if (is_of_eds) {
      const auto of_eds = bytes_of(entry.default_value->bits, outcome.bytes.size());
      text += fmt::format(" (EDS: {})", value_of(live, of_eds));
    }
    differences_.push_back(std::move(text));
  }
  return found->second;
}

std::vector<std::string> LiveScales::take_differences() { return std::exchange(differences_, {}); }

std::string LiveScales::take_failure() { return std::exchange(failure_, {}); }

}  // namespace edsc
