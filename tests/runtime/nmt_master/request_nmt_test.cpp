/// Request NMT 1F82h of an NMT master. Values: CiA 302-2, table of 1F82h.
#include <gtest/gtest.h>
#include <canopen/nmt_master/nmt_master.hpp>
#include <canopen/nmt_master/request_nmt.hpp>

#include "nmt_boot_bench.hpp"

namespace {

using boot_bench::Desk;
using boot_bench::device_type;
using boot_bench::slave;
using canopen::AbortCode;
using namespace std::chrono_literals;

TEST(RequestNmt, SendsTheCommandOfAValueToOneNodeOrToAll) {
  Desk desk{{slave(5)}};
  struct Row {
    std::uint8_t sub_index;
    std::uint8_t value;
    const char* frame;
  };
  for (const Row& row : {Row{5, 4, "000 02 05"}, Row{5, 5, "000 01 05"}, Row{5, 6, "000 81 05"}, Row{5, 7, "000 82 05"},
                         Row{5, 127, "000 80 05"}, Row{127, 5, "000 01 7F"}, Row{128, 4, "000 02 00"}}) {
    EXPECT_EQ(write_request_nmt(desk.master, row.sub_index, row.value), canopen::ok);
    EXPECT_EQ(desk.bus.take(), row.frame);
  }
}

TEST(RequestNmt, RejectsOtherValuesAndSubIndices) {
  Desk desk{{slave(5)}};
  for (const int value : {0, 1, 2, 3, 8, 126, 128, 255}) {
    EXPECT_EQ(write_request_nmt(desk.master, 5, static_cast<std::uint8_t>(value)), AbortCode::invalid_value) << value;
  }
  EXPECT_EQ(write_request_nmt(desk.master, 0, 5), AbortCode::no_sub_index);
  EXPECT_EQ(write_request_nmt(desk.master, 129, 5), AbortCode::no_sub_index);
  desk.bus.room = 0;
  EXPECT_EQ(write_request_nmt(desk.master, 5, 5), AbortCode::device_state);
  EXPECT_EQ(desk.bus.take(), "");
}

TEST(RequestNmt, ReadsTheStateThatASlaveHasReported) {
  Desk desk{{slave(5, 200)}};
  EXPECT_EQ(read_request_nmt(desk.master, 5), 0) << "unknown";
  EXPECT_EQ(read_request_nmt(desk.master, 6), 0) << "not a slave";
  desk.start();
  desk.pass(5s);
  EXPECT_EQ(read_request_nmt(desk.master, 5), 1) << "it does not respond";
  desk.take("705 00");
  desk.take("705 7F");
  EXPECT_EQ(read_request_nmt(desk.master, 5), 127);
  desk.take("705 05");
  EXPECT_EQ(read_request_nmt(desk.master, 5), 5);
}

}  // namespace
