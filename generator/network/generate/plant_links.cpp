#include "network/generate/plant_links.hpp"

#include <fmt/format.h>

#include "backend/cpp/identifier.hpp"
#include "device/complete_device.hpp"

namespace edsc {
namespace {

bool is_linked(const CobIdUse& sender, const CobIdUse& receiver) {
  return sender.pdo != nullptr && receiver.pdo != nullptr && sender.transmits && !receiver.transmits &&
         sender.node != receiver.node && sender.can_id == receiver.can_id && sender.extended == receiver.extended;
}

}  // namespace

std::vector<PdoLink> pdo_links(const std::vector<CobIdUse>& uses) {
  std::vector<PdoLink> links;
  for (const CobIdUse& sender : uses) {
    for (const CobIdUse& receiver : uses) {
      if (is_linked(sender, receiver)) links.push_back({&sender, &receiver});
    }
  }
  return links;
}

std::vector<LinkedValue> linked_values(const PdoLink& link) {
  std::vector<LinkedValue> values;
  for (std::size_t taken = 0; taken < link.receiver->pdo->entries.size(); ++taken) {
    const PdoEntry& consumer = link.receiver->pdo->entries[taken];
    for (std::size_t sent = 0; sent < link.sender->pdo->entries.size(); ++sent) {
      const PdoEntry& producer = link.sender->pdo->entries[sent];
      const bool is_value = producer.object != nullptr && consumer.object != nullptr;
      if (is_value && producer.has_bits_of(consumer)) {
        values.push_back({sent, taken, producer.offset});
      }
    }
  }
  return values;
}

std::string signal_identifier(const NetworkNode& node, const PdoEntry& entry) {
  const auto name = node.signal_names.find({entry.object->index, entry.object->sub_index});
  if (name != node.signal_names.end()) return name->second;
  return without_reserved_word(node.named().identifiers().full(*entry.object));
}

}  // namespace edsc
