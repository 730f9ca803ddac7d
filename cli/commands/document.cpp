#include "document/document.hpp"
#include "eds/ini.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "commands/commands.hpp"
#include "compare/compare_devices.hpp"
#include "network/checks/check_network.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/git_device.hpp"
#include "shared/output.hpp"
#include "system/path.hpp"
#include "system/read_file.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc document drive.eds -o drive.html                       a page that needs no other file: objects, PDOs, findings
  edsc document drive.eds -o drive.md                         the same as Markdown, for a repository
  edsc document drive.eds --against drive-1.0.eds -o drive.html    with what changed and what it breaks
  edsc document drive.eds --against git:HEAD~1 -o drive.html  against the version of a git revision
  edsc document axis1.dcf -o axis1.html                       with the values that differ from the default
  edsc document plant.json -o plant.html                      a network: topology, SYNC cycle, load, response times
  edsc document plant.json --node-pages -o plant.html         with a page for each node: plant-NODE.html
  edsc document drive.eds --title "Drive of axis 1" --author "A. Mason" --logo logo.svg --without-findings -o drive.html    for a customer)";

struct Settings {
  LoadSettings load;
  std::string output;
  std::string format;
  std::string against;
  bool nodes = false;
  bool without_findings = false;
  DocumentHead head;
  std::string logo;
  ColorOption color;
};

DocumentFormat format_of(const Settings& settings) {
  const bool is_markdown = settings.format.empty() ? settings.output.ends_with(".md") : settings.format == "markdown";
  return is_markdown ? DocumentFormat::markdown : DocumentFormat::html;
}

DocumentHead head_of(const Settings& settings) {
  constexpr std::size_t max_logo_bytes = 1'000'000;
  DocumentHead head = settings.head;
  head.has_findings = !settings.without_findings;
  if (settings.logo.empty()) return head;
  std::string contents;
  if (const std::string problem = read_file(settings.logo, contents); !problem.empty()) {
    fail(settings.logo + ": " + problem);
  }
  head.logo = DocumentHead::logo_url(settings.logo, contents);
  if (head.logo.empty()) throw_invalid("--logo", "needs a file *.svg, *.png or *.jpg");
  if (contents.size() > max_logo_bytes) throw_invalid("--logo", "needs a picture of at most 1 MB");
  return head;
}

/// The older version, and the files it was read from. Ends the command if it has errors, which are printed.
std::unique_ptr<LoadedDevice> load_older(const Settings& settings, std::vector<std::string>& inputs) {
  Diagnostics diagnostics;
  diagnostics.limit_notes(Notes::none);
  LoadSettings load = settings.load;
  std::unique_ptr<LoadedDevice> older;
  if (names_git_revision(settings.against)) {
    const std::string revision = settings.against.substr(git_prefix.size());
    GitFile committed = read_git_file(revision, load.path);
    if (!committed.source) fail(committed.error);
    older = load_git_device(std::move(committed), revision, load, diagnostics);
  } else {
    load.path = settings.against;
    load.options_path.clear();
    inputs.push_back(load.path);
    older = load_device(load, diagnostics);
  }
  if (older->device && diagnostics.errors() == 0) return older;
  print_findings(diagnostics, settings.color);
  throw Exit{older->unreadable ? exit_wrong_usage : exit_input_has_errors};
}

std::string name_of_older(const Settings& settings, const LoadedDevice& older) {
  if (names_git_revision(settings.against)) return settings.against;
  return std::string{file_name_of(older.source->name())};
}

int document_device(const Settings& settings) {
  if (settings.nodes) throw_invalid("--node-pages", "is for networks, not for devices");
  Diagnostics diagnostics;
  const auto loaded = load_device(settings.load, diagnostics);
  if (loaded->device) report_unused_allowances(*loaded, diagnostics);
  if (loaded->unreadable || !loaded->device || diagnostics.errors() > 0) {
    print_findings(diagnostics, settings.color);
    if (can_keep_going(*loaded, diagnostics)) {
      print_to_stderr("edsc: nothing was written; --keep-going documents the rest of the device\n");
    }
    return loaded->unreadable ? exit_wrong_usage : exit_input_has_errors;
  }
  std::vector<std::string> inputs = input_files(*loaded);
  std::optional<ComparedWith> compared;
  std::unique_ptr<LoadedDevice> older;
  if (!settings.against.empty()) {
    older = load_older(settings, inputs);
    compared = ComparedWith{name_of_older(settings, *older), compare_devices(older->named(), loaded->named())};
  }
  const DeviceToDocument device{*loaded, &diagnostics, compared ? &*compared : nullptr};
  write_output(settings.output, document_of(device, format_of(settings), head_of(settings)), inputs);
  return exit_fine;
}

int document_network(const Settings& settings) {
  if (!settings.against.empty()) throw_invalid("--against", "is for devices, not for networks");
  if (settings.load.node_id) throw_invalid("--node-id", "is for devices, not for networks");
  Diagnostics diagnostics;
  const auto loaded = load_network(settings.load.path, diagnostics);
  check_network(loaded->network, diagnostics);
  if (loaded->unreadable || diagnostics.errors() > 0) {
    print_findings(diagnostics, settings.color);
    return loaded->unreadable ? exit_wrong_usage : exit_input_has_errors;
  }
  std::vector<std::string> inputs = {settings.load.path};
  for (const auto& file : loaded->network.files) {
    for (std::string& name : input_files(*file)) inputs.push_back(std::move(name));
  }
  if (settings.nodes) {
    write_all_files(documents_of(loaded->network, diagnostics, format_of(settings), settings.output, head_of(settings)),
                    inputs);
  } else {
    write_output(settings.output, document_of(loaded->network, diagnostics, format_of(settings), head_of(settings)),
                 inputs);
  }
  return exit_fine;
}

int document(const Settings& settings) {
  if (ends_with_ignoring_case(settings.output, ".pdf")) {
    throw_invalid("--output",
                  "is HTML or Markdown; a browser prints HTML as PDF, such as chromium --headless "
                  "--print-to-pdf=FILE.pdf FILE.html");
  }
  const bool is_network = settings.load.path.ends_with(".json");
  return is_network ? document_network(settings) : document_device(settings);
}

}  // namespace

void add_document_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, document, exit_code);
  command.add_option("FILE", settings.load.path, "EDS, DCF, XDD, XDC, or network file (*.json)").required();
  const Option output = command.add_option("--output", settings.output, "default: standard output");
  command.add_option("--format", settings.format, "default: by the name of the output, else html")
      .one_of({"html", "markdown"});
  command.add_option("--against", settings.against);
  command.add_flag("--node-pages", settings.nodes).needs(output);
  command.add_option("--title", settings.head.title, "default: the name of the device or of the network file");
  command.add_option("--author", settings.head.author);
  command.add_option("--date", settings.head.date);
  command.add_option("--logo", settings.logo);
  command.add_flag("--without-findings", settings.without_findings);
  add_node_id_option(command, settings.load.node_id);
  add_options_option(command, settings.load.options_path);
  command.add_flag("--keep-going", settings.load.keep_going);
  settings.color.add_to(command);
}

}  // namespace edsc
