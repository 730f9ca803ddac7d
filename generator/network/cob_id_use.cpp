#include "network/cob_id_use.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <string_view>

#include "device/pdo/pdo_defaults.hpp"

namespace edsc {
namespace {

namespace code = canopen::function_code;

/// Bits of 1005h and 1012h.
constexpr std::uint32_t produces_bit = 0x4000'0000;
constexpr std::uint32_t consumes_time_bit = 0x8000'0000;

/// `SDO server 1 response`
std::string sdo_text(std::string_view channel, SdoFrames frames) {
  return fmt::format("{} {}", channel, frames == SdoFrames::requests ? "request" : "response");
}

class UseCollector {
 public:
  UseCollector(const NetworkNode& node, std::vector<CobIdUse>& uses) : node_{node}, uses_{uses} {}

  void collect() {
    for (const Object& object : node_.device().objects) {
      for (const Entry& entry : object.entries) {
        const CobIdParameter* const row = find_cob_id_parameter(entry.index, entry.sub_index);
        if (row != nullptr && entry.default_value && !is_pdo(row->service)) add_parameter(*row, entry);
      }
    }
    for (const Pdo& pdo : node_.device().pdos) add_pdo(pdo);
    add_fixed();
  }

 private:
  static bool is_pdo(CobIdService service) { return service == CobIdService::rpdo || service == CobIdService::tpdo; }

  void add_parameter(const CobIdParameter& row, const Entry& entry) {
    const auto value = static_cast<std::uint32_t>(entry.default_value->bits);
    const canopen::CobId cob_id{value};
    if (row.has_valid_bit && !cob_id.valid()) return;
    const unsigned number = entry.index - row.first + 1U;
    const bool is_first = entry.sub_index == 1;
    switch (row.service) {
      case CobIdService::sync: return add(FrameService::sync, (value & produces_bit) != 0, cob_id, "SYNC", entry);
      case CobIdService::time:
        if ((value & produces_bit) != 0) add(FrameService::time, true, cob_id, "TIME", entry);
        if ((value & consumes_time_bit) != 0) add(FrameService::time, false, cob_id, "TIME", entry);
        return;
      case CobIdService::emcy: return add(FrameService::emcy, true, cob_id, "EMCY", entry);
      case CobIdService::emcy_consumer:
        return add(FrameService::emcy, false, cob_id, fmt::format("EMCY consumer {}", entry.sub_index), entry);
      case CobIdService::sdo_server:
        return add_sdo(is_first ? SdoFrames::requests : SdoFrames::responses, !is_first, cob_id,
                       fmt::format("SDO server {}", entry.index - 0x1200U + 1), entry);
      case CobIdService::sdo_client:
        return add_sdo(is_first ? SdoFrames::requests : SdoFrames::responses, is_first, cob_id,
                       fmt::format("SDO client {}", number), entry);
      case CobIdService::rpdo:
      case CobIdService::tpdo: return;
    }
  }

  void add(FrameService service, bool transmits, canopen::CobId cob_id, std::string what, const Entry& entry) {
    uses_.push_back({&node_, service, SdoFrames::none, transmits, cob_id.can_id(), cob_id.extended(), true, nullptr,
                     std::move(what), default_place(entry)});
  }

  void add_sdo(SdoFrames frames, bool transmits, canopen::CobId cob_id, std::string_view channel, const Entry& entry) {
    add(FrameService::sdo, transmits, cob_id, sdo_text(channel, frames), entry);
    uses_.back().sdo = frames;
  }

  void add_pdo(const Pdo& pdo) {
    if (!on_by_default(pdo)) return;
    const Entry& entry = *pdo.communication->find(1);
    const canopen::CobId cob_id{static_cast<std::uint32_t>(entry.default_value->bits)};
    uses_.push_back({&node_, FrameService::pdo, SdoFrames::none, pdo.direction == PdoDirection::transmit,
                     cob_id.can_id(), cob_id.extended(), true, &pdo, pdo_label(pdo), default_place(entry)});
  }

  void add_fixed() {
    add_fixed(FrameService::nmt, node_.is_master, code::nmt, "NMT");
    add_fixed(FrameService::error_control, true, code::error_control + node_.node_id, "error control");
    if (node_.device().find(0x1200) == nullptr) {
      add_fixed_sdo(SdoFrames::requests, code::sdo_request + node_.node_id);
      add_fixed_sdo(SdoFrames::responses, code::sdo_response + node_.node_id);
    }
  }

  void add_fixed(FrameService service, bool transmits, std::uint32_t can_id, std::string what) {
    uses_.push_back(
        {&node_, service, SdoFrames::none, transmits, can_id, false, false, nullptr, std::move(what), node_.position});
  }

  void add_fixed_sdo(SdoFrames frames, std::uint32_t can_id) {
    add_fixed(FrameService::sdo, frames == SdoFrames::responses, can_id, sdo_text("SDO server 1", frames));
    uses_.back().sdo = frames;
  }

  const NetworkNode& node_;
  std::vector<CobIdUse>& uses_;
};

}  // namespace

std::vector<CobIdUse> cob_id_uses(const Network& network) {
  std::vector<CobIdUse> uses;
  for (const NetworkNode& node : network.nodes) UseCollector{node, uses}.collect();
  return uses;
}

const CobIdUse* sync_producer(const std::vector<CobIdUse>& uses) {
  const auto found = std::ranges::find_if(
      uses, [](const CobIdUse& use) { return use.service == FrameService::sync && use.transmits; });
  return found == uses.end() ? nullptr : &*found;
}

std::string can_id_text(std::uint32_t can_id, bool extended) {
  return fmt::format("{:03X}h{}", can_id, extended ? " (29 bits)" : "");
}

std::string named(const CobIdUse& use) { return fmt::format("{} {}", use.node->name, use.what); }

}  // namespace edsc
