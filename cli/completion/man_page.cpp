#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

#include "completion/command_parts.hpp"

namespace edsc {
namespace {

constexpr const char* tail = R"(.SH EXIT STATUS
.TP
.B 0
success, possibly with warnings
.TP
.B 1
the input has errors, or a device failed or did not answer
.TP
.B 2
wrong usage, or a file or bus cannot be used
.TP
.B 130
interrupted by Ctrl\-C or SIGTERM
.SH ENVIRONMENT
.TP
.B EDSC_BUS
the bus of commands that are called without BUS, such as socketcan:can0
.TP
.B EDSC_NETWORK
the network file of commands that are called without \-\-network; completion offers its nodes and objects
.TP
.B NO_COLOR
if set, output is not coloured unless
.B \-\-color
says so
.TP
.B TERM
if it is dumb, output is not coloured either
.SH SEE ALSO
.BR candump (1)
)";

/// Text with roff markup escaped.
std::string escaped(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool line_begins = at == 0 || text[at - 1] == '\n';
    if (line_begins && (text[at] == '.' || text[at] == '\'')) out += "\\&";
    switch (text[at]) {
      case '\\': out += "\\e"; break;
      case '-': out += "\\-"; break;
      case '\'': out += "\\(aq"; break;
      case '`': out += "\\(ga"; break;
      case '^': out += "\\(ha"; break;
      case '~': out += "\\(ti"; break;
      default: out += text[at];
    }
  }
  return out;
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// `Say what is wrong.`
std::string sentence(const std::string& text) {
  return upper_case(text.substr(0, 1)) + text.substr(1) + (text.ends_with('.') ? "" : ".");
}

std::string name_of(const CommandParts& command) { return escaped("edsc " + command.path_with(" ")); }

/// With the arguments that are before a subcommand: `edsc lss BUS inquire`.
std::string usage_of(const CommandParts& command) { return escaped("edsc " + command.usage); }

/// The commands without subcommands, which are those that a user calls.
/// `parents` are the command's parents, whose arguments come before the name of the command: `edsc lss BUS assign`.
void append_synopsis(std::string& out, const CommandParts& command, std::vector<const CommandParts*> parents = {}) {
  parents.push_back(&command);
  for (const CommandParts& sub : command.subcommands) append_synopsis(out, sub, parents);
  if (!command.subcommands.empty()) return;
  if (!out.ends_with(".ad l\n")) out += ".br\n";
  out += fmt::format(".B {}\n[\\fIoptions\\fR]\n", usage_of(command));
  for (const OptionParts& argument : command.arguments) {
    out += fmt::format("\\fI{}\\fR\n", escaped(argument.as_usage()));
  }
}

void append_option(std::string& out, const OptionParts& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.names) {
    names.push_back(fmt::format("\\f{}{}\\fR", option.is_argument ? 'I' : 'B', escaped(name)));
  }
  const bool is_long = option.value.has_long_list();
  std::string text = option.description;
  std::string type;
  if (is_long || (option.is_argument && !option.value.words.empty()))
    text += fmt::format(": {}", fmt::join(option.value.words, ", "));
  if (!option.is_argument && !option.value.name.empty())
    type = fmt::format(" \\fI{}\\fR", is_long ? "WORD" : escaped(option.value.name));
  out += fmt::format(".TP\n{}{}\n{}\n", fmt::join(names, ", "), type, escaped(text));
}

void append_command(std::string& out, const CommandParts& command) {
  for (const CommandParts& sub : command.subcommands) append_command(out, sub);
  if (command.subcommands.empty()) {
    out += fmt::format(".SS {}\n{}\n", name_of(command), escaped(sentence(command.description)));
    for (const OptionParts& argument : command.arguments) append_option(out, argument);
    for (const OptionParts& option : command.options) append_option(out, option);
  }
  if (!command.example_lines.empty()) out += fmt::format(".PP\n.nf\n{}\n.fi\n", escaped(command.example_lines));
}

}  // namespace

std::string man_page(const CommandParts& program, const std::string& version) {
  std::string out = fmt::format(".TH EDSC 1 \"\" \"edsc {}\" \"User Commands\"\n", escaped(version));
  out += ".SH NAME\nedsc \\- compiler for CANopen Electronic Data Sheets\n.SH SYNOPSIS\n.nh\n.ad l\n";
  append_synopsis(out, program);
  out += fmt::format(".ad b\n.hy\n.SH DESCRIPTION\n{}\n", escaped(program.description));
  for (const auto& [group, commands] : program.groups()) {
    out += fmt::format(".SH COMMANDS: {}\n", escaped(upper_case(group)));
    for (const CommandParts* command : commands) append_command(out, *command);
  }
  return out + tail;
}

}  // namespace edsc
