#include "audit/checks/bus_check.hpp"

#include <fmt/format.h>

#include <canopen/can/frame_length.hpp>
#include <utility>

#include "text/counted.hpp"

namespace edsc::audit {
namespace {

using Texts = std::pair<std::string, std::string>;

constexpr std::int64_t interval_us = 100'000;
constexpr std::uint64_t per_mille = 1000;

std::string percent(std::uint64_t tenths) { return fmt::format("{}.{} %", tenths / 10, tenths % 10); }

struct LengthRow {
  Service service;
  std::uint8_t min, max;
  std::string_view expected;
};

constexpr LengthRow lengths[] = {{Service::sync, 0, 1, "0 or 1 byte"},
                                 {Service::time, 6, 6, "6 bytes"},
                                 {Service::heartbeat, 1, 1, "1 byte"},
                                 {Service::lss, 8, 8, "8 bytes"}};

void check_length(const SeenMessage& seen, AuditState& audit) {
  const canopen::Frame& frame = seen.frame;
  const auto* const row = std::ranges::find(lengths, seen.message.service, &LengthRow::service);
  if (row == std::end(lengths) || (!frame.remote && frame.size >= row->min && frame.size <= row->max)) return;
  const Subject subject{"frame-length", seen.message.node_id, 0, 0, frame.id, frame.extended};
  audit.findings.add(subject, seen.at, 0, [&] {
    const std::string bytes = counted(unsigned{frame.size}, "byte");
    return Texts{std::string{row->expected}, frame.remote ? "a remote frame" : bytes};
  });
}

}  // namespace

void BusCheck::end_interval(const Moment& now, AuditState& audit) {
  const std::uint64_t bits_of_interval = audit.limits.bit_rate / (1'000'000 / interval_us);
  const std::uint64_t load = interval_bits_ * per_mille / bits_of_interval;
  interval_bits_ = 0;
  max_load_ = std::max(max_load_, load);
  if (load <= audit.limits.max_load * 10U) return;
  audit.findings.add({"bus-load"}, now, static_cast<std::int64_t>(load), [&] {
    return Texts{fmt::format("at most {} %", audit.limits.max_load), percent(load)};
  });
}

void BusCheck::count_bits(const SeenMessage& seen, AuditState& audit) {
  if (audit.limits.bit_rate == 0 || !seen.at.has_time) return;
  const std::int64_t interval = seen.at.us / interval_us;
  if (interval != interval_) end_interval(seen.at, audit);
  interval_ = interval;
  const std::uint32_t bits = canopen::stuffed_bits_on_wire(seen.frame);
  interval_bits_ += bits;
  bits_ += bits;
}

void BusCheck::see(const SeenMessage& seen, AuditState& audit) {
  const Message& message = seen.message;
  if (message.service == Service::error_frame) {
    audit.findings.add({"error-frame"}, seen.at, 0, [&] { return Texts{"none", message.text}; });
    return;
  }
  count_bits(seen, audit);
  check_length(seen, audit);
  if (message.service == Service::unknown) {
    Subject subject{"can-id-unknown"};
    subject.can_id = seen.frame.id;
    subject.extended = seen.frame.extended;
    audit.findings.add(subject, seen.at, 0, [&] { return Texts{"a CAN-ID of a known node", message.text}; });
    return;
  }
  if (message.other_sender != 0) {
    Subject subject{"can-id-senders", message.node_id};
    subject.can_id = seen.frame.id;
    subject.extended = seen.frame.extended;
    audit.findings.add(subject, seen.at, 0, [&] {
      return Texts{"one sender", fmt::format("also a TPDO of node {}", unsigned{message.other_sender})};
    });
  }
  if (!is_from_node(message) || seen.frame.remote || audit.sender(message).model != nullptr) return;
  audit.findings.add({"node-unknown", message.node_id}, seen.at, 0, [&] {
    return Texts{"a node that was given", row_of(message.service).label};
  });
}

void BusCheck::finish(const Moment& end, AuditState& audit) {
  if (audit.limits.bit_rate > 0) end_interval(end, audit);
  for (const std::uint8_t id : audit.known) {
    if (audit.nodes[id].first_seen) continue;
    audit.findings.add({"node-silent", id}, end, 0, [] { return Texts{"frames of the node", "none"}; });
  }
}

std::uint64_t BusCheck::mean_load(const Moment& end, const Limits& limits) const {
  if (limits.bit_rate == 0 || end.us <= 0) return 0;
  return bits_ * per_mille * 1000 / (std::uint64_t{limits.bit_rate} * static_cast<std::uint64_t>(end.us) / 1000);
}

}  // namespace edsc::audit
