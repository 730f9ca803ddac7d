#include "conform/cases/shared/storage_setup.hpp"

#include <array>
#include <string>
#include <string_view>

namespace edsc::conform {
namespace {

Bytes signature(std::string_view letters) { return Bytes(letters.begin(), letters.end()); }

}  // namespace

void Storage::save() const {
  dut_.expect_done(dut_.command(store_parameters, sub_index_, signature("save")),
                   "\"save\" accepted by " + label(store_parameters, sub_index_));
}

void Storage::load() const {
  dut_.expect_done(dut_.command(restore_parameters, sub_index_, signature("load")),
                   "\"load\" accepted by " + label(restore_parameters, sub_index_));
}

void Storage::expect_refused(std::uint16_t index) const {
  const std::string_view right = index == store_parameters ? "save" : "load";
  for (const std::string_view letters :
       {std::string_view{"wron"}, std::string_view{right == "save" ? "evas" : "daol"}}) {
    dut_.expect_abort(dut_.command(index, sub_index_, signature(letters)), abort_rule::signature,
                      "\"" + std::string{letters} + "\" to " + label(index, sub_index_));
  }
}

void Storage::reset() const {
  dut_.reset(sub_index_ == communication ? canopen::NmtCommand::reset_communication : canopen::NmtCommand::reset_node);
}

void need_command(Dut& dut, std::uint16_t index, std::uint8_t sub_index) {
  dut.need_part("storage");
  dut.need_writable(index, sub_index);
  if ((dut.read_number(index, sub_index) & 1U) == 0) {
    dut.not_applicable(label(index, sub_index) + ": bit 0 is 0, the device does not support it on command");
  }
}

std::uint8_t save_communication(Dut& dut) {
  const bool apart = dut.is_writable(store_parameters, Storage::communication) &&
                     (dut.read_number(store_parameters, Storage::communication) & 1U) != 0;
  return apart ? Storage::communication : Storage::all;
}

}  // namespace edsc::conform
