#include "conform/cases/pdo/tpdo_triggers.hpp"

#include <fmt/format.h>

#include "conform/cases/pdo/tpdo.hpp"

namespace edsc::conform {
namespace {

using canopen::CobId;

constexpr std::uint8_t wanted_overflow = 10;

}  // namespace

SyncSource::SyncSource(Dut& dut, Counter counter) : dut_{dut}, since_{dut.mark()} {
  dut.need(sync_cob_id);
  const std::uint64_t cob_id = dut.read_number(sync_cob_id);
  cob_id_ = static_cast<std::uint32_t>(cob_id & CobId::identifier);
  stop_production(cob_id);
  if (counter == Counter::enabled) enable_counter();
  if (dut.is_readable(sync_overflow, 0)) overflow_ = static_cast<std::uint8_t>(dut.read_number(sync_overflow));
  since_ = dut.mark();
}

/// The device must not produce SYNC while the test does.
void SyncSource::stop_production(std::uint64_t cob_id) {
  const bool produces =
      (cob_id & CobId::no_rtr_bit) != 0 && dut_.is_readable(sync_period, 0) && dut_.read_number(sync_period) != 0;
  if (!produces) return;
  if (dut_.is_writable(sync_cob_id, 0)) return dut_.write(sync_cob_id, 0, cob_id & ~std::uint64_t{CobId::no_rtr_bit});
  if (dut_.is_writable(sync_period, 0)) return dut_.write(sync_period, 0, 0);
  dut_.inconclusive("the device produces SYNC, and neither 1005h:00 nor 1006h:00 can be written to stop it");
}

/// 1019h can be written only while 1006h is 0 (CiA 301, 7.5.2.22).
void SyncSource::enable_counter() {
  dut_.need(sync_overflow);
  if (dut_.read_number(sync_overflow) != 0) return;
  dut_.need_writable(sync_overflow);
  if (dut_.is_writable(sync_period, 0) && dut_.read_number(sync_period) != 0) dut_.write(sync_period, 0, 0);
  dut_.write(sync_overflow, 0, within_limits(dut_, sync_overflow, 0, wanted_overflow));
}

void SyncSource::send() {
  if (!dut_.received_since(since_, Dut::with_cob_id(cob_id_)).empty()) {
    dut_.inconclusive(Condition::alone, fmt::format("another node produces SYNC (CAN-ID {:X}h); stop it for this case",
                                                    CobId{cob_id_}.can_id()));
  }
  sent_at_ = dut_.now();
  const std::uint8_t counter[] = {next_};
  dut_.send(make_frame(cob_id_, std::span{counter, overflow_ == 0 ? std::size_t{0} : std::size_t{1}}));
  next_ = next_ < overflow_ ? static_cast<std::uint8_t>(next_ + 1) : std::uint8_t{1};
}

std::vector<SeenFrame> SyncSource::send_and_collect(const Dut::Match& match) {
  const Dut::Mark since = dut_.mark();
  send();
  dut_.pass_time(cycle);
  return dut_.received_since(since, match);
}

Event::Event(Dut& dut, const std::vector<MappingValue>& mapping) : dut_{dut} {
  for (const MappingValue& mapped : mapping) {
    if (mapped.index < 0x2000 || !dut.is_readable(mapped.index, mapped.sub_index)) continue;
    const SdoOutcome outcome = dut.upload(mapped.index, mapped.sub_index);
    if (!outcome.done()) continue;
    const auto changed = other_value(dut, mapped, number_of(outcome.bytes) & low_bits(mapped.bits));
    if (changed) candidates_.push_back({mapped, outcome.bytes, dut.bytes_of(mapped.index, mapped.sub_index, *changed)});
  }
}

Event::~Event() {
  if (is_changed_) (void)set(candidates_.front(), false);
}

bool Event::set(const Candidate& candidate, bool changed) {
  return dut_.stimuli().set(candidate.mapped.index, candidate.mapped.sub_index,
                            changed ? candidate.changed : candidate.present);
}

bool Event::apply() {
  while (!candidates_.empty() && !set(candidates_.front(), !is_changed_)) {
    if (works_) return false;
    candidates_.erase(candidates_.begin());
  }
  if (candidates_.empty()) return false;
  works_ = true;
  is_changed_ = !is_changed_;
  return true;
}

bool Event::read_back() {
  if (candidates_.empty() || !dut_.simulated()) return true;
  const Candidate& candidate = candidates_.front();
  const SdoOutcome outcome = dut_.upload(candidate.mapped.index, candidate.mapped.sub_index);
  if (!outcome.done()) return true;
  const bool is_overwritten = outcome.bytes == (is_changed_ ? candidate.present : candidate.changed);
  if (is_overwritten) is_changed_ = !is_changed_;
  return !is_overwritten;
}

bool Event::use_next() {
  for (std::size_t next = 1; works_ && next < candidates_.size(); ++next) {
    if (!set(candidates_[next], false)) continue;
    if (is_changed_) (void)set(candidates_.front(), false);
    is_changed_ = false;
    candidates_.erase(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(next));
    return true;
  }
  return false;
}

std::string Event::object() const {
  if (candidates_.empty()) return "no object";
  return label(candidates_.front().mapped.index, candidates_.front().mapped.sub_index);
}

}  // namespace edsc::conform
