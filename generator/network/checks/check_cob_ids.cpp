#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <map>
#include <utility>

#include "network/checks/check_groups.hpp"

namespace edsc {
namespace {

using CanIdKey = std::pair<std::uint32_t, bool>;  // CAN-ID, extended

std::string_view to_string(FrameService service) {
  switch (service) {
    case FrameService::nmt: return "NMT";
    case FrameService::sync: return "SYNC";
    case FrameService::time: return "TIME";
    case FrameService::emcy: return "EMCY";
    case FrameService::sdo: return "SDO";
    case FrameService::pdo: return "PDO";
    case FrameService::error_control: return "error control";
  }
  return "";
}

/// Other checks report two producers of these.
bool has_own_check(FrameService service) {
  return service == FrameService::nmt || service == FrameService::sync || service == FrameService::time;
}

/// A finding about two uses is at the one that the network file configures, otherwise at one that an object configures.
void report(const NetworkContext& context, const CobIdUse& first, const CobIdUse& second, std::string_view relation) {
  const auto rank = [&](const CobIdUse& use) {
    return !use.is_configurable ? 0 : use.position.file == context.network.source.get() ? 2 : 1;
  };
  const bool at_first = rank(first) > rank(second);
  const CobIdUse& at = at_first ? first : second;
  const CobIdUse& other = at_first ? second : first;
  context.diagnostics.error(
      "network-cob-id", at.position,
      fmt::format("CAN-ID {}: {} and {} {}", can_id_text(at.can_id, at.extended), named(other), named(at), relation),
      {{other.position, named(other)}});
}

void check_transmitters(const NetworkContext& context, const std::vector<const CobIdUse*>& uses) {
  const CobIdUse* first = nullptr;
  for (const CobIdUse* const use : uses) {
    if (!use->transmits) continue;
    if (first == nullptr) {
      first = use;
    } else if (first->service != use->service || !has_own_check(use->service)) {
      report(context, *first, *use, "both transmit it");
    }
  }
}

/// A receiver that expects another service than the transmitter sends.
void check_services(const NetworkContext& context, const std::vector<const CobIdUse*>& uses) {
  const auto transmitter = std::ranges::find(uses, true, &CobIdUse::transmits);
  if (transmitter == uses.end()) return;
  for (const CobIdUse* const use : uses) {
    if (use->transmits || use->service == (*transmitter)->service) continue;
    report(context, **transmitter, *use,
           fmt::format("use it for different services: {} and {}", to_string(use->service),
                       to_string((*transmitter)->service)));
  }
}

void check_restricted(const NetworkContext& context, const CobIdUse& use) {
  const bool is_default_sdo = use.service == FrameService::sdo;
  if (use.pdo != nullptr && use.pdo->can_id_is_allowed) return;
  if (!use.is_configurable || use.extended || is_default_sdo || !canopen::is_restricted(use.can_id)) return;
  context.diagnostics.error("network-cob-id", use.position,
                            fmt::format("CAN-ID {} of {} is restricted", can_id_text(use.can_id, false), named(use)));
}

}  // namespace

void check_cob_ids(const NetworkContext& context) {
  std::map<CanIdKey, std::vector<const CobIdUse*>> by_can_id;
  for (const CobIdUse& use : context.uses) {
    by_can_id[{use.can_id, use.extended}].push_back(&use);
    check_restricted(context, use);
  }
  for (const auto& [can_id, uses] : by_can_id) {
    check_transmitters(context, uses);
    check_services(context, uses);
  }
}

}  // namespace edsc
