/// LSS services from a command (CiA 305): each waits for its end.
#pragma once

#include <canopen/lss_master.hpp>
#include <optional>
#include <string>
#include <vector>

#include "live/live_bus.hpp"

namespace edsc {

/// What a service came to; a sentence where it failed.
struct LssResult {
  std::string failure;  ///< empty: done
  std::uint32_t value = 0;

  [[nodiscard]] bool done() const { return failure.empty(); }
};

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

  /// All slaves without node-ID that fastscan finds; of those only whose first `known` numbers are those of `among`.
  /// All slaves are waiting then.
  [[nodiscard]] std::vector<canopen::LssAddress> find_unconfigured(const canopen::LssAddress& among = {},
                                                                   std::uint8_t known = 0);

 private:
  enum class Service : std::uint8_t { other, configure_node_id, configure_bit_timing, store };

  template <class Begin>
  LssResult perform(Service service, Begin begin);
  [[nodiscard]] std::string refusal(Service service) const;

  LiveBus& bus_;
  canopen::LssMaster<LiveBus> master_;
};

}  // namespace edsc
