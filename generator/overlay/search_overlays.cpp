#include "overlay/search_overlays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "change/sheet_text.hpp"
#include "eds/number.hpp"
#include "overlay/compose_overlay.hpp"
#include "overlay/overlay_file.hpp"
#include "system/environment.hpp"
#include "system/find_files.hpp"

namespace edsc {
namespace {

struct SheetIdentity {
  std::optional<std::uint64_t> vendor, product, revision;
};

/// A number of [DeviceInfo]; if it is missing, the default value of 1018h.
std::optional<std::uint64_t> read_identity(const SheetText& text, std::string_view key, std::string_view sub_object) {
  const auto number = [&](std::string_view section, std::string_view name) -> std::optional<std::uint64_t> {
    const TextSection* const found = text.find(section);
    const auto entry = found != nullptr ? text.find_entry(*found, name) : std::nullopt;
    return entry ? parse_unsigned(strip_inline_comment(entry->value)) : std::nullopt;
  };
  const auto of_label = number("DeviceInfo", key);
  return of_label ? of_label : number(sub_object, "DefaultValue");
}

SheetIdentity identity_of_sheet(const SourceFile& source) {
  const SheetText text{source};
  return {read_identity(text, "VendorNumber", "1018sub1"), read_identity(text, "ProductNumber", "1018sub2"),
          read_identity(text, "RevisionNumber", "1018sub3")};
}

/// How well an overlay fits a device: 0 not, 1 the product, 2 also the revision.
unsigned fit_of(const OverlayHeader& header, const SheetIdentity& device) {
  const auto vendor = number_of(header.vendor_number);
  const auto product = number_of(header.product_number);
  if (header.base.present || !vendor || !product || vendor != device.vendor || product != device.product) return 0;
  if (!header.revision_number.present) return 1;
  return number_of(header.revision_number) == device.revision ? 2 : 0;
}

}  // namespace

std::vector<std::string> overlay_folders() {
  constexpr char separator = std::filesystem::path::preferred_separator == '/' ? ':' : ';';
  const std::string variable = environment_variable("EDSC_OVERLAYS").value_or("");
  std::vector<std::string> folders;
  std::string_view rest = variable;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(separator), rest.size());
    if (end > 0) folders.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return folders;
}

std::shared_ptr<const SourceFile> find_overlay(const std::vector<std::string>& folders,
                                               const std::shared_ptr<const SourceFile>& file,
                                               Diagnostics& diagnostics) {
  std::shared_ptr<const SourceFile> best;
  if (folders.empty()) return best;
  const SheetIdentity device = identity_of_sheet(*text_of_base(file));
  unsigned best_fit = 0;
  std::shared_ptr<const SourceFile> equal;
  for (const std::string& folder : folders) {
    FoundFiles found = find_files(folder, std::array{std::string_view{".overlay"}}, Subfolders::left_out);
    for (const std::string& path : found.paths) {
      std::string problem;
      std::shared_ptr<const SourceFile> overlay = read_source_file(path, problem);
      if (!overlay) {
        found.problems.push_back(std::move(problem));
        continue;
      }
      Diagnostics ignored;  // reported when the overlay is applied
      const unsigned fit = fit_of(read_overlay(*overlay, ignored).header, device);
      if (fit == 0 || fit < best_fit) continue;
      equal = fit == best_fit ? overlay : nullptr;
      if (fit > best_fit) best = std::move(overlay);
      best_fit = fit;
    }
    for (const std::string& problem : found.problems) {
      diagnostics.error("overlay-base", {file.get()}, "EDSC_OVERLAYS: " + problem);
    }
  }
  if (equal) {
    diagnostics.error(
        "overlay-base", {file.get()},
        fmt::format("two overlays of EDSC_OVERLAYS fit this file: {} and {}", best->name(), equal->name()));
  }
  return best;
}

}  // namespace edsc
