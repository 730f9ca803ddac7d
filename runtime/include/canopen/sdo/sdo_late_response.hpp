/// The response that an SDO client still expects of a transfer that has ended without it.
#pragma once

#include <cstdint>

#include "canopen/base/clock.hpp"
#include "canopen/sdo/sdo_protocol.hpp"

namespace canopen {

/// SDO does not number its transfers: only the index and sub-index (the multiplexer) of initiate responses and aborts
/// identify the request. This class decides which response belongs to an earlier transfer, and which entry must not be
/// requested before that response has arrived, or counts as lost.
class SdoLateResponse {
 public:
  /// The response to an initiate request has not arrived.
  void expect_initiate(std::uint32_t entry) {
    const bool another = expected_ != Expected::none && entry_ != entry;
    expected_ = another ? Expected::any : Expected::entry;
    entry_ = entry;
    was_reset_ = false;
  }

  /// Segments of a block upload may arrive, with any content.
  void expect_segments() { expected_ = Expected::any; }

  /// The server may still abort the transfer of this entry.
  void expect_abort(std::uint32_t entry) {
    if (expected_ != Expected::none) return;
    expected_ = Expected::entry;
    entry_ = entry;
    was_reset_ = false;
  }

  /// Sets the time at which the response counts as lost.
  void set_end(TimePoint end) { until_ = end; }

  /// Reports the boot-up message of the server: responses to requests from before it do not arrive after it.
  void server_reset() {
    if (expected_ == Expected::any) expected_ = Expected::none;
    was_reset_ = true;
  }

  /// Whether the response may still arrive. `timeout` is the one with which `set_end` was calculated.
  [[nodiscard]] bool due(TimePoint now, Duration timeout) const { return is_within(until_, timeout, now); }

  /// Expects the response no longer if it counts as lost.
  void expire(TimePoint now, Duration timeout) {
    if (!due(now, timeout)) expected_ = Expected::none;
  }

  [[nodiscard]] bool expected() const { return expected_ != Expected::none; }
  [[nodiscard]] TimePoint end() const { return until_; }

  /// Whether the response could be mistaken for the one to an initiate request for this entry.
  [[nodiscard]] bool blocks(std::uint32_t entry) const {
    return expected_ == Expected::any || (expected_ == Expected::entry && entry_ == entry && !was_reset_);
  }

  /// Whether a response is the late one, which is then expected no longer. The responses of a server that was reset
  /// belong to the running transfer, of `entry`, if that is waiting for its initiate response.
  [[nodiscard]] bool take(const sdo::Data& response, std::uint32_t entry, bool is_initiating) {
    if (expected_ != Expected::entry || !sdo::has_multiplexer(response)) return false;
    if (sdo::multiplexer_of(response) != entry_) return false;
    if (was_reset_ && is_initiating && entry_ == entry) {
      was_reset_ = false;  // the next one with this entry is the response to the other request
      return false;
    }
    expected_ = Expected::none;
    return true;
  }

 private:
  enum class Expected : std::uint8_t {
    none,
    entry,  ///< an initiate response or abort, of `entry_`
    any,    ///< segments of a block upload, or several initiate responses
  };

  std::uint32_t entry_ = 0;  ///< as `sdo::multiplexer`
  TimePoint until_{};
  Expected expected_ = Expected::none;
  bool was_reset_ = false;  ///< the server has been reset since the response was requested
};

}  // namespace canopen
