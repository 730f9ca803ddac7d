#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "change/new_sheet.hpp"
#include "change/open_sheet.hpp"
#include "commands/commands.hpp"
#include "commands/new_project.hpp"
#include "device/bit_rates.hpp"
#include "lookup/find_entry.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "shared/parse_number.hpp"
#include "system/path.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc new pump.eds --vendor-name "Acme" --vendor 0x1234 --product-name "Pump"
  edsc new drive.eds --vendor-name "Acme" --vendor 0x1234 --product-name "D1" --product 1 --revision 0x10000 \
           --cia 402 --modes pp,csp --bit-rates 125,500,1000 --heartbeat 100ms \
           --tpdo-objects 6041h,6064h --rpdo-objects 6040h,607Ah
  edsc new io.eds --vendor-name "Acme" --cia 401 --git
  edsc new pump.eds --vendor-name "Acme" --project          also CMake, application, programs for Linux and a board)";

struct Settings {
  std::string path;
  NewSheet sheet;
  std::optional<std::uint32_t> vendor, product, revision;
  std::string profile, modes, bit_rates;
  std::vector<std::string> tpdos, rpdos;
  std::optional<std::uint64_t> heartbeat_us;
  bool git = false;
  bool project = false;
};

constexpr std::string_view usual_bit_rates = "10,20,50,125,250,500,800,1000";

std::vector<std::string> split_list(std::string_view text) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    parts.emplace_back(text.substr(0, comma));
    text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
  }
  return parts;
}

std::vector<std::vector<std::uint16_t>> pdo_objects(const char* option, const std::vector<std::string>& lists) {
  std::vector<std::vector<std::uint16_t>> pdos;
  for (const std::string& list : lists) {
    std::vector<std::uint16_t>& objects = pdos.emplace_back();
    for (const std::string& word : split_list(list)) {
      const auto address = parse_entry_address(word);
      if (!address || address->sub_index) throw_invalid(option, word + " is not an index");
      objects.push_back(address->index);
    }
  }
  return pdos;
}

NewSheet sheet_of(const Settings& settings) {
  NewSheet sheet = settings.sheet;
  sheet.file_name = from_native(to_native(settings.path).filename());
  sheet.vendor = settings.vendor.value_or(0);
  sheet.product = settings.product.value_or(0);
  sheet.revision = settings.revision.value_or(0);
  if (sheet.product_name.empty()) sheet.product_name = from_native(to_native(settings.path).stem());
  if (settings.profile != "none") sheet.profile = static_cast<std::uint16_t>(*parse_number(settings.profile));
  if (!settings.modes.empty() && sheet.profile != 402) throw_requires("--modes", "--cia 402");
  for (const std::string& name : split_list(sheet.profile == 402 && settings.modes.empty() ? "pp" : settings.modes)) {
    const auto row = std::ranges::find(drive_mode_rows(), name, &DriveModeRow::name);
    if (row == drive_mode_rows().end()) throw_invalid("--modes", name + " is not pp, vl, pv, tq, hm, csp, csv or cst");
    sheet.modes.push_back(&*row);
  }
  for (const std::string& text : split_list(settings.bit_rates)) {
    const auto rate = parse_number(text, UINT16_MAX);
    if (!rate || !is_bit_rate(*rate)) throw_invalid("--bit-rates", text + " is not a bit rate of CiA 301");
    sheet.bit_rates.push_back(static_cast<std::uint16_t>(*rate));
  }
  if (settings.heartbeat_us) {
    if (*settings.heartbeat_us % 1000 != 0) throw_invalid("--heartbeat", "expected a multiple of 1 ms");
    sheet.heartbeat_ms = static_cast<std::uint16_t>(*settings.heartbeat_us / 1000);
  }
  sheet.tpdos = pdo_objects("--tpdo-objects", settings.tpdos);
  sheet.rpdos = pdo_objects("--rpdo-objects", settings.rpdos);
  const std::tm now = fmt::localtime(std::time(nullptr));
  sheet.date = fmt::format("{:%m-%d-%Y}", now);
  sheet.time = fmt::format("{:%I:%M%p}", now);
  return sheet;
}

/// How to build a project; with the path of its folder, if it is not the working folder.
std::string project_commands(const std::filesystem::path& folder) {
  const std::string change_folder = folder.empty() ? "" : fmt::format("  cd {}\n", printable(from_native(folder)));
  return "to build the project, test it, and make its firmware:\n" + change_folder +
         "  cmake --workflow --preset host\n"
         "  cmake --workflow --preset firmware\n";
}

constexpr std::string_view git_attributes = "*.eds merge=edsc diff=eds\n*.dcf merge=edsc diff=eds\n";
constexpr std::string_view git_commands =
    "for git, once in each clone:\n"
    "  git config merge.edsc.driver \"edsc merge %O %A %B %P\"\n"
    "  git config diff.eds.xfuncname \"^\\[.*\\]\"\n";

void refuse_existing(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::exists(std::filesystem::symlink_status(path, error))) {
    fail(fmt::format("{}: the file exists, and is not overwritten", from_native(path)));
  }
}

int make_new(const Settings& settings) {
  const NewSheet sheet = sheet_of(settings);
  const std::filesystem::path path = to_native(settings.path);
  const std::filesystem::path attributes = path.parent_path() / ".gitattributes";
  if (settings.project) {
    if (std::string fault = project_name_fault(settings.path); !fault.empty()) throw_invalid("--project", fault);
  }
  refuse_existing(path);
  if (settings.git) refuse_existing(attributes);
  std::string problem;
  std::string text = new_sheet_text(sheet, problem);
  if (!problem.empty()) fail(fmt::format("{}: {}", settings.path, problem), exit_input_has_errors);
  const auto open = open_sheet(settings.path, text, {}, SheetChecks::all);
  if (open->diagnostics.errors() > 0) {
    print_findings(open->diagnostics, {});
    return exit_input_has_errors;
  }
  std::vector<OutputFile> files{{settings.path, std::move(text)}};
  if (settings.project) {
    for (OutputFile& file : project_files(settings.path, sheet, *open)) {
      refuse_existing(to_native(file.path));
      files.push_back(std::move(file));
    }
  }
  if (settings.git) files.push_back({from_native(attributes), std::string{git_attributes}});
  write_all_files(files);
  for (const OutputFile& file : files) print_visibly(stdout, "{}\n", file.path);
  if (settings.git) write_output(git_commands);
  if (settings.project) write_output(project_commands(path.parent_path()));
  return exit_fine;
}

}  // namespace

void add_new_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, make_new, exit_code);
  settings.profile = "none";
  settings.bit_rates = usual_bit_rates;
  command.add_option("FILE", settings.path, "EDS to write; it must not exist")
      .required()
      .check([](const std::string& path) {
        return path.ends_with(".eds") ? std::string{} : path + " does not end with .eds";
      });
  command.add_option("--vendor-name", settings.sheet.vendor_name).required();
  command.add_option("--vendor", settings.vendor, "default: 0");
  command.add_option("--product-name", settings.sheet.product_name);
  command.add_option("--product", settings.product, "default: 0");
  command.add_option("--revision", settings.revision, "default: 0");
  add_choice(command, "--cia", settings.profile, {"none", "401", "402", "404", "406"});
  command.add_option("--modes", settings.modes);
  command.add_option("--bit-rates", settings.bit_rates).show_default();
  command.add_option("--tpdo-objects", settings.tpdos).one_value_each();
  command.add_option("--rpdo-objects", settings.rpdos).one_value_each();
  command.add_duration("--heartbeat", 0, 65'535'000, [&settings](std::uint64_t us) { settings.heartbeat_us = us; });
  command.add_flag("--with-storage", settings.sheet.stores);
  command.add_flag("--with-lss", settings.sheet.has_lss);
  command.add_flag("--git", settings.git);
  command.add_flag("--project", settings.project);
}

}  // namespace edsc
