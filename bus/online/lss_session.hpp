/// LSS services for commands (CiA 305); each call waits until the service ends.
#pragma once

#include <canopen/lss/lss_master.hpp>
#include <functional>
#include <string>

#include "online/live_bus.hpp"

namespace edsc {

/// The result of a service, with a message if it failed.
struct LssResult {
  std::string failure;  ///< empty on success
  std::uint32_t value = 0;
  bool is_silence = false;  ///< no slave has responded

  [[nodiscard]] bool done() const { return failure.empty(); }
};

/// The services whose error codes have a meaning.
enum class LssService : std::uint8_t { other, configure_node_id, configure_bit_timing, store };

/// `vendor-ID 00000093h, product code 43354B52h, revision 00010001h, serial number 15011234h`
[[nodiscard]] std::string to_text(const canopen::LssAddress& address);

/// Throws Interrupted, after switching the slaves to waiting state, and BusLost.
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

  /// Switches the slave without node-ID whose first `known` numbers match `address` to configuration state, and fills
  /// in the other numbers. `above`: the next one above `address`.
  [[nodiscard]] LssResult fastscan(canopen::LssAddress& address, std::uint8_t known, bool above = false);

  /// Why Fastscan did not find a slave: whether a slave without node-ID responds to another service.
  [[nodiscard]] std::string reason_for_silence();

  /// Checks with the four inquiries that one slave is in configuration state and has this address.
  [[nodiscard]] LssResult confirm(const canopen::LssAddress& address);

  /// `fastscan` and `confirm`; the address may be wrong because of late responses, so that a slave that does not
  /// confirm it is searched again once.
  [[nodiscard]] LssResult find(canopen::LssAddress& address, std::uint8_t known, bool above = false);

  /// Whether a node sends its boot-up message or a heartbeat within this time, or responds to SDO after it.
  [[nodiscard]] bool responds(std::uint8_t node_id, canopen::Duration time);

  /// Finds all slaves without node-ID, ascending by address, whose first `known` numbers match `among`. `found` is
  /// called for each slave that has confirmed its address. All slaves are in waiting state before, after, and during
  /// the search for the next one, since some answer each Fastscan frame in configuration state. A response that no
  /// slave confirms is a failure and ends the search.
  LssResult find_unconfigured(const std::function<void(const canopen::LssAddress&)>& found,
                              const canopen::LssAddress& among = {}, std::uint8_t known = 0);

 private:
  template <class Begin>
  LssResult perform(LssService service, Begin begin);

  LiveBus& bus_;
  canopen::LssMaster<LiveBus> master_;
};

}  // namespace edsc
