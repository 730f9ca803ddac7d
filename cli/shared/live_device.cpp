#include "shared/live_device.hpp"

#include <fmt/format.h>

#include <string>

#include "lookup/find_entry.hpp"
#include "online/identity.hpp"
#include "shared/common_options.hpp"
#include "shared/exit_code.hpp"
#include "system/read_file.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

LiveEntry by_address(const std::string& text, const std::string& without_sheet) {
  const auto address = parse_entry_address(text);
  if (!address && !without_sheet.empty()) {
    fail(
        fmt::format("\"{}\" is not an address such as 1018h:01; the network file states no EDS of node {}, whose "
                    "objects have no names then (--eds)",
                    text, without_sheet));
  }
  if (!address) fail(fmt::format("\"{}\" is not an address such as 1018h:01; names require an EDS (--eds)", text));
  return live_entry(nullptr, address->index, address->sub_index.value_or(0));
}

/// The numbers of the identity that the file or the node does not state.
std::string not_compared_text(const std::string& path, const std::vector<NotCompared>& numbers) {
  std::vector<NotCompared> in_sheet, elsewhere;
  for (const NotCompared& number : numbers) (number.in_sheet ? in_sheet : elsewhere).push_back(number);
  std::string text;
  if (!elsewhere.empty()) text = fmt::format("{} (not in {})", names_of(elsewhere), path);
  if (!in_sheet.empty()) text += fmt::format("{}{} (not in the node)", text.empty() ? "" : ", ", names_of(in_sheet));
  return text;
}

}  // namespace

std::unique_ptr<LoadedDevice> load_live_device(const std::string& path, std::uint8_t node) {
  Diagnostics diagnostics;
  diagnostics.limit_notes(Notes::none);
  LoadSettings settings;
  settings.path = path;
  settings.node_id = node;
  settings.check = false;
  auto loaded = load_device(settings, diagnostics);
  if (loaded->device) {
    if (diagnostics.errors() > 0) {
      print_to_stderr("edsc: {}: {}; invalid objects are skipped (\"edsc check --keep-going\" lists them)\n",
                      printable(path), counted(diagnostics.errors(), "error"));
    }
    return loaded;
  }
  print_findings(diagnostics, ColorOption{});
  throw Exit{};
}

std::vector<LiveEntry> name_entries(const LoadedDevice* loaded, const std::string& text,
                                    const std::string& without_sheet) {
  if (loaded == nullptr) return {by_address(text, without_sheet)};
  const FoundEntry found = find_entry(loaded->named(), text);
  if (!found.ok()) fail(found.problem);
  if (found.entry != nullptr) return {live_entry(*loaded->device, *found.object, *found.entry)};
  std::vector<LiveEntry> entries;
  for (const Entry& entry : found.object->entries) {
    if (canopen::readable(entry.access)) entries.push_back(live_entry(*loaded->device, *found.object, entry));
  }
  if (entries.empty()) {
    fail(fmt::format("{} \"{}\" has no entry that can be read", index_label(found.object->index), found.object->name));
  }
  return entries;
}

LiveEntry name_entry(const LoadedDevice* loaded, const std::string& text, const std::string& without_sheet) {
  if (loaded == nullptr) return by_address(text, without_sheet);
  const FoundEntry found = find_one_entry(loaded->named(), text);
  if (!found.ok()) fail(found.problem);
  return live_entry(*loaded->device, *found.object, *found.entry);
}

void check_node(SdoAccess& node, const Device& device, const std::string& path, std::string_view hint) {
  const auto [found, unanswered] = read_identity(node);
  if (unanswered != nullptr) {
    fail(fmt::format("node {}: {} {}: no answer; {}", node.node().value(),
                     entry_label(unanswered->index, unanswered->sub_index), unanswered->name, hint),
         exit_device_failed);
  }
  const Identity expected = identity_of(device);
  const IdentityMatch match = compare_identity(expected, found);
  if (match == IdentityMatch::major_revision || match == IdentityMatch::other) {
    fail(fmt::format("node {} is not the device of {}: {}; \"edsc scan BUS --eds FILE\" finds the node of a file; {}",
                     node.node().value(), path, identity_differences(expected, found), hint),
         exit_device_failed);
  }
  report_not_compared(node, not_compared_text(path, not_compared(expected, found)));
}

void report_not_compared(const SdoAccess& node, const std::string& what) {
  if (what.empty()) return;
  print_to_stderr("edsc: node {}: not compared: {}\n", node.node().value(), what);
}

void report_broken_block(const LiveEntry& entry, const SdoOutcome& outcome) {
  if (outcome.block_failure.empty()) return;
  print_to_stderr("edsc: {}: the block transfer failed: {}; trying a segmented transfer\n", title(entry),
                  outcome.block_failure);
}

bool report_live_scales(LiveScales& scales) {
  for (const std::string& one : scales.take_differences()) {
    print_to_stderr("edsc: {}; units are as in the device\n", one);
  }
  const std::string failure = scales.take_failure();
  if (!failure.empty()) print_to_stderr("edsc: {}; values in its unit are raw numbers\n", failure);
  return failure.empty();
}

bool read_bytes(const std::string& path, std::vector<std::uint8_t>& bytes, std::string& problem) {
  std::string content;
  problem = read_file(path, content);
  if (!problem.empty()) {
    problem = fmt::format("{}: {}", path, problem);
    return false;
  }
  bytes.assign(content.begin(), content.end());
  return true;
}

}  // namespace edsc
