/// Shared by the cases of error control (CiA 301, 7.2.8.3.2): guarding requests and heartbeats.
#pragma once

#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {

using canopen::NmtCommand;
using canopen::NmtState;

inline constexpr std::uint8_t toggle_bit = 0x80;

/// The time within which a device usually answers a guarding request, and the time that the test waits for a late
/// answer: CiA 301 has no maximum.
inline constexpr Duration to_answer_guarding = milliseconds{50};
inline constexpr Duration to_answer_guarding_late = milliseconds{500};

/// Not applicable if the EDS does not have node guarding. Disables heartbeat, which excludes guarding.
void need_guarding(Dut& dut);
/// Like `need_guarding`; writes a guard time and a life time factor that no case exceeds. A device that answers only
/// while they are not 0 fails case 7.2 alone.
void configure_guarding(Dut& dut);
/// Sends one guarding request and returns all error control messages that answer it.
[[nodiscard]] std::vector<SeenFrame> answers(Dut& dut);
/// Sends one guarding request, expects one message of one byte, and returns the byte.
std::uint8_t guard(Dut& dut);
void expect_guarded(Dut& dut, NmtState state, bool toggle);

/// The EMCY with which the device reports a lost node. Inconclusive if the EDS does not have 1014h.
[[nodiscard]] Dut::Match error_control_event(Dut& dut);
void expect_not_lost(Dut& dut, const Dut::Match& event, Dut::Mark since, const std::string& when);

/// The heartbeat time of the cases.
inline constexpr Duration beat = milliseconds{100};

void start_heartbeat(Dut& dut);
/// Expects a heartbeat with this state in each period, and no other frame with its CAN-ID.
void expect_heartbeats(Dut& dut, NmtState state, Duration period, unsigned count);
void expect_no_heartbeats(Dut& dut);

}  // namespace edsc::conform
