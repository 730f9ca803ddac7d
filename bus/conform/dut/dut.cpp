#include "conform/dut/dut.hpp"

#include <fmt/format.h>

#include "values/little_endian.hpp"

namespace edsc::conform {
namespace {

std::uint32_t seed_of(std::uint32_t seed, std::string_view id) {
  for (const char letter : id) seed = seed * 31 + static_cast<unsigned char>(letter);
  return seed;
}

}  // namespace

std::string label(std::uint16_t index, std::uint8_t sub_index) { return entry_label(index, sub_index); }

Dut::Dut(LiveBus& bus, const Device& sheet, Stimuli& stimuli, const DutSettings& settings)
    : bus_{bus},
      sheet_{sheet},
      stimuli_{stimuli},
      settings_{settings},
      sdo_{bus, settings.node, settings.sdo},
      random_{settings.seed},
      last_time_{bus.now()} {
  bus_.on_frame = [this](const canopen::Frame& frame, canopen::TimePoint) { record(frame, bus_.received_at(), false); };
  bus_.on_sent = [this](const canopen::Frame& frame, canopen::TimePoint at) { record(frame, at, true); };
}

Dut::~Dut() {
  bus_.on_frame = nullptr;
  bus_.on_sent = nullptr;
}

// ---- the EDS ----

const Entry* Dut::entry(std::uint16_t index, std::uint8_t sub_index) const { return sheet_.find(index, sub_index); }

bool Dut::has(std::uint16_t index, std::uint8_t sub_index) const { return entry(index, sub_index) != nullptr; }

bool Dut::is_readable(std::uint16_t index, std::uint8_t sub_index) const {
  const Entry* const found = entry(index, sub_index);
  return found != nullptr && canopen::readable(found->access);
}

bool Dut::is_writable(std::uint16_t index, std::uint8_t sub_index) const {
  const Entry* const found = entry(index, sub_index);
  return found != nullptr && canopen::writable(found->access);
}

const Entry& Dut::need(std::uint16_t index, std::uint8_t sub_index) {
  const Entry* const found = entry(index, sub_index);
  if (found == nullptr) not_applicable(label(index, sub_index) + " does not exist in the EDS");
  return *found;
}

const Entry& Dut::need_writable(std::uint16_t index, std::uint8_t sub_index) {
  const Entry& found = need(index, sub_index);
  if (!canopen::writable(found.access)) {
    not_applicable(fmt::format("{} is {} in the EDS", label(index, sub_index), canopen::row_of(found.access).name));
  }
  return found;
}

std::optional<std::uint64_t> Dut::default_of(std::uint16_t index, std::uint8_t sub_index) const {
  const Entry* const found = entry(index, sub_index);
  if (found == nullptr || !found->default_value || found->type == nullptr || found->type->bits == 0)
    return std::nullopt;
  const std::uint64_t bits = found->default_value->bits + (found->default_value->plus_node_id ? node().value() : 0U);
  return bits & low_bits(found->type->bits);
}

std::vector<LiveEntry> Dut::entries() const {
  std::vector<LiveEntry> all;
  for (const Object& object : sheet_.objects) {
    for (const Entry& found : object.entries) all.push_back(live_entry(object, found));
  }
  return all;
}

std::vector<const Pdo*> Dut::pdos(PdoDirection direction) const {
  std::vector<const Pdo*> found;
  for (const Pdo& pdo : sheet_.pdos) {
    if (pdo.direction == direction && pdo.communication != nullptr) found.push_back(&pdo);
  }
  return found;
}

// ---- for the runner ----

void Dut::begin_case(const CaseRow& row) {
  frames_.clear();
  warnings_.clear();
  lag_ = 0;
  next_answer_ = 0;
  failed_.reset();
  case_began_ = now();
  random_.seed(seed_of(settings_.seed, row.id));
  stimuli_.begin_case(row.id);
}

void Dut::end_case(CaseResult& result) {
  if (transfer_open_) end_transfer();
  result.began = case_began_;
  result.took = now() - case_began_;
  result.lag = lag_;
  result.warnings = std::move(warnings_);
  result.frames = frames_;
  result.until_failure = failed_;
  result.not_put_back = put_back();
}

std::vector<std::string> Dut::find_state() {
  if (settings_.level == Level::read) return {};
  try {
    if (watch_state()) found_state_ = state();
  } catch (const CaseEnd&) {
    // 1017h cannot be used as the EDS says: a case will report it.
  }
  return put_back();
}

}  // namespace edsc::conform
