/// Hand-made conformance runs: one with each verdict, and one with hostile bytes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conform/case.hpp"
#include "conform/verdict.hpp"
#include "support/device_from_text.hpp"
#include "text/utf8.hpp"

namespace edsc::conform {

inline constexpr CaseRow read_row{
    "2.6", "A missing object is refused", "CiA 301, 7.2.4.3.17", Level::read, Permission::none, nullptr};
inline constexpr CaseRow guarding_row{
    "2.14", "100Ch is written in segments", "CiA 301, 7.2.4.3.3", Level::communication, Permission::none, nullptr};
inline constexpr CaseRow sync_row{
    "3.7",  "A TPDO of type 0 is sent after an event", "CiA 301, 7.5.2.37", Level::communication, Permission::none,
    nullptr};
inline constexpr CaseRow save_row{
    "8.4", "Values are restored", "CiA 301, 7.5.2.14", Level::communication, Permission::store, nullptr};
inline constexpr CaseRow outputs_row{"5.4",       "An emergency is sent", "CiA 301, 7.2.7",
                                     Level::read, Permission::outputs,    nullptr};

inline const DeviceFromText& sheet() {
  static const DeviceFromText sheet{"[DeviceInfo]\nVendorName=Maker\nProductName=Pump\n" +
                                    var("1008", "Manufacturer device name", "0x0009", "const", "DefaultValue=Pump\n")};
  return sheet;
}

inline SeenFrame seen(std::uint64_t at, bool sent, std::uint32_t id, std::vector<std::uint8_t> data) {
  SeenFrame result;
  result.at = at;
  result.sent = sent;
  result.frame.id = id;
  result.frame.size = static_cast<std::uint8_t>(data.size());
  std::ranges::copy(data, result.frame.data.begin());
  return result;
}

inline CaseResult result_of(const CaseRow& row, Verdict verdict, std::string reason = {}) {
  CaseResult result;
  result.row = &row;
  result.verdict = verdict;
  result.reason = std::move(reason);
  return result;
}

inline CaseResult failure(const CaseRow& row, std::string expected, std::string got) {
  CaseResult result = result_of(row, Verdict::failed);
  result.expected = std::move(expected);
  result.got = std::move(got);
  result.took = 1'204'000;
  result.lag = 120;
  result.frames = {seen(12'003'481, true, 0x605, {0x40, 0x04, 0x10, 0, 0, 0, 0, 0}),
                   seen(12'004'000, false, 0x585, {0x80, 0x04, 0x10, 0, 0x11, 0, 0x09, 0x06})};
  return result;
}

/// One case of each verdict.
inline RunReport every_verdict() {
  RunReport run;
  run.bus = "socketcan:can0";
  run.node = 5;
  run.sheet = "eds/pump.eds";
  run.sheet_hash = "ab12";
  run.product = "Pump";
  run.vendor = "Maker";
  run.read_identity = "vendor-ID 0000 0319h";
  run.level = Level::communication;
  run.permissions = Permission::store;
  run.seed = 7;
  run.version = "0.9.0";
  run.cases.push_back(result_of(save_row, Verdict::passed));
  run.cases.back().warnings = {"0800 0000h in place of 0601 0002h"};
  run.cases.push_back(failure(read_row, "0602 0000h, object does not exist", "0609 0011h, sub-index does not exist"));
  run.cases.push_back(result_of(guarding_row, Verdict::not_applicable, "100Ch:00 does not exist in the EDS"));
  run.cases.push_back(result_of(sync_row, Verdict::deviates));
  run.cases.back().deviation = "sent at every SYNC (manual, page 12)";
  run.cases.push_back(result_of(sync_row, Verdict::inconclusive, "needs a stimulus"));
  run.cases.push_back(result_of(outputs_row, Verdict::not_run, "needs --outputs"));
  run.frames = run.cases[1].frames;
  return run;
}

/// Text that a hostile device or EDS may contain.
inline const std::string hostile =
    std::string{"<b>&\"'\x1B[31m\x07\x9B\xFF\r\n{{bus}} ]]> \xE2\x80\xAE \xEF\xBF\xBF"} + '\0' + "--></script>";

inline RunReport hostile_run() {
  RunReport run = every_verdict();
  for (std::string* text : {&run.bus, &run.sheet, &run.sheet_hash, &run.product, &run.vendor, &run.identity,
                            &run.read_identity, &run.lost, &run.title, &run.operator_name, &run.place, &run.host}) {
    *text = hostile;
  }
  for (CaseResult& result : run.cases) {
    result.reason = result.expected = result.got = result.deviation = hostile;
    result.warnings = result.not_restored = {hostile};
    result.first_run = FirstRun{hostile, hostile, {}};
  }
  // An SDO download of these bytes that the server has accepted.
  run.cases.front().frames = {seen(1, true, 0x605, {0x23, 0x08, 0x10, 0, '<', 0x1B, '&', 0xFF}),
                              seen(2, false, 0x585, {0x60, 0x08, 0x10, 0, 0, 0, 0, 0})};
  run.unused_deviations = run.not_restored = {hostile};
  return run;
}

/// Checks for control characters of a terminal, bytes that are not UTF-8, and characters that XML 1.0 forbids.
inline void expect_harmless(std::string_view text) {
  EXPECT_TRUE(is_utf8(text));
  EXPECT_EQ(text.find("\xE2\x80\xAE"), std::string_view::npos);
  EXPECT_EQ(text.find("\xEF\xBF\xBF"), std::string_view::npos);
  for (const char c : text) EXPECT_TRUE(static_cast<unsigned char>(c) >= ' ' || c == '\n') << static_cast<int>(c);
}

}  // namespace edsc::conform
