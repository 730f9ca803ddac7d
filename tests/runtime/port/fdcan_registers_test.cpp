/// Registers, message RAM and bit timing of FDCAN, as in the reference manuals of the STM32G4 and STM32H7.
#include <gtest/gtest.h>

#include <canopen/port/fdcan.hpp>
#include <cstddef>

#include "fake_m_can.hpp"

namespace {

#define CHECK_OFFSET(registers, name, offset) EXPECT_EQ(offsetof(canopen::registers, name), std::size_t{offset})

TEST(FdcanRegisters, AreWhereTheManualOfTheG4Says) {
  CHECK_OFFSET(FdcanG4Registers, common.cccr, 0x018);
  CHECK_OFFSET(FdcanG4Registers, common.nbtp, 0x01C);
  CHECK_OFFSET(FdcanG4Registers, common.ecr, 0x040);
  CHECK_OFFSET(FdcanG4Registers, common.psr, 0x044);
  CHECK_OFFSET(FdcanG4Registers, common.ir, 0x050);
  CHECK_OFFSET(FdcanG4Registers, common.ie, 0x054);
  CHECK_OFFSET(FdcanG4Registers, common.ils, 0x058);
  CHECK_OFFSET(FdcanG4Registers, common.ile, 0x05C);
  CHECK_OFFSET(FdcanG4Registers, rxgfc, 0x080);
  CHECK_OFFSET(FdcanG4Registers, xidam, 0x084);
  CHECK_OFFSET(FdcanG4Registers, rxf0s, 0x090);
  CHECK_OFFSET(FdcanG4Registers, rxf0a, 0x094);
  CHECK_OFFSET(FdcanG4Registers, txbc, 0x0C0);
  CHECK_OFFSET(FdcanG4Registers, txfqs, 0x0C4);
  CHECK_OFFSET(FdcanG4Registers, txbrp, 0x0C8);
  CHECK_OFFSET(FdcanG4Registers, txbar, 0x0CC);
  CHECK_OFFSET(FdcanG4Registers, txbcr, 0x0D0);
  CHECK_OFFSET(FdcanG4Registers, txbto, 0x0D4);
  CHECK_OFFSET(FdcanG4Registers, txbtie, 0x0DC);
}

TEST(FdcanRegisters, AreWhereTheManualOfTheH7Says) {
  CHECK_OFFSET(FdcanH7Registers, common.cccr, 0x018);
  CHECK_OFFSET(FdcanH7Registers, common.psr, 0x044);
  CHECK_OFFSET(FdcanH7Registers, common.ir, 0x050);
  CHECK_OFFSET(FdcanH7Registers, gfc, 0x080);
  CHECK_OFFSET(FdcanH7Registers, sidfc, 0x084);
  CHECK_OFFSET(FdcanH7Registers, xidfc, 0x088);
  CHECK_OFFSET(FdcanH7Registers, xidam, 0x090);
  CHECK_OFFSET(FdcanH7Registers, rxf0c, 0x0A0);
  CHECK_OFFSET(FdcanH7Registers, rxf0s, 0x0A4);
  CHECK_OFFSET(FdcanH7Registers, rxf0a, 0x0A8);
  CHECK_OFFSET(FdcanH7Registers, rxbc, 0x0AC);
  CHECK_OFFSET(FdcanH7Registers, rxf1c, 0x0B0);
  CHECK_OFFSET(FdcanH7Registers, rxesc, 0x0BC);
  CHECK_OFFSET(FdcanH7Registers, txbc, 0x0C0);
  CHECK_OFFSET(FdcanH7Registers, txfqs, 0x0C4);
  CHECK_OFFSET(FdcanH7Registers, txesc, 0x0C8);
  CHECK_OFFSET(FdcanH7Registers, txbrp, 0x0CC);
  CHECK_OFFSET(FdcanH7Registers, txbar, 0x0D0);
  CHECK_OFFSET(FdcanH7Registers, txbcr, 0x0D4);
  CHECK_OFFSET(FdcanH7Registers, txbto, 0x0D8);
  CHECK_OFFSET(FdcanH7Registers, txbtie, 0x0E0);
  CHECK_OFFSET(FdcanH7Registers, txefc, 0x0F0);
}

TEST(FdcanMessageRam, IsDividedAsTheManualOfTheG4Says) {
  constexpr canopen::fdcan::MessageRam ram = canopen::FdcanG4::layout;
  EXPECT_EQ(ram.extended() * 4, 0x070);
  EXPECT_EQ(ram.receive() * 4, 0x0B0);
  EXPECT_EQ(ram.transmit * 4, 0x278);
  EXPECT_EQ(ram.size * 4, 0x350);
}

TEST(FdcanMessageRam, HasRoomForAllControllersOfAnH7) {
  constexpr canopen::fdcan::MessageRam ram = canopen::FdcanH7::layout;
  EXPECT_EQ(ram.transmit, ram.receive() + ram.received * ram.element);
  EXPECT_EQ(ram.size, ram.transmit + ram.transmitted * ram.element);
  EXPECT_LE(3 * ram.size, 2560);
}

TEST(FdcanBitTiming, HasTheSamplePointOfCia301) {
  constexpr canopen::BitTimingRange range = canopen::FdcanG4::range;
  EXPECT_EQ(canopen::bit_timing(170'000'000, 1'000'000, range), (canopen::BitTiming{1, 148, 21, 21}));  // 87.6 %
  EXPECT_EQ(canopen::bit_timing(80'000'000, 500'000, range), (canopen::BitTiming{1, 139, 20, 20}));     // 87.5 %
  EXPECT_EQ(canopen::bit_timing(80'000'000, 10'000, range), (canopen::BitTiming{40, 174, 25, 25}));     // 87.5 %
  EXPECT_EQ(canopen::bit_timing(8'000'000, 1'000'000, range), (canopen::BitTiming{1, 6, 1, 1}));
  EXPECT_EQ(canopen::bit_timing(170'000'000, 800'000, range), std::nullopt);
}

}  // namespace
