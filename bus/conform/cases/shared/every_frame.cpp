#include "conform/cases/shared/every_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <canopen/can/cob_id.hpp>
#include <canopen/emcy/error_register.hpp>
#include <set>
#include <string>
#include <string_view>

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

/// Returns what is wrong with an EMCY; empty: nothing.
std::string fault_of(const canopen::Frame& message) {
  constexpr auto generic = static_cast<std::uint8_t>(canopen::ErrorRegister::generic);
  constexpr std::uint8_t reserved = 0x40;
  if (message.size != 8) return fmt::format("an EMCY of {} bytes", message.size);
  const std::uint8_t bits = message.data[2];
  const bool is_valid = (bits & reserved) == 0 && (bits == 0 || (bits & generic) != 0);
  return is_valid ? "" : fmt::format("{:02X}h in the EMCY with code {:04X}h", bits, emergency_code_of(message));
}

bool reports_no_bit(const canopen::Frame& message) {
  return message.size == 8 && message.data[2] == 0 && (emergency_code_of(message) & 0xFF00) != 0;
}

void expect_emcys(Dut& dut, bool fails) {
  if (!dut.has(emcy)) return;
  const auto cob_id = static_cast<std::uint32_t>(dut.default_of(emcy).value_or(0x80U + dut.node().value()));
  if (!CobId{cob_id}.valid()) return;
  const std::string expected =
      "in each EMCY of 8 bytes the error register has bit 6 = 0, and bit 0 if another bit is set";
  std::set<std::string> warned;
  const auto warn = [&](const std::string& text) {
    if (warned.insert(text).second) dut.warn(text);
  };
  for (const SeenFrame& seen : dut.received_since(0, Dut::with_cob_id(cob_id))) {
    if (const std::string fault = fault_of(seen.frame); !fault.empty()) {
      if (fails) dut.fail(expected, fault);
      warn(fmt::format("{}; CiA 301: {}", fault, expected));
    } else if (reports_no_bit(seen.frame)) {
      warn(fmt::format("the error register is 00h in the EMCY with code {:04X}h; CiA 301 sets bit 0 with each error",
                       emergency_code_of(seen.frame)));
    }
  }
}

}  // namespace

bool is_abort_code_of_cia301(std::uint32_t code) {
  return code != 0 && std::ranges::any_of(canopen::abort_code_texts, [code](const canopen::AbortCodeText& row) {
           return static_cast<std::uint32_t>(row.code) == code;
         });
}

void expect_valid_frames(Dut& dut, const CaseRow& row) {
  expect_abort_codes(dut);
  constexpr std::string_view emcy_service = "7.2.7";  // of CiA 301
  expect_emcys(dut, row.id.starts_with("5.") && row.clause.find(emcy_service) != std::string_view::npos);
}

}  // namespace edsc::conform
