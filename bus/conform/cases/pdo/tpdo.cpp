#include "conform/cases/pdo/tpdo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/od/access.hpp>
#include <canopen/pdo/transmission_type.hpp>
#include <utility>

#include "text/counted.hpp"

namespace edsc::conform {
namespace {

using canopen::CobId;
using Code = canopen::AbortCode;

/// The device refuses what it does not support with 0609 0030h (CiA 301, 7.5.2.35 and 7.5.2.37).
constexpr AbortRule not_supported{{Code::invalid_value}, {Code::value_too_high, Code::value_too_low, Code::general}};
/// Bit 30 of a COB-ID also with 0601 0000h, if bits 0 to 30 cannot be changed at all.
constexpr AbortRule flag_not_supported{{Code::invalid_value, Code::unsupported_access}, {Code::general}};

std::string access_text(const Entry& entry) {
  return fmt::format("{} is {} in the EDS", label(entry.index, entry.sub_index), canopen::row_of(entry.access).name);
}

std::optional<std::uint64_t> present_parameter(Dut& dut, std::uint16_t index, std::uint8_t sub_index) {
  if (!dut.has(index, sub_index)) return sub_index == type_parameter ? event_driven : 0;
  if (!dut.is_readable(index, sub_index)) return std::nullopt;
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
  if (!dut.is_writable(tpdo.index, cob_id_parameter)) {
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
  if (!dut.is_readable(tpdo.index, cob_id_parameter)) return skip(name + " has no COB-ID in the EDS");
  tpdo.found_cob_id = static_cast<std::uint32_t>(dut.read_number(tpdo.index, cob_id_parameter));
  tpdo.cob_id = tpdo.found_cob_id & ~CobId::invalid_bit;
  if (!tpdo.was_valid() && !dut.is_writable(tpdo.index, cob_id_parameter)) {
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
    if (dut.is_readable(tpdo.index, sub_index)) tpdo.found[sub_index] = dut.read_number(tpdo.index, sub_index);
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
  const bool is_disabled = dut.is_writable(tpdo.index, cob_id_parameter);
  if (is_disabled) dut.write(tpdo.index, cob_id_parameter, tpdo.cob_id | CobId::invalid_bit);
  std::optional<std::string> why = set_parameters(dut, tpdo, wanted, is_disabled);
  if (!why) why = enable(dut, tpdo, wanted.remote_frames);
  if (why) restore(dut, tpdo);
  return why;
}

void restore(Dut& dut, const Tpdo& tpdo) {
  const bool has_writable_cob_id = dut.is_writable(tpdo.index, cob_id_parameter);
  if (has_writable_cob_id) dut.write(tpdo.index, cob_id_parameter, tpdo.cob_id | CobId::invalid_bit);
  for (const auto& [sub_index, value] : tpdo.found) {
    if (dut.is_writable(tpdo.index, sub_index) && dut.read_number(tpdo.index, sub_index) != value) {
      dut.write(tpdo.index, sub_index, value);
    }
  }
  if (has_writable_cob_id) dut.write(tpdo.index, cob_id_parameter, tpdo.found_cob_id);
}

// ---- frames ----

std::string frame_text(const canopen::Frame& frame) {
  return fmt::format("{:X}h, {}{}{}", frame.id, counted(unsigned{frame.size}, "byte"), frame.size == 0 ? "" : " ",
                     hex_bytes(data_of(frame)));
}

std::string frames_text(const std::vector<SeenFrame>& frames) {
  if (frames.empty()) return "no frame";
  if (frames.size() == 1) return frame_text(frames.front().frame);
  return fmt::format("{} frames, the first {}", frames.size(), frame_text(frames.front().frame));
}

void expect_data(Dut& dut, const Tpdo& tpdo, const SeenFrame& seen, const Image& image) {
  dut.expect(
      seen.frame.size == tpdo.size(),
      fmt::format("{} with {} data bytes for {} mapped bits", tpdo.name(), tpdo.size(), total_bits(tpdo.mapping)),
      frame_text(seen.frame), std::span{&seen, 1});
  const std::uint64_t data = number_of(data_of(seen.frame));
  if (((data ^ image.bits) & image.known) == 0) return;
  // An object that changes by itself may have had other values between the reads and the frame.
  const std::uint64_t known = image.known & ~live_bits(dut, tpdo.mapping);
  if (((data ^ image.bits) & known) == 0) return;
  canopen::Frame expected = seen.frame;
  const std::uint64_t bits = (image.bits & known) | (data & ~known);
  for (std::size_t i = 0; i < expected.data.size(); ++i) expected.data[i] = static_cast<std::uint8_t>(bits >> 8 * i);
  dut.name_frames(std::span{&seen, 1});
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

}  // namespace edsc::conform
