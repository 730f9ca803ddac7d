/// EMCY, continued (CiA 301, 7.2.7): the error register in each EMCY, the inhibit time 1015h, and whether EMCY is
/// valid.
#include <fmt/format.h>

#include <canopen/can/cob_id.hpp>
#include <canopen/emcy/error_register.hpp>

#include "conform/case.hpp"
#include "conform/cases/nmt/heartbeat_source.hpp"
#include "conform/cases/pdo/tested_rpdo.hpp"
#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {
namespace {

using canopen::CobId;
using canopen::ErrorRegister;

constexpr auto any_error_bit = static_cast<std::uint8_t>(ErrorRegister::generic);

/// 1001h:00 equals the error register of the last EMCY since the mark.
void expect_register_of_last(Dut& dut, std::uint32_t cob_id, Dut::Mark since, const std::string& when) {
  dut.pass_time(milliseconds{50});
  const std::vector<SeenFrame> seen = dut.received_since(since, Dut::with_cob_id(cob_id));
  if (seen.empty()) dut.inconclusive("the device sent no EMCY " + when + "; other cases test whether it does");
  if (!dut.is_readable(error_register)) return;
  dut.expect_equal(
      dut.read_number(error_register), seen.back().frame.data[2],
      fmt::format("1001h:00 {}, as in the EMCY with code {:04X}h", when, emergency_code_of(seen.back().frame)));
}

/// A short RPDO sends 8210h, and one of the right length ends the error in most devices.
void register_of_pdo_error(Dut& dut) {
  const std::uint32_t cob_id = emcy_cob_id(dut);
  dut.enter(NmtState::pre_operational);
  TestedRpdo rpdo{dut};
  dut.enter(NmtState::operational);
  and_undo(
      [&] {
        Dut::Mark since = dut.mark();
        rpdo.send(0);
        expect_register_of_last(dut, cob_id, since, "after a short RPDO");
        since = dut.mark();
        rpdo.send_present();
        dut.pass_time(milliseconds{50});
        if (dut.received_since(since, Dut::with_cob_id(cob_id)).empty()) return;
        expect_register_of_last(dut, cob_id, since, "after an RPDO of the right length");
      },
      [&] { end_errors(dut); });
}

/// A lost node sends 8130h, and its next heartbeat ends the error in most devices.
void register_of_lost_node(Dut& dut) {
  const std::uint32_t cob_id = emcy_cob_id(dut);
  const HeartbeatSource source{dut};
  constexpr Duration watched = milliseconds{200};
  and_undo(
      [&] {
        source.watch(watched);
        Dut::Mark since = dut.mark();
        source.beat();
        dut.pass_time(watched * 2);
        expect_register_of_last(dut, cob_id, since, "after a lost heartbeat");
        since = dut.mark();
        source.beat();
        dut.pass_time(watched / 2);
        if (dut.received_since(since, Dut::with_cob_id(cob_id)).empty()) return;
        expect_register_of_last(dut, cob_id, since, "after the next heartbeat");
      },
      [&] { end_errors(dut); });
}

/// The error classes that have a bit of their own in 1001h. All but the generic bit are optional.
struct ClassBit {
  std::uint16_t code;
  std::uint16_t mask;
  ErrorRegister bit;
};

constexpr ClassBit class_bits[] = {
    {0x2310, 0xF000, ErrorRegister::current},      {0x3110, 0xF000, ErrorRegister::voltage},
    {0x4210, 0xF000, ErrorRegister::temperature},  {0x8100, 0xFF00, ErrorRegister::communication},
    {0xFF00, 0xFF00, ErrorRegister::manufacturer},
};

/// Each error class by a stimulus: bit 0, 1001h as in the EMCY, and the bit of the class.
void register_of_classes(Dut& dut) {
  const std::uint32_t cob_id = emcy_cob_id(dut);
  dut.need(error_register);
  bool any = false;
  for (const ClassBit& row : class_bits) {
    const auto bits = static_cast<std::uint8_t>(static_cast<std::uint8_t>(row.bit) | any_error_bit);
    const Dut::Mark since = dut.mark();
    if (!dut.stimuli().emergency(row.code, bits)) break;
    any = true;
    const auto end = [&] {
      (void)dut.stimuli().emergency_over(bits);
      dut.pass_time(milliseconds{50});
    };
    and_undo(
        [&] {
          const std::string when = fmt::format("after an error of class {:04X}h", row.code & row.mask);
          expect_register_of_last(dut, cob_id, since, when);
          const canopen::Frame message = dut.received_since(since, Dut::with_cob_id(cob_id)).back().frame;
          dut.expect((message.data[2] & any_error_bit) != 0, "bit 0 of the error register " + when,
                     fmt::format("{:02X}h", message.data[2]));
          const bool of_class = (emergency_code_of(message) & row.mask) == (row.code & row.mask);
          if (of_class && (message.data[2] & static_cast<std::uint8_t>(row.bit)) == 0) {
            dut.warn(fmt::format("the error register is {:02X}h {}: the optional bit of the class is 0",
                                 message.data[2], when));
          }
        },
        end);
  }
  if (!any) dut.inconclusive(Condition::stimulus, "needs a stimulus that causes an error");
}

/// Two errors, of which one ends: 0000h with the bits of the other.
void remaining_errors(Dut& dut) {
  const std::uint32_t cob_id = emcy_cob_id(dut);
  if (!dut.simulated())
    dut.inconclusive(Condition::stimulus, "needs stimuli that cause two different errors: only in simulated time");
  constexpr auto first = static_cast<std::uint8_t>(ErrorRegister::current);
  constexpr auto second = static_cast<std::uint8_t>(ErrorRegister::temperature);
  if (!dut.stimuli().emergency(0x2310, first))
    dut.inconclusive(Condition::stimulus, "needs a stimulus that causes an error");
  const auto end = [&] {
    (void)dut.stimuli().emergency_over(first);
    (void)dut.stimuli().emergency_over(second);
    dut.pass_time(milliseconds{50});
  };
  and_undo(
      [&] {
        (void)dut.stimuli().emergency(0x4210, second);
        dut.pass_time(milliseconds{50});
        const Dut::Mark since = dut.mark();
        (void)dut.stimuli().emergency_over(first);
        expect_register_of_last(dut, cob_id, since, "after one of two errors has ended");
        const auto over = dut.received_since(since, emcy_with_code(cob_id, canopen::emergency_code::reset));
        dut.expect(!over.empty(), "an EMCY with code 0000h after one of two errors has ended", "none");
        dut.expect_equal(over.back().frame.data[2], second | any_error_bit, "the error register with code 0000h");
      },
      end);
}

/// Causes two EMCYs, one immediately after the other. Returns the time that it took.
std::uint64_t cause_two(Dut& dut, std::optional<TestedRpdo>& rpdo) {
  const std::uint64_t began = dut.now();
  if (rpdo) {
    rpdo->send(0);
    rpdo->send_present();
  } else if (!dut.stimuli().emergency(0x1000, any_error_bit) || !dut.stimuli().emergency_over(any_error_bit)) {
    dut.inconclusive(Condition::stimulus, "needs a stimulus that causes an error, and one that ends it");
  }
  return dut.now() - began;
}

/// A short RPDO and one of the right length cause two EMCYs in most devices. In simulated time a stimulus is as fast.
std::optional<TestedRpdo> rpdo_for_errors(Dut& dut) {
  if (dut.simulated() || !dut.allowed(Permission::outputs)) return std::nullopt;
  try {
    std::optional<TestedRpdo> rpdo;
    rpdo.emplace(dut);
    return rpdo;
  } catch (const CaseEnd&) {
    return std::nullopt;  // no RPDO that can be tested: stimuli
  }
}

/// The second EMCY is not sent before the inhibit time has elapsed. A second error that came later proves nothing.
void inhibit_time(Dut& dut) {
  constexpr std::uint16_t inhibit = 0x1015;
  constexpr std::uint64_t value = 5000, step_us = 100;  // 500 ms
  constexpr std::uint64_t low = value * step_us, any_longer = 3'600'000'000;
  dut.need_writable(inhibit);
  const std::uint32_t cob_id = emcy_cob_id(dut);
  dut.enter(NmtState::pre_operational);
  std::optional<TestedRpdo> rpdo = rpdo_for_errors(dut);
  dut.write(inhibit, 0, value);
  if (rpdo) dut.enter(NmtState::operational);
  and_undo(
      [&] {
        dut.pass_time(milliseconds{600});  // the inhibit time of an EMCY before this case
        const Dut::Mark since = dut.mark();
        const std::uint64_t took = cause_two(dut, rpdo);
        dut.pass_time(milliseconds{1200});
        const std::vector<SeenFrame> seen = dut.received_since(since, Dut::with_cob_id(cob_id));
        if (seen.size() < 2) {
          dut.inconclusive(
              fmt::format("the device sent {} EMCYs: the time between two cannot be measured", seen.size()));
        }
        dut.expect_time(seen[1].at - seen[0].at, low * 9 / 10, any_longer,
                        "the time between two EMCYs with 1015h = 500 ms");
        if (took < low) return;
        dut.inconclusive(Condition::stimulus,
                         fmt::format("the second error came up to {} after the first, not within the inhibit time",
                                     milliseconds_text(took)));
      },
      [&] { end_errors(dut); });
}

/// Bit 31 of 1014h disables EMCY.
void emcy_disabled(Dut& dut) {
  const std::uint32_t cob_id = emcy_cob_id(dut);
  dut.need_writable(emcy);
  const SdoOutcome outcome = dut.download(emcy, 0, cob_id | CobId::invalid_bit);
  if (!outcome.done()) {
    dut.expect_abort(outcome, abort_rule::value, "bit 31 of 1014h:00");
    dut.not_applicable("1014h:00 does not accept bit 31: EMCY cannot be disabled");
  }
  dut.expect_equal(dut.read_number(emcy), cob_id | CobId::invalid_bit, "1014h:00 after bit 31 was written");
  const Dut::Mark since = dut.mark();
  if (!dut.stimuli().emergency(0x1000, any_error_bit))
    dut.inconclusive(Condition::stimulus, "needs a stimulus that causes an error");
  dut.pass_time(milliseconds{100});
  (void)dut.stimuli().emergency_over(any_error_bit);
  dut.pass_time(milliseconds{100});
  const auto seen = dut.received_since(since, Dut::with_cob_id(cob_id));
  dut.expect(seen.empty(), "no EMCY while bit 31 of 1014h:00 is 1", std::to_string(seen.size()));
}

/// Bits 0 to 29 of 1014h do not change while EMCY is valid.
void emcy_fixed_while_valid(Dut& dut) {
  const std::uint32_t cob_id = emcy_cob_id(dut);
  dut.need_writable(emcy);
  constexpr AbortRule in_use{
      {canopen::AbortCode::invalid_value, canopen::AbortCode::device_state, canopen::AbortCode::unsupported_access},
      {canopen::AbortCode::parameter_incompatible, canopen::AbortCode::read_only, canopen::AbortCode::general}};
  expect_refused(dut, emcy, 0, cob_id == 0x6A0 ? 0x6A1 : 0x6A0, cob_id, in_use,
                 "another CAN-ID to 1014h:00 while EMCY is valid");
}

constexpr CaseRow emergency_register_rows[] = {
    {"5.101", "After a short RPDO 1001h equals the error register of each EMCY", "CiA 301, 7.2.7.3.1 and 7.5.2.2",
     Level::communication, Permission::outputs, register_of_pdo_error, Condition::state, "5.4"},
    {"5.102", "After a lost heartbeat 1001h equals the error register of each EMCY", "CiA 301, 7.2.7.3.1 and 7.5.2.2",
     Level::communication, Permission::none, register_of_lost_node, Condition::alone, "7.106"},
    {"5.103", "For each error class 1001h equals the error register of the EMCY, and bit 0 is set",
     "CiA 301, 7.2.7.1 and 7.5.2.2", Level::communication, Permission::none, register_of_classes, Condition::stimulus},
    {"5.104", "When one of two errors ends, EMCY 0000h has the bits of the other", "CiA 301, 7.2.7.1 and 7.5.2.2",
     Level::communication, Permission::none, remaining_errors, Condition::stimulus, "5.103"},
    {"5.105", "A second EMCY is not sent within the inhibit time 1015h", "CiA 301, 7.5.2.18", Level::communication,
     Permission::none, inhibit_time, Condition::stimulus | Condition::punctual},
    {"5.106", "With bit 31 of 1014h the device sends no EMCY", "CiA 301, 7.5.2.17", Level::communication,
     Permission::none, emcy_disabled, Condition::stimulus},
    {"5.107", "The CAN-ID of EMCY does not change while EMCY is valid", "CiA 301, 7.5.2.17", Level::communication,
     Permission::none, emcy_fixed_while_valid},
};

}  // namespace

std::span<const CaseRow> emergency_register_cases() { return emergency_register_rows; }

}  // namespace edsc::conform
