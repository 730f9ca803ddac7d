#include "network/dbc_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <cstddef>

#include "backend/cpp/identifier.hpp"
#include "backend/dbc/dbc_signals.hpp"
#include "network/cob_id_use.hpp"

namespace edsc {
namespace {

bool has_can_id(const DbcFileMessage& message, const CobIdUse& use) {
  return use.service == FrameService::pdo && use.can_id == message.can_id && use.extended == message.extended;
}

/// `bits 8 to 23`
std::string bits_text(const DbcFileSignal& signal) {
  if (signal.bits == 1) return fmt::format("bit {}", signal.first_bit);
  return fmt::format("bits {} to {}", signal.first_bit, signal.first_bit + signal.bits - 1);
}

/// Whether the signal is a part of an entry that the DBC file of edsc also has as a signal: a field of a word. Its name
/// is that of the field.
bool is_part(const PdoEntry& entry, const DbcFileSignal& signal) {
  if (entry.object == nullptr || signal.first_bit < entry.offset) return false;
  return std::ranges::any_of(dbc_signals(*entry.object, entry.bits), [&](const DbcSignal& part) {
    return entry.offset + part.first_bit == signal.first_bit && part.bits == signal.bits;
  });
}

class DbcNamer {
 public:
  DbcNamer(Network& network, Diagnostics& diagnostics)
      : network_{network}, diagnostics_{diagnostics}, uses_{cob_id_uses(network)} {}

  void apply() {
    for (const DbcFileMessage& message : network_.dbc) apply(message);
  }

 private:
  void apply(const DbcFileMessage& message) {
    const bool is_known = std::ranges::any_of(uses_, [&](const CobIdUse& use) { return has_can_id(message, use); });
    if (!is_known) {
      diagnostics_.warning("network-signal", message.position,
                           fmt::format("message {} has {}, the CAN-ID of no PDO of the network", message.name,
                                       can_id_text(message.can_id, message.extended)));
      return;
    }
    for (const DbcFileSignal& signal : message.signals) {
      if (apply(message, signal)) continue;
      const std::string reason = signal.has_pdo_layout
                                     ? fmt::format("no PDO with {} has an entry of {}",
                                                   can_id_text(message.can_id, message.extended), bits_text(signal))
                                     : "it is multiplexed or big-endian, unlike the values of a PDO";
      diagnostics_.warning("network-signal", signal.position,
                           fmt::format("signal {} of message {}: {}", signal.name, message.name, reason));
    }
  }

  /// Whether the signal is an entry of a PDO, or a field of one.
  bool apply(const DbcFileMessage& message, const DbcFileSignal& signal) {
    bool is_found = false;
    for (const CobIdUse& use : uses_) {
      if (!has_can_id(message, use) || !signal.has_pdo_layout) continue;
      for (const PdoEntry& entry : use.pdo->entries) {
        if (entry.offset == signal.first_bit && entry.bits == signal.bits) {
          is_found = true;
          name(use, entry, signal);
        } else if (is_part(entry, signal)) {
          is_found = true;
        }
      }
    }
    return is_found;
  }

  void name(const CobIdUse& use, const PdoEntry& entry, const DbcFileSignal& signal) {
    if (entry.object == nullptr) return;
    const std::string name = to_cpp_identifier(signal.name);
    if (name.empty() || name == use.node->named().identifiers().full(*entry.object)) return;
    NetworkNode& node = network_.nodes[static_cast<std::size_t>(use.node - network_.nodes.data())];
    node.signal_names.emplace(EntryKey{entry.object->index, entry.object->sub_index}, name);
  }

  Network& network_;
  Diagnostics& diagnostics_;
  std::vector<CobIdUse> uses_;
};

}  // namespace

bool load_dbc(Network& network, const std::string& path, Diagnostics& diagnostics) {
  std::string problem;
  network.dbc_source = read_source_file(path, problem);
  if (!network.dbc_source) {
    diagnostics.error("network-file", network.description.dbc->position, problem);
    return false;
  }
  network.dbc = read_dbc(*network.dbc_source, diagnostics);
  return true;
}

std::string dbc_signal_name(const std::vector<DbcFileMessage>& messages, std::uint32_t cob_id, unsigned first_bit,
                            unsigned bits) {
  const canopen::CobId wanted{cob_id};
  for (const DbcFileMessage& message : messages) {
    if (message.can_id != wanted.can_id() || message.extended != wanted.extended()) continue;
    const auto signal = std::ranges::find_if(message.signals, [&](const DbcFileSignal& one) {
      return one.has_pdo_layout && one.first_bit == first_bit && one.bits == bits;
    });
    if (signal != message.signals.end()) return to_cpp_identifier(signal->name);
  }
  return {};
}

void apply_dbc_names(Network& network, Diagnostics& diagnostics) {
  if (!network.dbc.empty()) DbcNamer{network, diagnostics}.apply();
}

}  // namespace edsc
