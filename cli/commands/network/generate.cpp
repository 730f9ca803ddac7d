#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "commands/commands.hpp"
#include "document/network_drawings.hpp"
#include "network/checks/check_network.hpp"
#include "network/generate/generate_network.hpp"
#include "network/network.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/generated_files.hpp"
#include "system/depfile.hpp"
#include "system/path.hpp"
#include "text/printable.hpp"

namespace edsc {

namespace {

struct Settings {
  std::string path;
  std::string output;
  std::string target = "cpp";
  std::string depfile;
  std::string depfile_target;
  bool verbose = false;
  ReplaceSettings replace;
  ColorOption color;
};

int generate(const Settings& settings) {
  Diagnostics diagnostics;
  diagnostics.limit_notes(Notes::of_names);
  const auto loaded = load_network(settings.path, diagnostics);
  check_network(loaded->network, diagnostics);
  GeneratedNetwork generated;
  if (diagnostics.errors() == 0) {
    const MasterProgram program = settings.target == "lely" ? MasterProgram::lely : MasterProgram::edsc;
    generated = generate_network(loaded->network, diagnostics, program);
  }
  print_findings(diagnostics, settings.color);
  if (loaded->unreadable) return exit_wrong_usage;
  if (diagnostics.errors() > 0) return exit_input_has_errors;
  for (const std::string& note : generated.notes) print_to_stderr("edsc: {}\n", note);
  std::vector<OutputFile>& files = generated.files;
  std::ranges::move(network_drawings(loaded->network), std::back_inserter(files));
  std::vector<OutputFile> placed = files;
  for (OutputFile& file : placed) file.path = join_path(settings.output, file.path);
  std::vector<OutputFile> others;
  if (!settings.depfile.empty()) {
    others.push_back({settings.depfile, depfile_text(settings.depfile_target, placed, generated.inputs)});
    placed.push_back(others.back());
  }
  const int exit_code =
      write_generated_files(settings.output, std::move(files), std::move(others), generated.inputs, settings.replace);
  if (settings.verbose && !settings.replace.check) {
    for (const OutputFile& file : placed) print_visibly(stdout, "{}\n", file.path);
  }
  return exit_code;
}

}  // namespace

void add_network_generate_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, "", generate, exit_code);
  command.add_option("FILE", settings.path, "network file (JSON)").required();
  command.add_option("--output", settings.output, "folder").required();
  add_choice(command, "--target", settings.target, {"cpp", "lely"},
             "lely: also bus.yml for dcfgen and ros2_canopen, and a DCF of the master for Lely's loader")
      .show_default();
  const Option depfile = command.add_option("--depfile", settings.depfile);
  command.add_option("--depfile-target", settings.depfile_target).needs(depfile);
  command.add_flag("--verbose", settings.verbose);
  add_replace_options(command, settings.replace, true);
  settings.color.add_to(command);
}

}  // namespace edsc
