#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>
#include <utility>

#include "device/entry_text.hpp"
#include "device/meaning/raw_unit.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "network/checks/check_groups.hpp"
#include "network/checks/merged_note.hpp"
#include "network/timing/timing.hpp"

namespace edsc {
namespace {

std::string text(const PdoEntry& entry) {
  return entry.object != nullptr ? named(*entry.object) : entry_label(entry.index, entry.sub_index);
}

/// A TPDO and an RPDO with one CAN-ID.
class PdoLink {
 public:
  PdoLink(const NetworkContext& context, const CobIdUse& sender, const CobIdUse& receiver)
      : context_{context}, sender_{sender}, receiver_{receiver} {}

  void check() {
    const unsigned sent = sender_.pdo->bits();
    const unsigned expected = receiver_.pdo->bits();
    if (expected > sent) {
      context_.diagnostics.error(
          "network-pdo-length", place(*receiver_.pdo),
          fmt::format("{} expects {} bits, {} sends {}", named(receiver_), expected, named(sender_), sent), note());
    }
    check_event_timer();
    for (const PdoEntry& entry : receiver_.pdo->entries) {
      if (entry.object != nullptr && entry.end() <= sent) check(entry);
    }
  }

 private:
  static Position place(const Pdo& pdo) {
    return pdo.mapping != nullptr ? default_place(*pdo.mapping->find(0)) : pdo.position;
  }

  [[nodiscard]] std::vector<Note> note() const { return {{place(*sender_.pdo), named(sender_)}}; }

  [[nodiscard]] std::string title(const PdoEntry& entry) const {
    return fmt::format("{} entry {}, {}", named(receiver_), entry.position, text(entry));
  }

  /// The event timer of an RPDO reports a PDO that is missing (CiA 301, 7.5.2.35).
  void check_event_timer() {
    const std::uint64_t timer = communication_default(*receiver_.pdo, event_timer_sub_index).value_or(0);
    if (timer == 0) return;
    const Position at = default_place(*receiver_.pdo->communication->find(event_timer_sub_index));
    const std::string expects = fmt::format("{} expects a PDO within {} ms (event timer)", named(receiver_), timer);
    const auto interval = longest_interval(sender_, context_.uses);
    if (!interval) {
      context_.diagnostics.warning("network-pdo-timer", at,
                                   fmt::format("{}, but {} sends it only at events", expects, named(sender_)), note());
    } else if (*interval >= std::chrono::milliseconds{timer}) {
      const double milliseconds = std::chrono::duration<double, std::milli>{*interval}.count();
      context_.diagnostics.error(
          "network-pdo-timer", at,
          fmt::format("{}, but {} may send it only every {} ms", expects, named(sender_), milliseconds), note());
    }
  }

  void check(const PdoEntry& entry) {
    const std::vector<PdoEntry>& sent = sender_.pdo->entries;
    const auto same = std::ranges::find_if(sent, [&](const PdoEntry& one) { return one.has_bits_of(entry); });
    if (same == sent.end()) {
      context_.diagnostics.warning("network-pdo-layout", entry.place,
                                   fmt::format("{}: bits {} to {} of {} are not one entry", title(entry), entry.offset,
                                               entry.end() - 1, named(sender_)),
                                   note());
      return;
    }
    if (same->object == nullptr) return;
    const Entry& from = *same->object;
    const Entry& to = *entry.object;
    if (from.type != to.type) {
      context_.diagnostics.warning("network-pdo-type", entry.place,
                                   fmt::format("{} is {}, but {} sends {} as {}", title(entry), to.type->name,
                                               named(sender_), named(from), from.type->name),
                                   {{same->place, named(sender_)}});
    }
    const Quantity* const sent_quantity = quantity_with_unit(from);
    const Quantity* const quantity = quantity_with_unit(to);
    if (sent_quantity == nullptr || quantity == nullptr || has_same_raw_numbers(*sent_quantity, *quantity)) return;
    context_.diagnostics.warning(
        "network-pdo-unit", entry.place,
        fmt::format("{} is in {}, but {} sends {} in {}", title(entry), raw_unit_text(*quantity), named(sender_),
                    named(from), raw_unit_text(*sent_quantity)),
        {{same->place, named(sender_)}});
  }

  const NetworkContext& context_;
  const CobIdUse& sender_;
  const CobIdUse& receiver_;
};

/// A master without a file may process PDOs that the network file does not list as signals.
bool has_unknown_master(const Network& network) {
  const NetworkNode* const master = network.master();
  return master != nullptr && !master->has_file();
}

/// PDOs that are sent or received by one node only: warnings for each node, or a note for all nodes.
class MissingPartners {
 public:
  explicit MissingPartners(const NetworkContext& context)
      : context_{context}, are_notes_{has_unknown_master(context.network)} {}

  void add(const CobIdUse& use) {
    if (use.transmits) {
      add(use, "network-pdo-unreceived", "receiver", unreceived_);
    } else {
      add(use, "network-pdo-unsent", "transmitter", unsent_);
    }
  }

  void report_notes() {
    unsent_.report(context_.diagnostics);
    unreceived_.report(context_.diagnostics);
  }

 private:
  void add(const CobIdUse& use, CheckRule<Severity::warning, Severity::note> rule, std::string_view partner,
           MergedNote& note) {
    std::string message = fmt::format("{} ({}) has no {}", named(use), can_id_text(use.can_id, use.extended), partner);
    if (are_notes_) {
      note.add(rule, use.position, std::move(message));
    } else {
      context_.diagnostics.warning(rule, use.position, std::move(message), {}, use.node->name);
    }
  }

  const NetworkContext& context_;
  bool are_notes_;
  MergedNote unsent_, unreceived_;
};

bool is_link(const CobIdUse& sender, const CobIdUse& receiver) {
  return sender.service == FrameService::pdo && sender.transmits && receiver.service == FrameService::pdo &&
         !receiver.transmits && sender.can_id == receiver.can_id && sender.extended == receiver.extended;
}

/// Whether a mapping of the EDS itself has a length that its Granularity excludes.
bool contradicts_itself(const Device& device, std::uint64_t granularity) {
  return std::ranges::any_of(device.pdos, [&](const Pdo& pdo) {
    return std::ranges::any_of(pdo.entries, [&](const PdoEntry& entry) {
      return entry.place.file == device.source && !entry.is_multiple_of(granularity);
    });
  });
}

/// Granularity: the lengths of entries that the device can map (CiA 306-1, 4.5).
void check_granularity(const NetworkContext& context, const CobIdUse& use) {
  const auto granularity = use.node->device().information.capabilities.granularity;
  if (!granularity || *granularity == 0) return;
  const bool is_doubtful = contradicts_itself(*use.node->loaded->device, *granularity);
  for (const PdoEntry& entry : use.pdo->entries) {
    if (entry.place.file != context.network.source.get() || entry.is_multiple_of(*granularity)) continue;
    std::string message = fmt::format("node {}: {} maps {} with {} bits, but the Granularity of the device is {}",
                                      use.node->name, use.what, text(entry), entry.bits, *granularity);
    if (is_doubtful) {
      context.diagnostics.warning("network-pdo-mapping", entry.place, message + ", which its own mappings contradict",
                                  {}, use.node->name);
    } else {
      context.diagnostics.error("network-pdo-mapping", entry.place, std::move(message));
    }
  }
}

}  // namespace

void check_pdo_links(const NetworkContext& context) {
  MissingPartners missing{context};
  for (const CobIdUse& use : context.uses) {
    if (use.service != FrameService::pdo) continue;
    check_granularity(context, use);
    bool has_partner = false;
    for (const CobIdUse& other : context.uses) {
      const bool linked = use.transmits ? is_link(use, other) : is_link(other, use);
      if (!linked) continue;
      has_partner = true;
      const bool has_layout =
          !use.pdo->multiplexed && !other.pdo->multiplexed && !use.pdo->broken && !other.pdo->broken;
      if (use.transmits && has_layout) PdoLink{context, use, other}.check();
    }
    if (!has_partner) missing.add(use);
  }
  missing.report_notes();
}

}  // namespace edsc
