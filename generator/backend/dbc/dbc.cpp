#include "backend/dbc/dbc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "backend/dbc/dbc_name.hpp"
#include "backend/dbc/dbc_signals.hpp"
#include "device/pdo/pdo_defaults.hpp"

namespace edsc {
namespace {

constexpr std::uint64_t first_event_driven_type = 254;
constexpr std::uint32_t extended_message = 0x8000'0000;  ///< in the number of a message

/// The sections of the file after the messages, which are filled message by message.
struct Sections {
  std::string messages, comments, attributes, value_names, value_types;
};

/// The CAN-ID of a message, and whether it has 29 bits.
using MessageId = std::pair<std::uint32_t, bool>;

[[nodiscard]] MessageId message_id(const Pdo& pdo) {
  const canopen::CobId cob_id{static_cast<std::uint32_t>(communication_default(pdo, 1).value_or(0))};
  return {cob_id.can_id(), cob_id.extended()};
}

/// A PDO and the node that sends or receives it.
struct NodePdo {
  const DbcNode* node = nullptr;
  const Pdo* pdo = nullptr;

  [[nodiscard]] bool transmits() const { return pdo->direction == PdoDirection::transmit; }
};

/// Whether the PDO maps an object to one of these bits.
[[nodiscard]] bool uses_bits(const Pdo& pdo, unsigned first, unsigned bits) {
  return std::ranges::any_of(pdo.entries, [&](const PdoEntry& mapped) {
    return mapped.object != nullptr && mapped.offset < first + bits && first < mapped.end();
  });
}

class DbcWriter {
 public:
  explicit DbcWriter(const std::vector<DbcNode>& nodes) : nodes_{nodes} {
    DbcNames names;
    for (const DbcNode& node : nodes) names_.emplace(&node, names.take(node.name));
  }

  [[nodiscard]] Dbc write() {
    for_each_pdo([&](const NodePdo& one) { assign(one); });
    for_each_pdo([&](const NodePdo& one) {
      if (const auto reason = why_left_out(one)) {
        add_note(one, *reason);
      } else if (messages_.at(message_id(*one.pdo)).pdo == one.pdo) {
        add_message(one);
        last_reason_.reset();
      }
    });
    return {text(), std::move(notes_)};
  }

 private:
  template <class Visit>
  void for_each_pdo(Visit visit) const {
    for (const DbcNode& node : nodes_) {
      for (const Pdo& pdo : node.device->pdos) visit(NodePdo{&node, &pdo});
    }
  }

  [[nodiscard]] static bool is_usable(const Pdo& pdo) { return !pdo.broken && !pdo.multiplexed && on_by_default(pdo); }

  /// The message of a CAN-ID is the first TPDO with it, or else the first RPDO.
  void assign(const NodePdo& one) {
    if (!is_usable(*one.pdo)) return;
    const auto [at, added] = messages_.emplace(message_id(*one.pdo), one);
    if (!added && one.transmits() && !at->second.transmits()) at->second = one;
  }

  /// Readers take the long names for the names of the signals: both differ within a message.
  struct SignalNames {
    DbcNames full{max_long_dbc_name}, shortened;
  };

  enum class LeftOut : std::uint8_t { invalid_mapping, multiplexed, disabled, of_another_pdo };

  /// Why a PDO is not in the file.
  struct Reason {
    LeftOut kind;
    std::uint32_t can_id = 0;  ///< that of another PDO
    friend bool operator==(const Reason&, const Reason&) = default;

    [[nodiscard]] std::string text() const {
      switch (kind) {
        case LeftOut::invalid_mapping: return "its mapping is invalid";
        case LeftOut::multiplexed: return "a multiplex PDO";
        case LeftOut::disabled: return "disabled by default";
        case LeftOut::of_another_pdo: break;
      }
      return fmt::format("CAN-ID {:03X}h is used by another PDO", can_id);
    }
  };

  /// Nothing if the PDO is a message or receives one.
  [[nodiscard]] std::optional<Reason> why_left_out(const NodePdo& one) const {
    const Pdo& pdo = *one.pdo;
    if (pdo.broken) return Reason{LeftOut::invalid_mapping};
    if (pdo.multiplexed) return Reason{LeftOut::multiplexed};
    if (!on_by_default(pdo)) return Reason{LeftOut::disabled};
    const NodePdo& message = messages_.at(message_id(pdo));
    const bool receives = !one.transmits() && message.node != one.node;
    if (message.pdo == one.pdo || receives) return std::nullopt;
    return Reason{LeftOut::of_another_pdo, message_id(pdo).first};
  }

  /// `TPDO 1`, of several nodes `axis1 TPDO 1`.
  [[nodiscard]] std::string label(const NodePdo& one) const {
    return nodes_.size() == 1 ? pdo_label(*one.pdo) : one.node->name + " " + pdo_label(*one.pdo);
  }

  /// Consecutive PDOs of a node with the same reason are one note: `TPDO 3 to TPDO 8: disabled by default`.
  void add_note(const NodePdo& one, const Reason& reason) {
    if (reason != last_reason_ || one.node != last_node_ || notes_.empty()) {
      notes_.emplace_back();
      first_left_out_ = label(one);
      last_reason_ = reason;
      last_node_ = one.node;
    }
    const std::string last = pdo_label(*one.pdo);
    notes_.back() = first_left_out_ + (label(one) == first_left_out_ ? "" : " to " + last) + ": " + reason.text();
  }

  void add_message(const NodePdo& one) {
    const Pdo& pdo = *one.pdo;
    const std::string& device = one.node->name;
    const auto [can_id, is_extended] = message_id(pdo);
    const std::uint32_t id = can_id | (is_extended ? extended_message : 0);
    const std::string suffix = fmt::format("_{}pdo_{}", one.transmits() ? 't' : 'r', pdo.number);
    const std::string long_name = device + suffix;
    const std::string name = message_names_.take(device.substr(0, max_dbc_name - suffix.size()) + suffix);
    sections_.messages +=
        fmt::format("\nBO_ {} {}: {} {}\n", id, name, pdo.bytes(), one.transmits() ? names_.at(one.node) : nobody);

    const std::uint64_t type = communication_default(pdo, transmission_type_sub_index).value_or(0);
    sections_.comments += fmt::format("CM_ BO_ {} \"{}, transmission type {}\";\n", id, label(one), type);
    if (name != long_name) {
      sections_.attributes += fmt::format("BA_ \"SystemMessageLongSymbol\" BO_ {} \"{}\";\n", id, long_name);
    }
    const std::uint64_t timer = communication_default(pdo, event_timer_sub_index).value_or(0);
    if (one.transmits() && type >= first_event_driven_type && timer != 0) {
      sections_.attributes += fmt::format("BA_ \"GenMsgCycleTime\" BO_ {} {};\n", id, timer);
    }
    SignalNames signals;
    for (const PdoEntry& mapped : pdo.entries) {
      if (mapped.object != nullptr) add_signals(id, one, mapped, signals);
    }
  }

  /// The nodes with an RPDO that maps an object to these bits of the message.
  [[nodiscard]] std::string receivers(const NodePdo& message, unsigned first, unsigned bits) const {
    std::string receivers;
    const DbcNode* last = nullptr;
    for_each_pdo([&](const NodePdo& one) {
      const bool receives = !one.transmits() && is_usable(*one.pdo) &&
                            message_id(*one.pdo) == message_id(*message.pdo) &&
                            (one.pdo == message.pdo || one.node != message.node) && uses_bits(*one.pdo, first, bits);
      if (!receives || one.node == last) return;
      receivers += fmt::format("{}{}", receivers.empty() ? "" : ",", names_.at(one.node));
      last = one.node;
    });
    return receivers.empty() ? nobody : receivers;
  }

  void add_signals(std::uint32_t id, const NodePdo& message, const PdoEntry& mapped, SignalNames& names) {
    for (const DbcSignal& signal : dbc_signals(*mapped.object, mapped.bits)) {
      add_signal(id, message, mapped, signal, names);
    }
  }

  [[nodiscard]] static std::string name_of(const DbcNode& node, const Entry& entry) {
    if (node.signal_names != nullptr) {
      const auto name = node.signal_names->find({entry.index, entry.sub_index});
      if (name != node.signal_names->end()) return name->second;
    }
    return node.names->full(entry);
  }

  void add_signal(std::uint32_t id, const NodePdo& message, const PdoEntry& mapped, const DbcSignal& signal,
                  SignalNames& names) {
    const Entry& entry = *mapped.object;
    const std::string long_name = names.full.take(name_of(*message.node, entry) + signal.name);
    const std::string name = names.shortened.take(long_name);
    const unsigned start = mapped.offset + signal.first_bit;
    sections_.messages += fmt::format(" SG_ {} : {}|{}@1{} ({},{}) [{}|{}] {} {}\n", name, start, signal.bits,
                                      signal.is_signed ? '-' : '+', signal.factor, signal.offset, signal.min,
                                      signal.max, dbc_string(signal.unit), receivers(message, start, signal.bits));
    std::string comment = fmt::format("{} {}", entry_label(entry.index, entry.sub_index), entry.parameter_name());
    if (!signal.text.empty()) comment += ", " + signal.text;
    if (!entry.description.empty() && signal.name.empty()) comment += ": " + entry.description;
    sections_.comments += fmt::format("CM_ SG_ {} {} {};\n", id, name, dbc_string(comment));
    if (name != long_name) {
      sections_.attributes += fmt::format("BA_ \"SystemSignalLongSymbol\" SG_ {} {} \"{}\";\n", id, name, long_name);
    }
    if (signal.values != nullptr) add_value_names(id, name, signal);
    if (entry.type->kind == canopen::DataClass::real) {
      sections_.value_types += fmt::format("SIG_VALTYPE_ {} {} : {};\n", id, name, mapped.bits == 32 ? 1 : 2);
    }
  }

  void add_value_names(std::uint32_t id, const std::string& name, const DbcSignal& signal) {
    sections_.value_names += fmt::format("VAL_ {} {}", id, name);
    for (const NamedValue& one : signal.values->values) {
      const std::string number =
          signal.is_signed ? fmt::format("{}", one.value) : fmt::format("{}", static_cast<std::uint64_t>(one.value));
      sections_.value_names += fmt::format(" {} \"{}\"", number, one.name);
    }
    sections_.value_names += " ;\n";
  }

  [[nodiscard]] std::string text() const {
    std::string node_list;
    for (const DbcNode& node : nodes_) node_list += (node_list.empty() ? "" : " ") + names_.at(&node);
    return fmt::format(R"(VERSION ""

NS_ :

BS_:

BU_: {}
{}
{}BA_DEF_ "BusType" STRING ;
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
BA_DEF_ BO_ "SystemMessageLongSymbol" STRING ;
BA_DEF_ SG_ "SystemSignalLongSymbol" STRING ;
BA_DEF_DEF_ "BusType" "CAN";
BA_DEF_DEF_ "GenMsgCycleTime" 0;
BA_DEF_DEF_ "SystemMessageLongSymbol" "";
BA_DEF_DEF_ "SystemSignalLongSymbol" "";
{}{}{})",
                       node_list, sections_.messages, sections_.comments, sections_.attributes, sections_.value_names,
                       sections_.value_types);
  }

  static constexpr const char* nobody = "Vector__XXX";  ///< the name that the format gives to an unknown node

  const std::vector<DbcNode>& nodes_;
  std::map<const DbcNode*, std::string> names_;
  DbcNames message_names_;
  std::map<MessageId, NodePdo> messages_;
  Sections sections_;
  std::vector<std::string> notes_;
  std::string first_left_out_;
  std::optional<Reason> last_reason_;
  const DbcNode* last_node_ = nullptr;
};

}  // namespace

Dbc dbc_of(const Device& device, const Identifiers& names) {
  return dbc_of(std::vector<DbcNode>{{names.device(), &device, &names, nullptr}});
}

Dbc dbc_of(const std::vector<DbcNode>& nodes) { return DbcWriter{nodes}.write(); }

}  // namespace edsc
