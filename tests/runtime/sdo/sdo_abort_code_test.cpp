/// Each abort code of CiA 301 and of the manuals: the requests for which the server itself reports it, and the codes
/// that only an application or another service reports.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "sdo_bench.hpp"

namespace {

using canopen::AbortCode;
namespace od = sample::od;

struct Raised {
  AbortCode code;
  std::vector<std::string> requests;
  std::string last_answer;
};

const Raised by_the_server[] = {
    {AbortCode::toggle_bit, {"40 08 10 00 00 00 00 00", "70 00 00 00 00 00 00 00"}, "80 08 10 00 00 00 03 05"},
    {AbortCode::command_specifier, {"E0 08 10 00 00 00 00 00"}, "80 08 10 00 01 00 04 05"},
    {AbortCode::block_size, {"A4 08 10 00 80 00 00 00"}, "80 08 10 00 02 00 04 05"},
    {AbortCode::sequence_number, {"C2 0C 20 00 10 00 00 00", "00 41 42 43 44 45 46 47"}, "80 0C 20 00 03 00 04 05"},
    {AbortCode::crc,
     {"C6 0C 20 00 02 00 00 00", "81 48 69 00 00 00 00 00", "D5 00 00 00 00 00 00 00"},
     "80 0C 20 00 04 00 04 05"},
    {AbortCode::write_only, {"40 14 20 00 00 00 00 00"}, "80 14 20 00 01 00 01 06"},
    {AbortCode::read_only, {"23 00 10 00 00 00 00 00"}, "80 00 10 00 02 00 01 06"},
    {AbortCode::no_object, {"40 04 10 00 00 00 00 00"}, "80 04 10 00 00 00 02 06"},
    {AbortCode::length_mismatch, {"21 0C 20 00 08 00 00 00", "01 41 42 43 44 45 46 47"}, "80 0C 20 00 10 00 07 06"},
    {AbortCode::length_too_high, {"23 02 20 00 01 00 00 00"}, "80 02 20 00 12 00 07 06"},
    {AbortCode::length_too_low, {"2F 02 20 00 01 00 00 00"}, "80 02 20 00 13 00 07 06"},
    {AbortCode::no_sub_index, {"40 00 10 01 00 00 00 00"}, "80 00 10 01 11 00 09 06"},
    {AbortCode::invalid_value, {"2F 00 20 00 02 00 00 00"}, "80 00 20 00 30 00 09 06"},
    {AbortCode::value_too_high, {"2F 01 20 00 65 00 00 00"}, "80 01 20 00 31 00 09 06"},
    {AbortCode::value_too_low, {"2F 01 20 00 9B 00 00 00"}, "80 01 20 00 32 00 09 06"},
    {AbortCode::not_stored, {"21 12 20 00 09 00 00 00"}, "80 12 20 00 20 00 00 08"},
    {AbortCode::no_data, {"40 12 20 00 00 00 00 00"}, "80 12 20 00 24 00 00 08"},
};

/// Reported after a time-out, and by a device whose buffer is shorter than its strings.
constexpr AbortCode by_special_servers[] = {AbortCode::timeout, AbortCode::out_of_memory};

/// Reported by handlers and by the services of single objects: PDO parameters, storage, errors.
constexpr AbortCode by_the_application[] = {
    AbortCode::unsupported_access,
    AbortCode::not_mappable,
    AbortCode::pdo_length,
    AbortCode::parameter_incompatible,
    AbortCode::internal_incompatibility,
    AbortCode::hardware,
    AbortCode::maximum_less_than_minimum,
    AbortCode::no_resource,
    AbortCode::general,
    AbortCode::local_control,
    AbortCode::device_state,
    AbortCode::no_dictionary,
};

TEST(SdoAbortCodes, AreRaisedByTheServer) {
  for (const Raised& row : by_the_server) {
    bench::SdoBench device;
    std::string answer;
    for (const std::string& request : row.requests) answer = device.ask(request);
    EXPECT_EQ(answer, row.last_answer) << to_text(row.code);
    EXPECT_EQ(canopen::sdo::word_of(bench::bytes_of(answer)), static_cast<std::uint32_t>(row.code));
  }
}

struct WithTimeout : sample::Device {
  static constexpr canopen::DeviceOptions options{.sdo_timeout = 100};
};

struct SmallBuffer : bench::WithBlock {
  static constexpr std::size_t longest_download = 0;
};

TEST(SdoAbortCodes, AreRaisedByTimeAndByTheLackOfMemory) {
  bench::SdoBench<WithTimeout> waiting;
  waiting.ask("40 08 10 00 00 00 00 00");
  EXPECT_EQ(waiting.pass(std::chrono::milliseconds{100}), "80 08 10 00 00 00 04 05");

  bench::SdoBench<SmallBuffer> small;
  EXPECT_EQ(small.ask("21 0C 20 00 09 00 00 00"), "80 0C 20 00 05 00 04 05");
  small.ask("C0 0C 20 00 00 00 00 00");
  small.ask("01 41 42 43 44 45 46 47");
  EXPECT_EQ(small.ask("02 41 42 43 44 45 46 47"), "80 0C 20 00 05 00 04 05");
  small.ask("C0 0C 20 00 00 00 00 00");
  small.ask("01 41 42 43 44 45 46 47");
  small.ask("82 41 42 43 44 45 46 47");
  EXPECT_EQ(small.ask("C1 00 00 00 00 00 00 00"), "80 0C 20 00 05 00 04 05");
}

TEST(SdoAbortCodes, OfTheApplicationGoOutAsTheyAre) {
  for (const AbortCode code : by_the_application) {
    bench::SdoBench device;
    device.refuse = [code](auto, auto) { return code; };
    canopen::sdo::Data expected = bench::bytes_of("80 02 20 00");
    canopen::sdo::put_word(expected, static_cast<std::uint32_t>(code));
    EXPECT_EQ(device.ask("2B 02 20 00 01 00 00 00"), bench::text_of(expected));
    EXPECT_EQ(device.ask("40 02 20 00 00 00 00 00"), bench::text_of(expected));
    EXPECT_EQ(device.ask("A4 02 20 00 7F 00 00 00"), bench::text_of(expected));
  }
}

TEST(SdoAbortCodes, StandInOneOfTheTables) {
  for (const auto& row : canopen::abort_code_texts) {
    if (row.code == canopen::ok) continue;
    const auto count = std::count_if(std::begin(by_the_server), std::end(by_the_server),
                                     [&](const Raised& raised) { return raised.code == row.code; }) +
                       std::count(std::begin(by_special_servers), std::end(by_special_servers), row.code) +
                       std::count(std::begin(by_the_application), std::end(by_the_application), row.code);
    EXPECT_EQ(count, 1) << row.text;
  }
}

}  // namespace
