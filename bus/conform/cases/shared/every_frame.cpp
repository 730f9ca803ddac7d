#include "conform/cases/shared/every_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <canopen/can/cob_id.hpp>
#include <canopen/emcy/error_register.hpp>

#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {
namespace {

namespace sdo = canopen::sdo;
using canopen::CobId;

void expect_abort_codes(Dut& dut) {
  const auto is_answer = Dut::with_id(canopen::default_sdo(dut.node()).response.can_id());
  for (const SeenFrame& seen : dut.received_since(0, is_answer)) {
    if (seen.frame.size != 8 || seen.frame.data[0] != sdo::abort_command) continue;
    const std::uint32_t code = sdo::word_of(seen.frame.data);
    if (is_abort_code_of_cia301(code)) continue;
    dut.fail("each abort has an abort code of CiA 301",
             fmt::format("abort {:04X} {:04X}h of {}", code >> 16, code & 0xFFFF,
                         label(sdo::index_of(seen.frame.data), seen.frame.data[3])));
  }
}

void expect_error_register(Dut& dut, const canopen::Frame& message) {
  constexpr auto generic = static_cast<std::uint8_t>(canopen::ErrorRegister::generic);
  constexpr std::uint8_t reserved = 0x40;
  const std::uint16_t code = emergency_code_of(message);
  const std::uint8_t bits = message.data[2];
  const std::string got = fmt::format("{:02X}h in the EMCY with code {:04X}h", bits, code);
  dut.expect((bits & reserved) == 0, "reserved bit 6 of the error register is 0 in each EMCY", got);
  dut.expect(bits == 0 || (bits & generic) != 0,
             "bit 0 of the error register is set in each EMCY if another bit is set", got);
  if (bits == 0 && (code & 0xFF00) != 0) {
    dut.warn(fmt::format("the error register is {}; CiA 301 requires bit 0 while an error is present", got));
  }
}

void expect_emcys(Dut& dut) {
  if (!dut.has(emcy)) return;
  const auto cob_id = static_cast<std::uint32_t>(dut.default_of(emcy).value_or(0x80U + dut.node().value()));
  if (!CobId{cob_id}.valid()) return;
  for (const SeenFrame& seen : dut.received_since(0, Dut::with_cob_id(cob_id))) {
    dut.expect_equal(seen.frame.size, 8, "bytes of each EMCY");
    expect_error_register(dut, seen.frame);
  }
}

}  // namespace

bool is_abort_code_of_cia301(std::uint32_t code) {
  return code != 0 && std::ranges::any_of(canopen::abort_code_texts, [code](const canopen::AbortCodeText& row) {
           return static_cast<std::uint32_t>(row.code) == code;
         });
}

void expect_valid_frames(Dut& dut) {
  expect_abort_codes(dut);
  expect_emcys(dut);
}

}  // namespace edsc::conform
