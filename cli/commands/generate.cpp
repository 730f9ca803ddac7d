#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "backend/cpp/identifier.hpp"
#include "backend/dbc/dbc.hpp"
#include "backend/render.hpp"
#include "backend/target.hpp"
#include "commands/commands.hpp"
#include "load/load_device.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/generated_files.hpp"
#include "shared/left_out_text.hpp"
#include "shared/output.hpp"
#include "system/depfile.hpp"
#include "system/path.hpp"
#include "system/write_files.hpp"
#include "text/printable.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  edsc generate eds/drive.eds -o build/generated           headers for namespace drive
  edsc generate drive.eds -o out --name axis1 --node-id 5  a second one, with its node-ID fixed
  edsc generate vendor.eds -o out --keep-going             skip invalid objects of a purchased device's EDS
  edsc generate drive.eds --node-id 5 --dbc drive.dbc      the PDOs of node 5 for CAN tools, without headers
  edsc generate drive.eds -o out --target c                out/drive/objects.h for programs in C)";

struct Settings {
  LoadSettings load;
  std::string output;
  std::string dbc;
  std::string depfile;
  std::string depfile_target;
  std::string target{targets().front().name};
  std::string templates;
  bool verbose = false;
  ReplaceSettings replace;
  ColorOption color;
};

/// The text of a template, and its file unless it is built in.
struct ChosenTemplate {
  Template built_in;
  std::unique_ptr<SourceFile> replacement;

  /// Throws std::runtime_error with the name of the invalid file.
  [[nodiscard]] std::string rendered(const nlohmann::ordered_json& view) const {
    if (!replacement) return render(built_in.text, view);
    try {
      return render(replacement->text(), view);
    } catch (const std::runtime_error& problem) {
      throw std::runtime_error{replacement->name() + ": " + problem.what()};
    }
  }
};

/// What `--target` can be, with its meaning.
std::string target_help() {
  std::string text;
  const char* separator = "";
  for (const Target& target : targets()) {
    text += fmt::format("{}{} ({})", std::exchange(separator, ", "), target.name, target.summary);
  }
  return text;
}

std::vector<std::string> target_names() {
  std::vector<std::string> names;
  for (const Target& target : targets()) names.emplace_back(target.name);
  return names;
}

/// A file that replaces nothing has a misspelled name. Hidden files, such as those of git and of editors, are no
/// templates.
void check_template_names(const std::string& folder, const std::vector<Template>& templates) {
  std::vector<std::string> known;
  known.reserve(templates.size());
  for (const Template& built_in : templates) known.push_back(std::string{built_in.file_name} + ".mustache");
  for (const fs::directory_entry& file : fs::directory_iterator{to_native(folder)}) {
    const std::string name = from_native(file.path().filename());
    if (name.starts_with('.') || !file.is_regular_file() || std::ranges::find(known, name) != known.end()) continue;
    throw std::runtime_error{fmt::format("{}: there is no built-in template with this name{}", join_path(folder, name),
                                         did_you_mean(name, known))};
  }
}

/// The built-in templates, each replaced by the file of the same name in `folder`, if it exists.
std::vector<ChosenTemplate> choose_templates(const std::string& folder, const std::vector<Template>& templates) {
  if (!folder.empty()) check_template_names(folder, templates);
  std::vector<ChosenTemplate> chosen;
  for (const Template& built_in : templates) {
    ChosenTemplate one{built_in, nullptr};
    const std::string path = join_path(folder, std::string{built_in.file_name} + ".mustache");
    if (!folder.empty() && fs::exists(to_native(path))) {
      std::string error;
      one.replacement = read_source_file(path, error);
      if (!one.replacement) throw std::runtime_error{path + ": " + error};
    }
    chosen.push_back(std::move(one));
  }
  return chosen;
}

/// Returns the headers and the depfile, and the names of all `inputs`.
/// Releases data sheet and device as soon as the view is complete, since large ones need more memory than their files.
std::vector<OutputFile> render_all(const Settings& settings, LoadedDevice& loaded, Diagnostics& diagnostics,
                                   std::vector<std::string>& inputs) {
  const Target& target = target_of(settings.target);
  const auto templates = choose_templates(settings.templates, templates_of(target));
  loaded.sheet = {};
  const auto view = target.view(loaded.named(), loaded.options, diagnostics);
  const std::string folder = join_path(settings.output, loaded.names->space());
  loaded.device.reset();
  std::vector<OutputFile> files;
  inputs = input_files(loaded);
  for (const ChosenTemplate& one : templates) {
    if (!is_needed(one.built_in, view)) continue;
    files.push_back({join_path(folder, one.built_in.file_name), one.rendered(view)});
    if (one.replacement) inputs.push_back(one.replacement->name());
  }
  if (!settings.depfile.empty())
    files.push_back({settings.depfile, depfile_text(settings.depfile_target, files, inputs)});
  return files;
}

/// The DBC file. Prints which PDOs it does not have.
OutputFile render_dbc(const Settings& settings, const NamedDevice& named) {
  if (!named.device.node_id) throw_requires("--dbc", "--node-id or a DCF, since CAN-IDs depend on the node-ID");
  Dbc dbc = dbc_of(named.device, named.identifiers());
  for (const std::string& note : dbc.notes) print_to_stderr("edsc: not in the DBC file: {}\n", note);
  return {settings.dbc, std::move(dbc.text)};
}

/// A note on the value of an option that the next version does not have.
void print_removed_option(const Settings& settings, const LoadedDevice& loaded) {
  if (loaded.options.typed_values || settings.output.empty() || settings.target != targets().front().name) return;
  print_to_stderr(
      "{}: note: \"typed_values\": false will be removed in the next version; values with a meaning then have "
      "a type of their own\n",
      loaded.options_source->name());
}

/// A hint, if `--keep-going` would make warnings of all errors.
constexpr const char* keep_going_hint =
    "edsc: nothing was generated. For a file that you cannot change, --keep-going (KEEP_GOING in CMake) generates the rest of the "
    "device";

/// Whether each finding is listed with its place.
bool lists_all(const Diagnostics& diagnostics) {
  return diagnostics.omitted().empty() && std::ranges::none_of(diagnostics.all(), [](const Diagnostic& one) {
           return one.places > Diagnostic::max_places || one.follows_from;
         });
}

int generate(const Settings& settings) {
  if (settings.output.empty() && settings.dbc.empty()) throw_required("--output or --dbc");
  if (settings.output.empty() && !settings.depfile.empty()) throw_requires("--depfile", "--output");
  Diagnostics diagnostics;
  diagnostics.limit_notes(Notes::of_names);
  const auto loaded = load_device(settings.load, diagnostics);
  std::vector<OutputFile> files;
  std::vector<std::string> inputs;
  std::vector<LeftOut> left_out;
  const bool is_device = loaded->device.has_value();
  if (is_device) left_out = all_left_out(*loaded);
  const bool has_hint = can_keep_going(*loaded, diagnostics);
  if (is_device && diagnostics.errors() == 0) {
    std::vector<OutputFile> dbc;
    inputs = input_files(*loaded);
    if (!settings.dbc.empty()) dbc.push_back(render_dbc(settings, loaded->named()));
    if (!settings.output.empty()) files = render_all(settings, *loaded, diagnostics, inputs);
    files.insert(files.end(), std::make_move_iterator(dbc.begin()), std::make_move_iterator(dbc.end()));
  }
  print_findings(diagnostics, settings.color);
  if (loaded->unreadable) return exit_wrong_usage;
  if (!is_device || diagnostics.errors() > 0) {
    if (has_hint && files.empty()) print_to_stderr("{}\n", keep_going_hint);
    return exit_input_has_errors;
  }
  if (settings.load.keep_going || diagnostics.any_silenced() || !lists_all(diagnostics)) {
    write_to_stderr(left_out_text(left_out));
  }
  print_removed_option(settings, *loaded);
  // Headers of the user's own templates need not have the mark; a DBC file and a depfile are named by the user.
  if (settings.templates.empty()) {
    std::vector<OutputFile> headers = files;
    std::erase_if(headers,
                  [&](const OutputFile& one) { return one.path == settings.dbc || one.path == settings.depfile; });
    check_marks(headers, settings.replace);
  }
  write_all_files(files, inputs);
  if (settings.verbose) {
    for (const OutputFile& file : files) print_visibly(stdout, "{}\n", file.path);
  }
  return exit_fine;
}

}  // namespace

void add_generate_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, generate, exit_code);
  command.add_option("FILE", settings.load.path, "EDS, DCF, XDD, XDC or overlay").required();
  command.add_option("--output", settings.output, "the headers are written to its subfolder NAME");
  command.add_option("--dbc", settings.dbc, "needs --node-id");
  command.add_option("--name", settings.load.name).check([](const std::string& name) {
    if (!name.empty() && to_namespace(name) == name) return std::string{};
    return fmt::format("expected a namespace in snake_case, such as \"{1}\", not \"{0}\"", name, to_namespace(name));
  });
  add_node_id_option(command, settings.load.node_id);
  add_options_option(command, settings.load.options_path);
  command.add_flag("--static-mapping", settings.load.static_mapping);
  add_choice(command, "--target", settings.target, target_names(), target_help()).show_default();
  command.add_option("--templates", settings.templates).existing_folder();
  command.add_option("--depfile", settings.depfile);
  command.add_option("--depfile-target", settings.depfile_target);
  command.add_flag("--keep-going", settings.load.keep_going);
  command.add_flag("--verbose", settings.verbose);
  add_replace_options(command, settings.replace, false);
  settings.color.add_to(command);
}

}  // namespace edsc
