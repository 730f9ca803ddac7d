#include <fmt/format.h>

#include <algorithm>

#include "commands/commands.hpp"
#include "device/resolve.hpp"
#include "format/canonical_form.hpp"
#include "format/concise_dcf.hpp"
#include "format/make_dcf.hpp"
#include "render/write_files.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc format drive.eds                                    the canonical form, on standard output
  edsc format drive.eds -o drive.eds                       in place
  edsc format drive.eds --check                            exit code 1 when the file is not canonical
  edsc format drive.eds --dcf --node-id 5 -o axis1.dcf     the DCF of node 5
  edsc format drive.eds --dcf --node-id 5 --all            the same with a ParameterValue for each writable entry
  edsc format axis1.dcf --concise -o axis1.bin             what a master downloads to it (object 1F22h))";

struct Settings {
  std::string path;
  std::string output;
  std::optional<std::uint8_t> node_id;
  bool check = false;
  bool dcf = false;
  bool all = false;
  bool concise = false;
  ColorOption color;
};

/// What these rules say is left out, stays in the text.
constexpr std::string_view rules_of_what_stays[] = {"unknown-key", "unknown-section"};

/// A data sheet with its lines. Values are not judged here: that is `edsc check`.
struct Input {
  std::unique_ptr<SourceFile> source;
  IniFile ini;
  DataSheet sheet;
  Device device;
};

void read(const Settings& settings, Input& input, Diagnostics& diagnostics) {
  for (const std::string_view rule : rules_of_what_stays) diagnostics.silence(std::string{rule});
  input.ini = parse_ini(*input.source, diagnostics);
  if (input.ini.sections.empty()) return;
  input.sheet = read_data_sheet(input.ini, diagnostics);
  Diagnostics ignored;
  input.device = resolve_device(input.sheet, {}, {"", settings.node_id}, ignored);
}

std::string canonical_text(const Settings& settings, const Input& input) {
  Document document = canonical_form(input.ini, input.sheet, input.device);
  if (settings.dcf) {
    make_dcf(document, input.sheet, input.device, settings.all ? DcfValues::all : DcfValues::different);
  }
  return to_text(document);
}

int check(const SourceFile& source, const std::string& text) {
  if (source.is_verbatim() && source.text() == text) return exit_fine;
  const auto [in_file, in_text] = std::ranges::mismatch(source.text(), text);
  const auto line = std::count(source.text().begin(), in_file, '\n') + 1;
  fmt::print(stderr, "{}:{}: the canonical form differs from here on\n", source.name(), line);
  return exit_input_has_errors;
}

int write(const std::string& path, std::string content) {
  if (path.empty()) {
    const bool written =
        std::fwrite(content.data(), 1, content.size(), stdout) == content.size() && std::fflush(stdout) == 0;
    if (!written) fmt::print(stderr, "edsc: standard output cannot be written\n");
    return written ? exit_fine : exit_wrong_usage;
  }
  if (const std::string problem = write_files({{path, std::move(content)}}); !problem.empty()) {
    fmt::print(stderr, "edsc: {}\n", problem);
    return exit_wrong_usage;
  }
  return exit_fine;
}

int format(const Settings& settings) {
  Input input;
  std::string error;
  input.source = read_source_file(settings.path, error);
  if (!input.source) {
    fmt::print(stderr, "edsc: {}\n", error);
    return exit_wrong_usage;
  }
  Diagnostics diagnostics;
  read(settings, input, diagnostics);
  std::string content;
  if (diagnostics.errors() == 0) {
    content = settings.concise ? concise_dcf(input.sheet, input.device, diagnostics) : canonical_text(settings, input);
  }
  print_findings(stderr, diagnostics, settings.color);
  if (diagnostics.errors() > 0) return exit_input_has_errors;
  return settings.check ? check(*input.source, content) : write(settings.output, std::move(content));
}

}  // namespace

void add_format_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("format", "the canonical form of an EDS or DCF, comments kept");
  command->footer(examples);
  auto settings = std::make_shared<Settings>();
  command->add_option("FILE", settings->path, "EDS or DCF; - is standard input")->required();
  auto* output =
      command->add_option("-o,--output", settings->output, "file to write; may be FILE (default: standard output)");
  auto* check = command->add_flag("--check", settings->check, "write nothing; exit code 1 when FILE is not canonical");
  auto* dcf = command->add_flag("--dcf", settings->dcf,
                                "make a DCF: [DeviceComissioning], and the ParameterValues that differ from defaults");
  auto* all = command->add_flag("--all", settings->all, "with --dcf: a ParameterValue for each writable entry");
  auto* concise = command->add_flag("--concise", settings->concise,
                                    "write the concise DCF: what differs from the defaults, as object 1F22h holds it");
  add_node_id_option(*command, settings->node_id);
  settings->color.add_to(*command);
  check->excludes(output)->excludes(dcf)->excludes(concise);
  dcf->excludes(concise)->needs("--node-id");
  all->needs(dcf);
  command->callback([settings, &exit_code] {
    if (settings->node_id && !settings->dcf && !settings->concise) {
      throw CLI::RequiresError("--node-id", "--dcf or --concise");
    }
    exit_code = format(*settings);
  });
}

}  // namespace edsc
