#include "conform/cases/pdo_area.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/pdo/pdo_mapping.hpp>
#include <canopen/pdo/transmission_type.hpp>
#include <iterator>
#include <utility>

namespace edsc::conform::pdo_area {
namespace {

using canopen::CobId;
using canopen::DataClass;
using Code = canopen::AbortCode;

constexpr std::uint16_t sync_cob_id = 0x1005, sync_period = 0x1006, sync_counter = 0x1019;
constexpr std::uint8_t wanted_overflow = 10;

/// The device refuses what it does not support with 0609 0030h (CiA 301, 7.5.2.35 and 7.5.2.37).
constexpr AbortRule not_supported{{Code::invalid_value}, {Code::value_too_high, Code::value_too_low, Code::general}};
/// Bit 30 of a COB-ID also with 0601 0000h, if bits 0 to 30 cannot be changed at all.
constexpr AbortRule flag_not_supported{{Code::invalid_value, Code::unsupported_access}, {Code::general}};

constexpr std::uint64_t mask_of(unsigned bits) {
  return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
}

bool is_writable(const Dut& dut, std::uint16_t index, std::uint8_t sub_index) {
  const Entry* const entry = dut.entry(index, sub_index);
  return entry != nullptr && canopen::writable(entry->access);
}

bool is_readable(const Dut& dut, std::uint16_t index, std::uint8_t sub_index) {
  const Entry* const entry = dut.entry(index, sub_index);
  return entry != nullptr && canopen::readable(entry->access);
}

std::string access_text(const Entry& entry) {
  return fmt::format("{} is {} in the EDS", label(entry.index, entry.sub_index), canopen::row_of(entry.access).name);
}

/// The range of an integer: the lowest value, and the number of values above it.
struct Range {
  std::uint64_t low = 0;
  std::uint64_t span = 0;
};

std::uint64_t limit_of(const Dut& dut, const Value& value) {
  return value.bits + (value.plus_node_id ? dut.node().value() : 0U);
}

Range range_of(const Dut& dut, const Entry& entry) {
  const unsigned bits = entry.type->bits;
  const bool is_signed = entry.type->kind == DataClass::signed_integer;
  const std::uint64_t top = mask_of(bits);
  std::uint64_t low = is_signed ? ~(top >> 1) : 0;
  std::uint64_t high = is_signed ? top >> 1 : top;
  if (entry.low_limit) low = limit_of(dut, *entry.low_limit);
  if (entry.high_limit) high = limit_of(dut, *entry.high_limit);
  return {low, high - low};
}

/// Extends a value of a data type to 64 bits, as `Value` holds it.
std::uint64_t extended(const Entry& entry, std::uint64_t value) {
  const unsigned bits = entry.type->bits;
  const bool negative = entry.type->kind == DataClass::signed_integer && (value >> (bits - 1) & 1) != 0;
  return negative ? value | ~mask_of(bits) : value;
}

std::optional<std::uint64_t> present_parameter(Dut& dut, std::uint16_t index, std::uint8_t sub_index) {
  if (!dut.has(index, sub_index)) return sub_index == type_parameter ? event_driven : 0;
  if (!is_readable(dut, index, sub_index)) return std::nullopt;
  return dut.read_number(index, sub_index);
}

/// Writes the parameter unless it has the value. Returns the reason if that is not possible.
std::optional<std::string> set_parameter(Dut& dut, const Tpdo& tpdo, std::uint8_t sub_index, std::uint64_t value,
                                         bool is_disabled) {
  if (present_parameter(dut, tpdo.index, sub_index) == value) return std::nullopt;
  const std::string name = label(tpdo.index, sub_index);
  const Entry* const entry = dut.entry(tpdo.index, sub_index);
  if (entry == nullptr) return name + " does not exist in the EDS";
  if (!canopen::writable(entry->access)) return access_text(*entry);
  if (within_limits(dut, tpdo.index, sub_index, value) != value) {
    return fmt::format("the limits of {} do not allow {}", name, value);
  }
  const bool only_while_invalid = sub_index == inhibit_parameter || sub_index == sync_start_parameter;
  if (only_while_invalid && !is_disabled) {
    return fmt::format("{} can be written only while the PDO is not valid, and {} cannot be written", name,
                       label(tpdo.index, cob_id_parameter));
  }
  const SdoOutcome outcome = dut.download(tpdo.index, sub_index, value);
  if (outcome.done()) return std::nullopt;
  dut.expect_abort(outcome, not_supported, fmt::format("{} written to {}", value, name));
  return fmt::format("{} does not accept {}", name, value);
}

std::optional<std::string> set_parameters(Dut& dut, const Tpdo& tpdo, const Transmission& wanted, bool is_disabled) {
  const bool by_event = canopen::transmission_of(wanted.type) == canopen::Transmission::event_driven;
  if (!by_event) {
    if (auto why = set_parameter(dut, tpdo, type_parameter, wanted.type, is_disabled)) return why;
    return set_parameter(dut, tpdo, sync_start_parameter, wanted.sync_start, is_disabled);
  }
  const auto present = present_parameter(dut, tpdo.index, type_parameter);
  if (!present || *present < 254) {
    std::optional<std::string> why = set_parameter(dut, tpdo, type_parameter, 255, is_disabled);
    if (why && set_parameter(dut, tpdo, type_parameter, 254, is_disabled)) return why;
  }
  if (auto why = set_parameter(dut, tpdo, inhibit_parameter, wanted.inhibit_time, is_disabled)) return why;
  return set_parameter(dut, tpdo, timer_parameter, wanted.event_timer, is_disabled);
}

/// Writes the COB-ID with which the TPDO is valid. Returns the reason if that is not possible.
std::optional<std::string> enable(Dut& dut, const Tpdo& tpdo, std::optional<bool> remote_frames) {
  std::uint32_t cob_id = tpdo.cob_id;
  if (remote_frames) cob_id = (cob_id & ~CobId::no_rtr_bit) | (*remote_frames ? 0 : CobId::no_rtr_bit);
  const std::string name = label(tpdo.index, cob_id_parameter);
  if (!is_writable(dut, tpdo.index, cob_id_parameter)) {
    if (cob_id == tpdo.found_cob_id) return std::nullopt;
    return access_text(*dut.entry(tpdo.index, cob_id_parameter));
  }
  const SdoOutcome outcome = dut.download(tpdo.index, cob_id_parameter, cob_id);
  const std::string what = fmt::format("{:08X}h written to {}", cob_id, name);
  if (cob_id == tpdo.found_cob_id) {
    dut.expect_done(outcome, what);
  } else if (!outcome.done()) {
    dut.expect_abort(outcome, flag_not_supported, what);
    return fmt::format("{} does not accept {:08X}h", name, cob_id);
  } else if (dut.read_number(tpdo.index, cob_id_parameter) != cob_id) {
    return fmt::format("{} does not keep {:08X}h", name, cob_id);
  }
  return std::nullopt;
}

}  // namespace

void fail_value(Dut& dut, std::uint16_t index, std::uint8_t sub_index, std::uint64_t value, std::string_view rule,
                const std::string& expected, const std::string& got) {
  if (dut.default_of(index, sub_index).value_or(0) == value) dut.fail_by_sheet(rule, expected, got);
  dut.fail(expected, got);
}

// ---- mapping ----

Mapped mapped_of(std::uint64_t value) {
  return {static_cast<std::uint16_t>(value >> 16), static_cast<std::uint8_t>(value >> 8),
          static_cast<std::uint8_t>(value)};
}

std::uint16_t mapping_of(std::uint16_t communication) { return static_cast<std::uint16_t>(communication + 0x200); }

unsigned bits_of(const std::vector<Mapped>& mapping) {
  unsigned bits = 0;
  for (const Mapped& mapped : mapping) bits += mapped.bits;
  return bits;
}

std::optional<std::vector<Mapped>> read_mapping(Dut& dut, std::uint16_t communication) {
  const std::uint16_t index = mapping_of(communication);
  std::vector<Mapped> mapping;
  if (!is_readable(dut, index, 0)) return mapping;
  const std::uint64_t count = dut.read_number(index, 0);
  if (count >= canopen::source_multiplexed) return std::nullopt;
  for (std::uint64_t i = 1; i <= count; ++i) {
    const auto sub_index = static_cast<std::uint8_t>(i);
    mapping.push_back(is_readable(dut, index, sub_index) ? mapped_of(dut.read_number(index, sub_index)) : Mapped{});
  }
  return mapping;
}

bool may_carry(PdoDirection direction, const Entry& entry) {
  const bool receives = direction == PdoDirection::receive;
  return allows(entry.mappable(), receives ? canopen::Mappable::rpdo : canopen::Mappable::tpdo);
}

std::optional<MappingFault> fault_of(const Dut& dut, PdoDirection direction, const Mapped& mapped) {
  const bool receives = direction == PdoDirection::receive;
  const std::string got = fmt::format("{:08X}h", mapped.value());
  if (mapped.value() == 0) return MappingFault{"pdo-mapping-gap", "a mapped object, as sub-index 0 counts it", got};
  if (mapped.is_dummy()) {
    const bool in_use = std::ranges::find(dut.sheet().dummies, mapped.index) != dut.sheet().dummies.end();
    if (receives && in_use) return std::nullopt;
    return MappingFault{"pdo-dummy", "an object, or in an RPDO a dummy of [DummyUsage]", got};
  }
  const Entry* const entry = dut.entry(mapped.index, mapped.sub_index);
  if (entry == nullptr) return MappingFault{"pdo-object", "an object of the EDS", got};
  if (!may_carry(direction, *entry)) {
    return MappingFault{entry->pdo_mapping ? "pdo-direction" : "pdo-mappable",
                        receives ? "an object with PDOMapping=1 that is rw, rww or wo"
                                 : "an object with PDOMapping=1 that is rw, rwr, ro or const",
                        fmt::format("{}, which is {} with PDOMapping={}", got, canopen::row_of(entry->access).name,
                                    entry->pdo_mapping ? 1 : 0)};
  }
  const bool is_boolean_byte = entry->type->kind == DataClass::boolean && mapped.bits == 8;
  if (entry->type->bits == 0 || entry->type->bits == mapped.bits || is_boolean_byte) return std::nullopt;
  return MappingFault{
      "pdo-length",
      fmt::format("{} with the {} bits of its data type", label(mapped.index, mapped.sub_index), entry->type->bits),
      got};
}

std::optional<std::string> reason_against(const Dut& dut, const Pdo& pdo, const std::vector<Mapped>& mapping) {
  for (const Mapped& mapped : mapping) {
    if (const auto fault = fault_of(dut, pdo.direction, mapped)) {
      return fmt::format("{} maps {}, which the EDS does not allow", pdo_label(pdo), fault->got);
    }
  }
  if (bits_of(mapping) > 64) return pdo_label(pdo) + " maps more than 64 bits";
  return std::nullopt;
}

std::string objects_text(const std::vector<Mapped>& mapping) {
  std::string text;
  for (const Mapped& mapped : mapping) {
    if (!text.empty()) text += &mapped == &mapping.back() ? " and " : ", ";
    text += label(mapped.index, mapped.sub_index);
  }
  return text;
}

Image read_image(Dut& dut, const std::vector<Mapped>& mapping) {
  Image image;
  unsigned at = 0;
  for (const Mapped& mapped : mapping) {
    if (at < 64 && is_readable(dut, mapped.index, mapped.sub_index)) {
      const SdoOutcome outcome = dut.upload(mapped.index, mapped.sub_index);
      if (outcome.done()) {
        image.bits |= (number_of(outcome.bytes) & mask_of(mapped.bits)) << at;
        image.known |= mask_of(mapped.bits) << at;
      }
    }
    at += mapped.bits;
  }
  return image;
}

std::uint64_t pack(const std::vector<Mapped>& mapping, std::span<const std::uint64_t> values) {
  std::uint64_t bits = 0;
  unsigned at = 0;
  for (std::size_t i = 0; i < mapping.size() && at < 64; at += mapping[i++].bits) {
    bits |= (values[i] & mask_of(mapping[i].bits)) << at;
  }
  return bits;
}

std::uint64_t within_limits(const Dut& dut, std::uint16_t index, std::uint8_t sub_index, std::uint64_t value) {
  const Entry* const entry = dut.entry(index, sub_index);
  if (entry == nullptr || entry->type == nullptr || entry->type->bits == 0) return value;
  const Range range = range_of(dut, *entry);
  const std::uint64_t extended_value = extended(*entry, value);
  if (extended_value - range.low <= range.span) return value;
  const bool is_below = static_cast<std::int64_t>(extended_value) < static_cast<std::int64_t>(range.low);
  return (is_below ? range.low : range.low + range.span) & mask_of(entry->type->bits);
}

std::optional<std::uint64_t> other_value(const Dut& dut, const Mapped& mapped, std::uint64_t present,
                                         std::uint64_t salt) {
  const Entry* const entry = dut.entry(mapped.index, mapped.sub_index);
  if (entry == nullptr || entry->type == nullptr || entry->type->bits != mapped.bits) return std::nullopt;
  const DataClass kind = entry->type->kind;
  if (kind == DataClass::boolean) return present == 0 ? 1 : 0;
  if (kind == DataClass::real && !entry->low_limit && !entry->high_limit) {
    constexpr std::uint64_t half32 = 0x3F00'0000, half64 = 0x3FE0'0000'0000'0000;  // 0.5
    const std::uint64_t half = mapped.bits == 32 ? half32 : half64;
    return present == half ? 0 : half;
  }
  if (kind != DataClass::unsigned_integer && kind != DataClass::signed_integer) return std::nullopt;
  const Range range = range_of(dut, *entry);
  if (range.span == 0) return std::nullopt;
  const std::uint64_t above = std::min(extended(*entry, present) - range.low, range.span);
  const std::uint64_t step = std::min(salt, range.span);
  const std::uint64_t other = above <= range.span - step ? above + step : above >= step ? above - step : 0;
  return (range.low + other) & mask_of(mapped.bits);
}

// ---- a TPDO ----

std::string Tpdo::name() const {
  return fmt::format("{} ({:04X}h, CAN-ID {:X}h)", pdo_label(*pdo), index, CobId{cob_id}.can_id());
}

std::optional<Tpdo> read_tpdo(Dut& dut, const Pdo& pdo, std::string& reason) {
  Tpdo tpdo;
  tpdo.pdo = &pdo;
  tpdo.index = pdo.communication->index;
  const std::string name = pdo_label(pdo);
  const auto skip = [&reason](std::string why) {
    reason = std::move(why);
    return std::nullopt;
  };
  if (!is_readable(dut, tpdo.index, cob_id_parameter)) return skip(name + " has no COB-ID in the EDS");
  tpdo.found_cob_id = static_cast<std::uint32_t>(dut.read_number(tpdo.index, cob_id_parameter));
  tpdo.cob_id = tpdo.found_cob_id & ~CobId::invalid_bit;
  if (!tpdo.was_valid() && !is_writable(dut, tpdo.index, cob_id_parameter)) {
    return skip(name + " is not valid and cannot be enabled");
  }
  if (!canopen::may_be_written(CobId{tpdo.cob_id}, true, true)) {
    return skip(fmt::format("{} has no usable CAN-ID: its COB-ID is {:08X}h", name, tpdo.found_cob_id));
  }
  auto mapping = read_mapping(dut, tpdo.index);
  if (!mapping) return skip(name + " is a multiplex PDO");
  if (mapping->empty()) return skip(name + " maps no object");
  if (auto why = reason_against(dut, pdo, *mapping)) return skip(std::move(*why));
  tpdo.mapping = std::move(*mapping);
  for (const std::uint8_t sub_index : {type_parameter, inhibit_parameter, timer_parameter, sync_start_parameter}) {
    if (is_readable(dut, tpdo.index, sub_index)) tpdo.found[sub_index] = dut.read_number(tpdo.index, sub_index);
  }
  return tpdo;
}

std::vector<Tpdo> tpdos(Dut& dut) {
  dut.enter(NmtState::pre_operational);
  std::vector<Tpdo> found;
  std::string reason;
  for (const Pdo* pdo : dut.pdos(PdoDirection::transmit)) {
    std::string why;
    if (auto tpdo = read_tpdo(dut, *pdo, why)) found.push_back(std::move(*tpdo));
    if (reason.empty()) reason = why;
  }
  std::vector<std::uint32_t> in_use;
  for (const Tpdo& tpdo : found) {
    if (tpdo.was_valid()) in_use.push_back(tpdo.cob_id & CobId::identifier);
  }
  std::erase_if(found, [&](const Tpdo& tpdo) {
    const auto users = std::ranges::count(in_use, tpdo.cob_id & CobId::identifier);
    const bool is_shared = users > (tpdo.was_valid() ? 1 : 0);
    if (is_shared) reason = tpdo.name() + " shares its CAN-ID with another TPDO";
    return is_shared;
  });
  if (found.empty()) dut.not_applicable(reason.empty() ? "the EDS has no TPDO" : reason);
  return found;
}

std::optional<std::string> configure(Dut& dut, const Tpdo& tpdo, const Transmission& wanted) {
  const bool is_disabled = is_writable(dut, tpdo.index, cob_id_parameter);
  if (is_disabled) dut.write(tpdo.index, cob_id_parameter, tpdo.cob_id | CobId::invalid_bit);
  std::optional<std::string> why = set_parameters(dut, tpdo, wanted, is_disabled);
  if (!why) why = enable(dut, tpdo, wanted.remote_frames);
  if (why) put_back(dut, tpdo);
  return why;
}

void put_back(Dut& dut, const Tpdo& tpdo) {
  const bool has_writable_cob_id = is_writable(dut, tpdo.index, cob_id_parameter);
  if (has_writable_cob_id) dut.write(tpdo.index, cob_id_parameter, tpdo.cob_id | CobId::invalid_bit);
  for (const auto& [sub_index, value] : tpdo.found) {
    if (is_writable(dut, tpdo.index, sub_index) && dut.read_number(tpdo.index, sub_index) != value) {
      dut.write(tpdo.index, sub_index, value);
    }
  }
  if (has_writable_cob_id) dut.write(tpdo.index, cob_id_parameter, tpdo.found_cob_id);
}

// ---- frames ----

std::uint64_t data_of(const canopen::Frame& frame) { return number_of(std::span{frame.data.data(), frame.size}); }

std::string frame_text(const canopen::Frame& frame) {
  std::string text = fmt::format("{:X}h, {} {}", frame.id, frame.size, frame.size == 1 ? "byte" : "bytes");
  for (std::uint8_t i = 0; i < frame.size; ++i) fmt::format_to(std::back_inserter(text), " {:02X}", frame.data[i]);
  return text;
}

std::string frames_text(const std::vector<SeenFrame>& frames) {
  if (frames.empty()) return "no frame";
  if (frames.size() == 1) return frame_text(frames.front().frame);
  return fmt::format("{} frames, the first {}", frames.size(), frame_text(frames.front().frame));
}

void expect_data(Dut& dut, const Tpdo& tpdo, const SeenFrame& seen, const Image& image) {
  dut.expect(seen.frame.size == tpdo.size(),
             fmt::format("{} with {} data bytes for {} mapped bits", tpdo.name(), tpdo.size(), bits_of(tpdo.mapping)),
             frame_text(seen.frame));
  const std::uint64_t data = data_of(seen.frame);
  if (((data ^ image.bits) & image.known) == 0) return;
  canopen::Frame expected = seen.frame;
  const std::uint64_t bits = (image.bits & image.known) | (data & ~image.known);
  for (std::size_t i = 0; i < expected.data.size(); ++i) expected.data[i] = static_cast<std::uint8_t>(bits >> 8 * i);
  dut.fail(fmt::format("{} with the values that SDO reads from {}: {}", tpdo.name(), objects_text(tpdo.mapping),
                       frame_text(expected)),
           frame_text(seen.frame));
}

void expect_present_data(Dut& dut, const Tpdo& tpdo, const SeenFrame& seen, const Image& before) {
  Image image = read_image(dut, tpdo.mapping);
  image.known &= before.known & ~(image.bits ^ before.bits);
  expect_data(dut, tpdo, seen, image);
}

void settle(Dut& dut, const Tpdo& tpdo) {
  constexpr unsigned most = 10;
  for (unsigned i = 0; i < most && !dut.collect(tpdo.frames(), silence).empty(); ++i) {
  }
}

canopen::Frame make_frame(std::uint32_t cob_id, std::span<const std::uint8_t> data) {
  canopen::Frame frame;
  frame.id = CobId{cob_id}.can_id();
  frame.extended = CobId{cob_id}.extended();
  frame.size = static_cast<std::uint8_t>(data.size());
  std::ranges::copy(data, frame.data.begin());
  return frame;
}

canopen::Frame make_remote_frame(std::uint32_t cob_id, std::uint8_t size) {
  canopen::Frame frame = make_frame(cob_id, {});
  frame.remote = true;
  frame.size = size;
  return frame;
}

// ---- triggers of a TPDO ----

SyncSource::SyncSource(Dut& dut, Counter counter) : dut_{dut}, since_{dut.mark()} {
  dut.need(sync_cob_id);
  const std::uint64_t cob_id = dut.read_number(sync_cob_id);
  cob_id_ = static_cast<std::uint32_t>(cob_id & CobId::identifier);
  stop_production(cob_id);
  if (counter == Counter::enabled) enable_counter();
  if (is_readable(dut, sync_counter, 0)) overflow_ = static_cast<std::uint8_t>(dut.read_number(sync_counter));
  since_ = dut.mark();
}

/// The device must not produce SYNC while the test does.
void SyncSource::stop_production(std::uint64_t cob_id) {
  const bool produces =
      (cob_id & CobId::no_rtr_bit) != 0 && is_readable(dut_, sync_period, 0) && dut_.read_number(sync_period) != 0;
  if (!produces) return;
  if (is_writable(dut_, sync_cob_id, 0)) return dut_.write(sync_cob_id, 0, cob_id & ~std::uint64_t{CobId::no_rtr_bit});
  if (is_writable(dut_, sync_period, 0)) return dut_.write(sync_period, 0, 0);
  dut_.inconclusive("the device produces SYNC, and neither 1005h:00 nor 1006h:00 can be written to stop it");
}

/// 1019h can be written only while 1006h is 0 (CiA 301, 7.5.2.22).
void SyncSource::enable_counter() {
  dut_.need(sync_counter);
  if (dut_.read_number(sync_counter) != 0) return;
  dut_.need_writable(sync_counter);
  if (is_writable(dut_, sync_period, 0) && dut_.read_number(sync_period) != 0) dut_.write(sync_period, 0, 0);
  dut_.write(sync_counter, 0, within_limits(dut_, sync_counter, 0, wanted_overflow));
}

void SyncSource::send() {
  if (!dut_.received_since(since_, Dut::with_cob_id(cob_id_)).empty()) {
    dut_.inconclusive(
        fmt::format("another node produces SYNC (CAN-ID {:X}h); stop it for this case", CobId{cob_id_}.can_id()));
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

Event::Event(Dut& dut, const std::vector<Mapped>& mapping) : stimuli_{dut.stimuli()} {
  for (const Mapped& mapped : mapping) {
    if (mapped.index < 0x2000 || !is_readable(dut, mapped.index, mapped.sub_index)) continue;
    const SdoOutcome outcome = dut.upload(mapped.index, mapped.sub_index);
    if (!outcome.done()) continue;
    const auto changed = other_value(dut, mapped, number_of(outcome.bytes) & mask_of(mapped.bits));
    if (changed) candidates_.push_back({mapped, outcome.bytes, dut.bytes_of(mapped.index, mapped.sub_index, *changed)});
  }
}

Event::~Event() {
  if (is_changed_) (void)set(candidates_.front(), false);
}

bool Event::set(const Candidate& candidate, bool changed) {
  return stimuli_.set(candidate.mapped.index, candidate.mapped.sub_index,
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

}  // namespace edsc::conform::pdo_area
