/// What cases of 1010h and 1011h have in common: the device stores what it had stored before when they are over.
#pragma once

#include <cstdint>

#include "conform/cases/setup.hpp"

namespace edsc::conform {

/// "save" and "load" of one sub-index of 1010h and 1011h.
class Storage {
 public:
  static constexpr std::uint8_t all = 1, communication = 2;

  Storage(Dut& dut, std::uint8_t sub_index) : dut_{dut}, sub_index_{sub_index} {}

  /// The case fails where the device refuses.
  void save() const;
  void load() const;
  /// Fails where the device takes another signature than that of 1010h or 1011h.
  void expect_refused(std::uint16_t index) const;
  /// The reset that brings stored values and defaults: of sub-index 2 that of the communication.
  void reset() const;

  [[nodiscard]] std::uint8_t sub_index() const { return sub_index_; }

 private:
  Dut& dut_;
  std::uint8_t sub_index_;
};

/// 2 where 1010h can store the communication parameters alone, else 1. Not applicable where it stores nothing.
[[nodiscard]] std::uint8_t save_communication(Dut& dut);
/// Not applicable where 1010h or 1011h does not have the sub-index, or says by bit 0 that it does nothing on command.
void need_command(Dut& dut, std::uint16_t index, std::uint8_t sub_index);

/// Runs a case after a reset, with what the device has stored. Afterwards the same is stored again.
template <class Check>
void with_storage(Dut& dut, std::uint8_t sub_index, Check check) {
  need_command(dut, 0x1010, sub_index);
  dut.reset(canopen::NmtCommand::reset_node);
  const Dut::Values before = dut.values();
  const Storage storage{dut, sub_index};
  const auto store_again = [&] {
    dut.enter(canopen::NmtState::pre_operational);
    dut.restore(before);
    storage.save();
  };
  and_undo([&] { check(storage); }, store_again);
}

}  // namespace edsc::conform
