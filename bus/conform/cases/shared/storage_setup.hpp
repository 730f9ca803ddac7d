/// Common to the cases of 1010h and 1011h: at their end the device stores again what it had stored before.
#pragma once

#include <cstdint>

#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {

/// "save" and "load" of one sub-index of 1010h and 1011h.
class Storage {
 public:
  static constexpr std::uint8_t all = 1, communication = 2;

  Storage(Dut& dut, std::uint8_t sub_index) : dut_{dut}, sub_index_{sub_index} {}

  /// The case fails if the device refuses.
  void save() const;
  void load() const;
  /// Fails if the device accepts a wrong signature.
  void expect_refused(std::uint16_t index) const;
  /// The reset that loads stored or default values: reset communication for sub-index 2, else reset node.
  void reset() const;

 private:
  Dut& dut_;
  std::uint8_t sub_index_;
};

/// Returns 2 if 1010h can store the communication parameters alone, else 1. Not applicable if it stores nothing.
[[nodiscard]] std::uint8_t save_communication(Dut& dut);
/// Not applicable if 1010h or 1011h does not have the sub-index, or if its bit 0 (on command) is 0.
void need_command(Dut& dut, std::uint16_t index, std::uint8_t sub_index);

/// Runs a case after a reset, which loads the stored values. At the end the same values are stored again.
template <class Check>
void with_storage(Dut& dut, std::uint8_t sub_index, Check check) {
  need_command(dut, store_parameters, sub_index);
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
