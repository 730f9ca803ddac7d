/// Emergency (CiA 301, 7.2.7): the error register 1001h, the error history 1003h, and the EMCY that an error causes.
#include <fmt/format.h>

#include <canopen/emcy/error_register.hpp>
#include <canopen/od/access.hpp>

#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {
namespace {

using canopen::CobId;
using canopen::ErrorRegister;
using canopen::NmtCommand;
using canopen::NmtState;

constexpr std::uint16_t generic_error = 0x1000;
constexpr auto generic_bit = static_cast<std::uint8_t>(ErrorRegister::generic);

/// The time that a device may need to send an EMCY. The maximum inhibit time of 1015h is 6.5 s; usual ones are shorter.
constexpr Duration to_report = milliseconds{1000};

/// A value other than 0 for 1003h:00.
constexpr AbortRule no_number_of_errors{
    {canopen::AbortCode::invalid_value, canopen::AbortCode::value_too_high},
    {canopen::AbortCode::general, canopen::AbortCode::read_only, canopen::AbortCode::unsupported_access}};

/// A present error of the device.
struct Raised {
  std::uint32_t cob_id = 0;  ///< 1014h:00
  std::uint16_t code = 0;
  bool by_stimulus = false;
  Dut::Mark since = 0;  ///< before the error
  SeenFrame message;
};

struct ShortRpdo {
  std::uint32_t can_id = 0;
  bool synchronous = false;
};

/// A valid RPDO that maps objects, preferably one whose length the device checks on reception.
std::optional<ShortRpdo> find_rpdo(Dut& dut) {
  std::optional<ShortRpdo> found;
  for (const Pdo* pdo : dut.pdos(PdoDirection::receive)) {
    if (pdo->mapping == nullptr) continue;
    const CobId cob_id{static_cast<std::uint32_t>(dut.read_number(pdo->communication->index, 1))};
    const std::uint64_t mapped = dut.read_number(pdo->mapping->index);
    if (!canopen::is_usable(cob_id.value()) || mapped == 0 || mapped > classical_can.objects) continue;
    const bool synchronous = dut.read_number(pdo->communication->index, 2) <= 240;
    if (!found || found->synchronous) found = ShortRpdo{cob_id.can_id(), synchronous};
  }
  return found;
}

/// Causes an error by a stimulus, else by an RPDO without data (8210h, CiA 301, 7.2.7.1, table 26).
Raised raise(Dut& dut) {
  Raised error{emcy_cob_id(dut), generic_error, true, dut.mark(), {}};
  if (!dut.stimuli().emergency(generic_error, generic_bit)) {
    const std::optional<ShortRpdo> rpdo = find_rpdo(dut);
    if (!rpdo)
      dut.inconclusive(Condition::stimulus,
                       "the device has no valid RPDO: the case needs a stimulus that causes an error");
    dut.need_permission(Permission::outputs);
    dut.enter(NmtState::operational);
    error = {error.cob_id, canopen::emergency_code::pdo_length, false, dut.mark(), {}};
    dut.send(rpdo->can_id, {});
    if (rpdo->synchronous && dut.has(sync_cob_id)) {
      dut.send(static_cast<std::uint32_t>(dut.read_number(sync_cob_id)) & 0x1FFF'FFFF, {});
    }
  }
  const auto seen = dut.wait_for(Dut::with_cob_id(error.cob_id), to_report, error.since);
  dut.expect(seen.has_value(), fmt::format("an EMCY with code {:04X}h", error.code), "none");
  error.message = *seen;
  return error;
}

/// Ends the error by a stimulus, else by reset communication, and waits for the EMCYs that report it.
void end_error(Dut& dut, const Raised& error) {
  if (error.by_stimulus && dut.stimuli().emergency_over(generic_bit)) return dut.pass_time(milliseconds{50});
  dut.reset(NmtCommand::reset_communication);
}

template <class Check>
void with_error(Dut& dut, Check check) {
  const Raised error = raise(dut);
  and_undo([&] { check(error); }, [&] { end_error(dut, error); });
}

/// The last EMCY of the device: the error may have ended.
SeenFrame last_message(Dut& dut, const Raised& error) {
  dut.pass_time(milliseconds{100});
  return dut.received_since(error.since, Dut::with_cob_id(error.cob_id)).back();
}

/// Bit 6 is reserved, and each error sets bit 0 (generic error).
void expect_well_formed(Dut& dut, std::uint64_t bits, const std::string& what) {
  dut.expect((bits & 0x40) == 0, what + ": reserved bit 6 is 0", fmt::format("{:02X}h", bits));
  dut.expect(bits == 0 || (bits & generic_bit) != 0, what + ": bit 0 is set if another bit is set",
             fmt::format("{:02X}h", bits));
}

void cob_id(Dut& dut) {
  expect_default_cob_id(dut, emcy, 0x80U + dut.node().value());
  dut.expect((dut.read_number(emcy) & CobId::no_rtr_bit) == 0, "1014h:00: reserved bit 30 is 0", "1");
}

void read_register(Dut& dut) {
  dut.need(error_register);
  const Bytes value = dut.read(error_register);
  dut.expect_equal(value.size(), 1, "bytes of 1001h:00");
  expect_well_formed(dut, value[0], "1001h:00");
}

void read_history(Dut& dut) {
  dut.need(error_history, 1);
  const std::uint64_t count = dut.read_number(error_history);
  dut.expect(count == 0 || dut.has(error_history, static_cast<std::uint8_t>(count)),
             "1003h:00: not more errors than sub-indices", std::to_string(count));
  for (std::uint8_t i = 1; i <= count; ++i) {
    if ((dut.read_number(error_history, i) & 0xFFFF'FFFF) != 0) continue;
    // A device may record the end of an error as well; the oldest entry is an error unless the history was full.
    const bool may_be_an_end = i != count || !dut.has(error_history, static_cast<std::uint8_t>(count + 1));
    dut.expect(may_be_an_end, label(error_history, i) + ": an error, as 1003h:00 counts it", "0");
    dut.warn(label(error_history, i) + " is 0; CiA 301 records errors, not their end");
  }
  const auto next = static_cast<std::uint8_t>(count + 1);
  if (!dut.has(error_history, next)) return;
  const SdoOutcome outcome = dut.upload(error_history, next);
  if (outcome.done() && number_of(outcome.bytes) == 0) {
    dut.warn(label(error_history, next) + " is 0; CiA 301 requires abort code 0800 0024h above the number of errors");
  } else {
    dut.expect_abort(outcome, abort_rule::no_error, label(error_history, next) + ", above the number of errors");
  }
}

void force_message(Dut& dut) {
  with_error(dut, [&dut](const Raised& error) {
    const canopen::Frame& message = error.message.frame;
    dut.expect_equal(message.size, 8, "bytes of the EMCY");
    const std::uint16_t code = emergency_code_of(message);
    const bool may_be_any = error.by_stimulus && !dut.simulated();  // a user's command causes any error
    if (may_be_any) {
      dut.expect(code != 0, "an EMCY with the code of an error", "0000h");
    } else {
      dut.expect_equal(code, error.code, "the emergency error code");
    }
    expect_well_formed(dut, message.data[2], "the error register in the EMCY");
    if (message.data[2] == 0)
      dut.warn("the error register in the EMCY of an error is 00h; CiA 301 requires bit 0 to be set");
    (void)last_message(dut, error);
    const auto sent = dut.received_since(error.since, emcy_with_code(error.cob_id, code));
    dut.expect_equal(sent.size(), 1, "EMCYs for one error");
    if (!error.by_stimulus) return;
    const Dut::Mark since = dut.mark();
    if (!dut.stimuli().emergency_over(generic_bit)) return;
    const auto over = dut.wait_for(emcy_with_code(error.cob_id, canopen::emergency_code::reset), to_report, since);
    dut.expect(over.has_value(), "an EMCY with code 0000h when the error is over", "none");
    dut.pass_time(milliseconds{100});
    const auto ends = dut.received_since(since, emcy_with_code(error.cob_id, canopen::emergency_code::reset));
    dut.expect_equal(ends.size(), 1, "EMCYs with code 0000h for one error");
  });
}

void register_follows(Dut& dut) {
  dut.need(error_register);
  with_error(dut, [&dut](const Raised& error) {
    const std::uint64_t bits = last_message(dut, error).frame.data[2];
    const std::uint64_t read = dut.read_number(error_register);
    expect_well_formed(dut, read, "1001h:00");
    dut.expect_equal(read, bits, "1001h:00, as in the last EMCY");
  });
}

void history_follows(Dut& dut) {
  dut.need(error_history, 1);
  const std::uint64_t count = dut.read_number(error_history);
  const std::uint64_t newest = count == 0 ? 0 : dut.read_number(error_history, 1);
  with_error(dut, [&](const Raised& error) {
    const std::uint16_t code = emergency_code_of(error.message.frame);
    const bool over = emergency_code_of(last_message(dut, error).frame) != code;
    const std::uint64_t recorded = dut.read_number(error_history);
    dut.expect(recorded >= 1, "1003h:00: at least the error of the EMCY", "0");
    std::uint8_t place = 1;
    // A device may record the end of an error as well.
    if (over && (dut.read_number(error_history, 1) & 0xFFFF) == 0 && recorded >= 2) place = 2;
    dut.expect_equal(dut.read_number(error_history, place) & 0xFFFF, code,
                     label(error_history, place) + ", bits 0 to 15");
    ++place;
    if (count == 0 || recorded != count + 1 || !dut.has(error_history, place)) return;
    dut.expect_equal(dut.read_number(error_history, place), newest, label(error_history, place) + ", the error before");
  });
}

/// A write of 0 to 1003h:00 deletes the errors; another value is refused. Errors of a device at a bus are only deleted
/// with the permission to change what it stores.
void delete_history(Dut& dut) {
  dut.need(error_history, 1);
  const Entry& count = dut.need(error_history);
  if (!canopen::readable(count.access) || !canopen::writable(count.access)) {
    dut.fail_by_sheet("sub-index-0-access", "1003h:00 of the EDS has the access rw",
                      std::string{canopen::row_of(count.access).name});
  }
  if (dut.read_number(error_history) != 0) dut.need_permission(Permission::store);
  constexpr std::uint8_t none = 0, one = 1;
  dut.expect_abort(dut.command(error_history, 0, {&one, 1}), no_number_of_errors, "1 written to 1003h:00");
  dut.expect_done(dut.command(error_history, 0, {&none, 1}), "0 written to 1003h:00, which deletes the errors");
  dut.expect_equal(dut.read_number(error_history), 0, "1003h:00 after 0 was written");
}

constexpr CaseRow emergency_rows[] = {
    {"5.1", "1014h holds the default COB-ID of EMCY", "CiA 301, 7.5.2.17", Level::read, Permission::none, cob_id},
    {"5.2", "The error register 1001h can be read, and bit 0 is set if another bit is set", "CiA 301, 7.5.2.2",
     Level::read, Permission::none, read_register},
    {"5.3", "The error history 1003h has as many errors as 1003h:00 says", "CiA 301, 7.5.2.4", Level::read,
     Permission::none, read_history},
    {"5.4", "An error sends one EMCY with its code", "CiA 301, 7.2.7.1 and 7.2.7.3", Level::communication,
     Permission::none, force_message, Condition::state | Condition::stimulus},
    {"5.5", "The error register 1001h equals the error register of the last EMCY", "CiA 301, 7.2.7.3.1 and 7.5.2.2",
     Level::communication, Permission::none, register_follows, Condition::state | Condition::stimulus, "5.4"},
    {"5.6", "The error history 1003h begins with the error of the last EMCY", "CiA 301, 7.5.2.4", Level::communication,
     Permission::none, history_follows, Condition::state | Condition::stimulus, "5.4"},
    {"5.7", "A write of 0 to 1003h:00 deletes the errors, and other values are refused", "CiA 301, 7.5.2.4",
     Level::communication, Permission::none, delete_history},
};

}  // namespace

std::span<const CaseRow> emergency_cases() { return emergency_rows; }

}  // namespace edsc::conform
