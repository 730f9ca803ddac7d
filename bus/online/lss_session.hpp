/// LSS services from a command (CiA 305): each waits for its end.
#pragma once

#include <canopen/lss_master.hpp>
#include <functional>
#include <string>

#include "online/live_bus.hpp"

namespace edsc {

/// What a service came to; a sentence where it failed.
struct LssResult {
  std::string failure;  ///< empty: done
  std::uint32_t value = 0;

  [[nodiscard]] bool done() const { return failure.empty(); }
};

/// `vendor-ID 00000093h, product code 43354B52h, revision 00010001h, serial number 15011234h`
[[nodiscard]] std::string to_text(const canopen::LssAddress& address);

/// Throws Interrupted, after the slaves have been put into waiting state, and BusLost.
class LssSession {
 public:
  explicit LssSession(LiveBus& bus, canopen::LssTimeouts timeouts = {}) : bus_{bus}, master_{bus, timeouts} {}

  LssResult switch_state(canopen::LssState state);
  [[nodiscard]] LssResult select(const canopen::LssAddress& address);
  [[nodiscard]] LssResult inquire_address(canopen::LssAddress& address);
  [[nodiscard]] LssResult inquire_node_id();
  [[nodiscard]] LssResult configure_node_id(std::uint8_t node_id);
  /// `kbit`: a bit rate of CiA 301 in kbit/s, 0: automatic.
  [[nodiscard]] LssResult configure_bit_rate(unsigned kbit);
  LssResult activate(std::uint16_t delay_ms);
  [[nodiscard]] LssResult store();
  [[nodiscard]] LssResult identify_non_configured();

  /// Puts the slave without node-ID whose first `known` numbers are those of `address` into configuration state, and
  /// fills in the others.
  [[nodiscard]] LssResult fastscan(canopen::LssAddress& address, std::uint8_t known);

  /// Why Fastscan has found no slave, as far as LSS tells: a slave without node-ID may lack Fastscan.
  [[nodiscard]] std::string reason_for_silence();

  /// Whether one slave is in configuration state and has this address, as the four inquiries say.
  [[nodiscard]] LssResult confirm(const canopen::LssAddress& address);

  /// Finds all slaves without node-ID, ascending by address; of those only whose first `known` numbers are those of
  /// `among`. `found` is called for each that has confirmed its address. All slaves are waiting before, after, and while
  /// the next one is searched for, as some answer each Fastscan frame in configuration state. A failure: an answer that
  /// no slave confirms; the search ends there.
  LssResult find_unconfigured(const std::function<void(const canopen::LssAddress&)>& found,
                              const canopen::LssAddress& among = {}, std::uint8_t known = 0);

 private:
  enum class Service : std::uint8_t { other, configure_node_id, configure_bit_timing, store };

  template <class Begin>
  LssResult perform(Service service, Begin begin);
  [[nodiscard]] LssResult fastscan_above(canopen::LssAddress& address, std::uint8_t known);
  [[nodiscard]] std::string refusal(Service service) const;

  LiveBus& bus_;
  canopen::LssMaster<LiveBus> master_;
};

}  // namespace edsc
