#include "online/lss_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/nmt/error_control.hpp>
#include <iterator>
#include <string_view>

#include "online/sdo_access.hpp"

namespace edsc {
namespace {

using canopen::LssAddress;
using canopen::LssOutcome;
using canopen::LssState;

/// The maximum number of slaves in a network.
constexpr std::size_t max_slaves = 127;

/// What the error codes of a slave mean (CiA 305).
struct Refusal {
  LssService service;
  canopen::LssError error;
  std::string_view text;
};

constexpr Refusal refusals[] = {
    {LssService::configure_node_id, canopen::lss::node_id_out_of_range, "the node-ID is out of the slave's range"},
    {LssService::configure_bit_timing, canopen::lss::bit_timing_not_supported, "the slave does not have this bit rate"},
    {LssService::store, canopen::lss::store_not_supported, "the slave does not store its configuration"},
    {LssService::store, canopen::lss::storage_access_error, "the slave cannot access its storage"},
};

std::string refusal_text(LssService service, canopen::LssError error) {
  if (error.code == canopen::lss::implementation_specific) {
    return fmt::format("refused: manufacturer-specific error {}", error.specific);
  }
  std::string_view text = "unknown error";
  for (const Refusal& row : refusals) {
    if (row.service == service && row.error == error) text = row.text;
  }
  return fmt::format("refused: error {}, {}", error.code, text);
}

}  // namespace

template <class Begin>
LssResult LssSession::perform(LssService service, Begin begin) {
  (void)begin(bus_.now());
  bool interrupted = false;
  run(bus_, master_, [&] {
    interrupted = true;
    return false;
  });
  if (interrupted) {
    (void)bus_.send(canopen::lss::make_frame(canopen::lss::request_id, canopen::lss::Command::switch_state_global,
                                             static_cast<std::uint32_t>(LssState::waiting)));
    throw Interrupted{};
  }
  switch (master_.outcome()) {
    case LssOutcome::done: return {"", master_.value()};
    case LssOutcome::refused: return {refusal_text(service, master_.error()), 0};
    case LssOutcome::no_answer: return {"no answer", 0, true};
  }
  return {};
}

LssResult LssSession::switch_state(LssState state) {
  return perform(LssService::other, [&](auto now) { return master_.switch_state_global(state, now); });
}

LssResult LssSession::select(const LssAddress& address) {
  return perform(LssService::other, [&](auto now) { return master_.switch_state_selective(address, now); });
}

LssResult LssSession::inquire_address(LssAddress& address) {
  struct Inquiry {
    bool (canopen::LssMaster<LiveBus>::*begin)(canopen::TimePoint);
    std::uint32_t LssAddress::*number;
  };
  using Master = canopen::LssMaster<LiveBus>;
  constexpr Inquiry inquiries[] = {
      {&Master::inquire_vendor_id, &LssAddress::vendor_id},
      {&Master::inquire_product_code, &LssAddress::product_code},
      {&Master::inquire_revision_number, &LssAddress::revision_number},
      {&Master::inquire_serial_number, &LssAddress::serial_number},
  };
  for (const Inquiry& inquiry : inquiries) {
    const LssResult result = perform(LssService::other, [&](auto now) { return (master_.*inquiry.begin)(now); });
    if (!result.done()) return result;
    address.*inquiry.number = result.value;
  }
  return {};
}

LssResult LssSession::inquire_node_id() {
  LssResult result = perform(LssService::other, [&](auto now) { return master_.inquire_node_id(now); });
  result.value &= 0xFF;
  return result;
}

LssResult LssSession::configure_node_id(std::uint8_t node_id) {
  return perform(LssService::configure_node_id,
                 [&](auto now) { return master_.configure_node_id(canopen::NodeId{node_id}, now); });
}

LssResult LssSession::configure_bit_rate(unsigned kbit) {
  std::uint8_t index = canopen::lss::automatic_bit_rate;
  if (kbit != 0) {
    const auto* rate = std::ranges::find(canopen::lss::bit_rates, kbit);
    index = static_cast<std::uint8_t>(rate - std::begin(canopen::lss::bit_rates));
  }
  return perform(LssService::configure_bit_timing, [&](auto now) {
    return master_.configure_bit_timing({0, index}, now);
  });
}

LssResult LssSession::activate(std::uint16_t delay_ms) {
  return perform(LssService::other, [&](auto now) {
    return master_.activate_bit_timing(std::chrono::duration<std::uint16_t, std::milli>{delay_ms}, now);
  });
}

LssResult LssSession::store() {
  return perform(LssService::store, [&](auto now) { return master_.store_configuration(now); });
}

LssResult LssSession::identify_non_configured() {
  return perform(LssService::other, [&](auto now) { return master_.identify_non_configured_remote_slave(now); });
}

LssResult LssSession::fastscan(LssAddress& address, std::uint8_t known, bool above) {
  LssResult result = perform(LssService::other, [&](auto now) {
    return above ? master_.fastscan_above(address, known, now) : master_.fastscan(address, known, now);
  });
  if (result.done()) address = master_.address();
  return result;
}

LssResult LssSession::confirm(const LssAddress& address) {
  LssAddress inquired;
  const std::string expected = to_text(address);
  if (const LssResult result = inquire_address(inquired); !result.done()) {
    return {fmt::format("found {}, but no slave with this address answers an inquiry ({})", expected, result.failure),
            0};
  }
  if (inquired == address) return {};
  return {fmt::format("found {}, but the slave in configuration state has {}", expected, to_text(inquired)), 0};
}

std::string LssSession::reason_for_silence() {
  if (!identify_non_configured().done()) return "no device without node-ID answers";
  return "a device without node-ID answers LSS, but did not answer the first Fastscan request, sent twice; it may be "
         "slow (--step) or not have Fastscan: with no other device on the bus, \"edsc lss BUS state configuration\" and "
         "\"inquire\" show its numbers for \"assign\"";
}

LssResult LssSession::find(LssAddress& address, std::uint8_t known, bool above) {
  constexpr unsigned attempts = 2;
  LssResult confirmed;
  for (unsigned i = 0; i != attempts; ++i) {
    LssAddress found = address;
    const LssResult scanned = fastscan(found, known, above);
    if (!scanned.done()) return i == 0 ? scanned : confirmed;
    confirmed = confirm(found);
    if (confirmed.done()) {
      address = found;
      return confirmed;
    }
    switch_state(LssState::waiting);
  }
  return confirmed;
}

bool LssSession::responds(std::uint8_t node_id, canopen::Duration time) {
  const canopen::TimePoint end = bus_.now() + time;
  for (canopen::TimePoint now = bus_.now(); now < end; now = bus_.now()) {
    const std::optional<canopen::Frame> frame = bus_.receive(end - now);
    if (Interruption::noted()) throw Interrupted{};
    if (!frame) continue;
    const auto message = canopen::error_control_message(*frame);
    if (message && message->node_id.value() == node_id) return true;
  }
  SdoAccess access{bus_, canopen::NodeId{node_id}, {}};
  return access.upload(0x1000, 0).end != SdoEnd::no_answer;
}

LssResult LssSession::find_unconfigured(const std::function<void(const LssAddress&)>& found, const LssAddress& among,
                                        std::uint8_t known) {
  switch_state(LssState::waiting);
  LssAddress address = among;
  LssResult result = find(address, known);
  for (std::size_t count = 0; result.done() && count != max_slaves; ++count) {
    const LssAddress last = address;
    switch_state(LssState::waiting);
    found(address);
    result = find(address, known, true);
    if (result.done() && address == last) return {"found " + to_text(address) + " again", 0};
  }
  switch_state(LssState::waiting);
  return result.is_silence ? LssResult{} : result;
}

std::string to_text(const LssAddress& address) {
  return fmt::format("vendor-ID {:08X}h, product code {:08X}h, revision {:08X}h, serial number {:08X}h",
                     address.vendor_id, address.product_code, address.revision_number, address.serial_number);
}

}  // namespace edsc
