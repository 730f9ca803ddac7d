#include "conform/cases/pdo/tested_rpdo.hpp"

#include <fmt/format.h>

#include <canopen/can/cob_id.hpp>

#include "conform/cases/pdo/tpdo.hpp"
#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {
namespace {

using canopen::CobId;

/// The time that a device may need to write the objects of a received RPDO.
constexpr Duration to_apply = milliseconds{50};
constexpr std::uint64_t last_synchronous_type = 240;

/// Whether two reads with some time between them return the same value.
bool is_stable(Dut& dut, const MappingValue& mapped, std::uint64_t present) {
  const SdoOutcome outcome = dut.upload(mapped.index, mapped.sub_index);
  return outcome.done() && (number_of(outcome.bytes) & low_bits(mapped.bits)) == present;
}

}  // namespace

TestedRpdo::TestedRpdo(Dut& dut) : dut_{dut} {
  const std::vector<const Pdo*> all = dut.pdos(PdoDirection::receive);
  if (all.empty()) dut.not_applicable("the EDS has no RPDO");
  bool any = false;
  for (const bool with_synchronous : {false, true}) {
    for (const Pdo* pdo : all) {
      if (use(*pdo, with_synchronous)) return;
      any = any || !mapping_.empty();
    }
  }
  if (!any) dut.not_applicable("no valid RPDO maps an object");
  dut.inconclusive(Condition::usable_value,
                   "no valid RPDO maps an object whose value SDO can read and that does not change by itself");
}

bool TestedRpdo::use(const Pdo& pdo, bool with_synchronous) {
  mapping_.clear();
  if (pdo.multiplexed || pdo.broken || pdo.mapping == nullptr) return false;
  index_ = pdo.communication->index;
  cob_id_ = static_cast<std::uint32_t>(dut_.read_number(index_, cob_id_parameter));
  const std::uint64_t type = dut_.has(index_, type_parameter) ? dut_.read_number(index_, type_parameter) : event_driven;
  synchronous_ = type <= last_synchronous_type;
  if (!canopen::is_usable(cob_id_) || synchronous_ != with_synchronous) return false;
  if (synchronous_ && !dut_.has(sync_cob_id)) return false;
  if (dut_.has(sync_cob_id)) {
    constexpr std::uint8_t first_counter = 1;
    const bool counts = dut_.is_readable(sync_overflow) && dut_.read_number(sync_overflow) != 0;
    const auto cob_id = static_cast<std::uint32_t>(dut_.read_number(sync_cob_id)) & CobId::identifier;
    sync_ = make_frame(cob_id, std::span{&first_counter, counts ? std::size_t{1} : std::size_t{0}});
  }
  const auto mapping = read_mapping(dut_, index_);
  if (!mapping || mapping->empty() || reason_against(dut_, pdo, *mapping)) return false;
  pdo_ = &pdo;
  mapping_ = *mapping;
  present_.clear();
  other_.clear();
  std::vector<std::uint64_t> masks;
  for (const MappingValue& mapped : mapping_) {
    present_.push_back(0);
    other_.push_back(0);
    masks.push_back(0);
    if (mapped.is_dummy()) continue;
    if (!dut_.is_readable(mapped.index, mapped.sub_index)) return false;  // the test cannot restore its value
    present_.back() = dut_.read_number(mapped.index, mapped.sub_index) & low_bits(mapped.bits);
    const auto other = other_value(dut_, mapped, present_.back());
    other_.back() = other.value_or(present_.back());
    if (other) masks.back() = low_bits(mapped.bits);
  }
  dut_.pass_time(to_apply);
  for (std::size_t i = 0; i < mapping_.size(); ++i) {
    if (masks[i] != 0 && !is_stable(dut_, mapping_[i], present_[i])) masks[i] = 0;
  }
  compared_ = pack(mapping_, masks);
  if (compared_ == 0) return false;
  if (synchronous_ && !end_sync_window()) return false;
  for (const MappingValue& mapped : mapping_) {
    if (!mapped.is_dummy()) dut_.remember(mapped.index, mapped.sub_index);
  }
  return true;
}

std::string TestedRpdo::name() const { return pdo_label(*pdo_); }

unsigned TestedRpdo::size() const { return static_cast<unsigned>(bytes_for(total_bits(mapping_))); }

void TestedRpdo::send(unsigned bytes) {
  send_frame(bytes);
  if (synchronous_) send_sync();
  dut_.pass_time(to_apply);
}

void TestedRpdo::send_frame(unsigned bytes) {
  Bytes data = edsc::bytes_of(pack(mapping_, other_), size());
  data.resize(bytes, 0xFF);
  dut_.send(make_frame(cob_id_, data));
}

void TestedRpdo::send_present() {
  dut_.send(make_frame(cob_id_, edsc::bytes_of(pack(mapping_, present_), size())));
  send_sync();
  dut_.pass_time(to_apply);
}

bool TestedRpdo::end_sync_window() {
  if (!dut_.has(sync_window) || !dut_.is_readable(sync_window) || dut_.read_number(sync_window) == 0) return true;
  if (!dut_.is_writable(sync_window) || !dut_.download(sync_window, 0, 0).done()) return false;
  send_sync();  // a window that has begun ends with the next one
  return true;
}

void TestedRpdo::send_sync() {
  if (sync_) dut_.send(*sync_);
}

TestedRpdo::Applied TestedRpdo::applied() {
  const std::uint64_t read = read_image(dut_, mapping_).bits;
  std::size_t compared = 0, equal = 0;
  for (const PlacedObject& mapped : placed(mapping_)) {
    const std::uint64_t mask = low_bits(mapped.bits) << mapped.offset & compared_;
    if (mask == 0) continue;
    ++compared;
    if ((read & mask) == (pack(mapping_, other_) & mask)) ++equal;
  }
  return equal == 0 ? Applied::none : equal == compared ? Applied::all : Applied::some;
}

void TestedRpdo::expect_ignored(const std::string& when) {
  if (applied() == Applied::none) return;
  dut_.fail(fmt::format("{} is not processed {}", name(), when),
            fmt::format("an object of {} has the value of the RPDO", objects_text(mapping_)));
}

}  // namespace edsc::conform
