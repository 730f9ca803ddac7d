#include "audit/cycle_report.hpp"

#include <fmt/format.h>

#include <vector>

#include "device/device.hpp"
#include "text/printable.hpp"
#include "text/text_table.hpp"
#include "values/append.hpp"

namespace edsc::audit {
namespace {

using json = nlohmann::ordered_json;

struct KindRow {
  CycleKind kind;
  std::string_view name;   ///< in JSON
  std::string_view label;  ///< in text
};

constexpr KindRow kinds[] = {{CycleKind::sync, "sync", "SYNC"},
                             {CycleKind::heartbeat, "heartbeat", "heartbeat"},
                             {CycleKind::tpdo, "tpdo", "TPDO"},
                             {CycleKind::rpdo, "rpdo", "RPDO"}};

const KindRow& row_of(CycleKind kind) { return kinds[static_cast<std::size_t>(kind)]; }

bool is_pdo(CycleKind kind) { return kind == CycleKind::tpdo || kind == CycleKind::rpdo; }

std::uint8_t node_of(const CycleKey& key, const Cycle& cycle) {
  return key.kind == CycleKind::sync ? cycle.producer : key.node_id;
}

std::string can_id_text(const Cycle& cycle) {
  const bool extended = (cycle.cob_id >> 29 & 1) != 0;
  return fmt::format("{:0{}X}h", cycle.cob_id & 0x1FFF'FFFF, extended ? 8 : 3);
}

/// `node 5 axis1 TPDO 2`, `SYNC of node 6`
std::string subject_of(const CycleKey& key, const Cycle& cycle, const NodeLabels& labels) {
  const std::uint8_t node_id = node_of(key, cycle);
  std::string node;
  if (node_id != 0) {
    node = fmt::format("node {}", node_id);
    if (const std::string_view name = labels.name(node_id); !name.empty()) node += fmt::format(" {}", name);
  }
  const std::string_view label = row_of(key.kind).label;
  if (key.kind == CycleKind::sync) return node.empty() ? std::string{label} : fmt::format("{} of {}", label, node);
  return is_pdo(key.kind) ? fmt::format("{} {} {}", node, label, key.place) : fmt::format("{} {}", node, label);
}

std::string ms(double us) { return fmt::format("{:.3f}", us / 1000); }

/// Smallest, mean, largest, jitter and deviation; empty without a time.
std::vector<std::string> cells_of(const Spread& spread) {
  if (spread.count() == 0) return std::vector<std::string>(5);
  return {ms(static_cast<double>(spread.min())), ms(spread.mean()), ms(static_cast<double>(spread.max())),
          ms(static_cast<double>(spread.jitter())), ms(spread.deviation())};
}

constexpr std::string_view columns[] = {
    "cycle times in ms", "CAN-ID", "frames", "nominal", "stated by", "min", "mean", "max", "jitter", "std dev"};

std::vector<std::vector<std::string>> table_of(const CycleTimes& times, const NodeLabels& labels) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [key, cycle] : times.cycles()) {
    std::vector<std::string> row = {subject_of(key, cycle, labels), can_id_text(cycle), std::to_string(cycle.frames),
                                    key.period_us ? ms(static_cast<double>(*key.period_us)) : std::string{},
                                    cycle.index != 0 ? entry_label(cycle.index, cycle.sub_index) : std::string{}};
    for (std::string& cell : cells_of(cycle.distance)) row.push_back(std::move(cell));
    rows.push_back(std::move(row));
    if (cycle.after_sync.count() == 0) continue;
    row = {"    after SYNC", "", std::to_string(cycle.after_sync.count()), "", ""};
    for (std::string& cell : cells_of(cycle.after_sync)) row.push_back(std::move(cell));
    rows.push_back(std::move(row));
  }
  return rows;
}

json spread_object(const Spread& spread) {
  if (spread.count() == 0) return nullptr;
  return {{"count", spread.count()}, {"min_us", spread.min()},       {"mean_us", spread.mean()},
          {"max_us", spread.max()},  {"jitter_us", spread.jitter()}, {"deviation_us", spread.deviation()}};
}

}  // namespace

std::string cycles_text(const CycleTimes& times, const NodeLabels& labels) {
  TextTable table{1};
  table.add({std::begin(columns), std::end(columns)});
  for (std::vector<std::string>& row : table_of(times, labels)) table.add(std::move(row));
  std::string text;
  for (const std::string& line : table.lines()) text += line + '\n';
  return text;
}

json cycles_json(const CycleTimes& times, const NodeLabels& labels) {
  json cycles = json::array();
  const auto or_null = [](bool has, auto value) { return has ? json(value) : json(nullptr); };
  for (const auto& [key, cycle] : times.cycles()) {
    const std::uint8_t node_id = node_of(key, cycle);
    cycles.push_back({{"kind", row_of(key.kind).name},
                      {"node_id", or_null(node_id != 0, unsigned{node_id})},
                      {"number", or_null(is_pdo(key.kind), key.place)},
                      {"can_id", cycle.cob_id & 0x1FFF'FFFF},
                      {"subject", printable(subject_of(key, cycle, labels))},
                      {"frames", cycle.frames},
                      {"nominal_us", or_null(key.period_us.has_value(), key.period_us.value_or(0))},
                      {"index", or_null(cycle.index != 0, entry_label(cycle.index, cycle.sub_index))},
                      {"distance", spread_object(cycle.distance)},
                      {"after_sync", spread_object(cycle.after_sync)}});
  }
  return cycles;
}

json cycles_rows(const CycleTimes& times, const NodeLabels& labels) {
  json rows = json::array();
  for (const std::vector<std::string>& row : table_of(times, labels)) {
    json cells = json::object();
    constexpr const char* names[] = {"subject", "can_id", "frames", "nominal", "stated_by",
                                     "min",     "mean",   "max",    "jitter",  "deviation"};
    for (std::size_t i = 0; i < row.size(); ++i) cells[names[i]] = row[i];
    rows.push_back(std::move(cells));
  }
  return rows;
}

}  // namespace edsc::audit
