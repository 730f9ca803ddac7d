#include "shared/live_device.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "online/identity.hpp"
#include "shared/common_options.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"
#include "values/find_entry.hpp"

namespace edsc {
namespace {

NamedEntries by_address(const std::string& text) {
  const auto address = parse_entry_address(text);
  if (!address) {
    return {{}, fmt::format("\"{}\" is not an address such as 1018h:01; names require an EDS (--eds)", text)};
  }
  LiveEntry entry;
  entry.index = address->index;
  entry.sub_index = address->sub_index.value_or(0);
  return {{entry}, ""};
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
  diagnostics.drop_notes();
  LoadSettings settings;
  settings.path = path;
  settings.node_id = node;
  settings.check = false;
  auto loaded = load_device(settings, diagnostics);
  if (loaded->device) {
    if (diagnostics.errors() > 0) {
      print_visibly(stderr, "edsc: {}: {}; what is wrong is left out (\"edsc check --keep-going\" lists it)\n",
                    printable(path), counted(diagnostics.errors(), "error"));
    }
    return loaded;
  }
  print_findings(stderr, diagnostics, ColorOption{});
  return nullptr;
}

NamedEntries name_entries(const Device* device, const std::string& text) {
  if (device == nullptr) return by_address(text);
  const FoundEntry found = find_entry(*device, text);
  if (!found.ok()) return {{}, found.problem};
  if (found.entry != nullptr) return {{live_entry(*found.object, *found.entry)}, ""};
  NamedEntries named;
  for (const Entry& entry : found.object->entries) {
    if (canopen::readable(entry.access)) named.entries.push_back(live_entry(*found.object, entry));
  }
  if (named.entries.empty()) {
    named.problem =
        fmt::format("{} \"{}\" has no entry that can be read", index_label(found.object->index), found.object->name);
  }
  return named;
}

NamedEntries name_entry(const Device* device, const std::string& text) {
  if (device == nullptr) return by_address(text);
  const FoundEntry found = find_one_entry(*device, text);
  if (!found.ok()) return {{}, found.problem};
  return {{live_entry(*found.object, *found.entry)}, ""};
}

NodeCheck check_node(SdoAccess& node, const Device& device, const std::string& path) {
  const Identity found = read_identity(node), expected = identity_of(device);
  NodeCheck check;
  check.not_compared = not_compared_text(path, not_compared(expected, found));
  const IdentityMatch match = compare_identity(expected, found);
  if (match == IdentityMatch::same || match == IdentityMatch::minor_revision || match == IdentityMatch::unknown)
    return check;
  check.problem =
      fmt::format("node {} is not the device of {}: {}; \"edsc scan BUS --eds FILE\" finds the node of a file",
                  node.node().value(), path, identity_differences(expected, found));
  return check;
}

void report_broken_block(const LiveEntry& entry, const SdoOutcome& outcome) {
  if (outcome.block_failure.empty()) return;
  print_visibly(stderr, "edsc: {}: the block transfer failed: {}; trying a segmented transfer\n", title(entry),
                outcome.block_failure);
}

bool read_bytes(const std::string& path, std::vector<std::uint8_t>& bytes, std::string& problem) {
  errno = 0;
  try {
    std::ifstream file{path, std::ios::binary};
    if (file) bytes.assign(std::istreambuf_iterator<char>{file}, {});
    if (file && !file.bad()) return true;
  } catch (const std::ios_base::failure&) {  // of a folder, which opens like a file
  }
  problem = fmt::format("{}: {}", path, errno != 0 ? std::strerror(errno) : "cannot be read");
  return false;
}

}  // namespace edsc
