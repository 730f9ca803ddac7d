#include "system/depfile.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

namespace edsc {
namespace {

/// What neither make nor ninja can read, or only one of them: control characters, `;`, a backslash before `#` or `:`,
/// and a backslash or colon as the last character.
bool is_expressible(std::string_view path) {
  if (path.ends_with('\\') || path.ends_with(':')) return false;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto c = static_cast<unsigned char>(path[i]);
    if (c < 0x20 || c == 0x7F || c == ';') return false;
    if (c == '\\' && (path[i + 1] == '#' || path[i + 1] == ':')) return false;
  }
  return true;
}

/// A path in a make rule. Backslashes are doubled before a blank only.
std::string make_path(std::string_view path) {
  if (!is_expressible(path)) {
    throw std::runtime_error{fmt::format("a depfile cannot name the file \"{}\"", path)};
  }
  std::string out;
  std::size_t backslashes = 0;
  for (const char c : path) {
    if (c == ' ') out.append(backslashes, '\\');
    if (c == ' ' || c == '#' || c == ':') out += '\\';
    if (c == '$') out += '$';
    out += c;
    backslashes = c == '\\' ? backslashes + 1 : 0;
  }
  return out;
}

}  // namespace

std::string depfile_text(const std::string& target, const std::vector<OutputFile>& outputs,
                         const std::vector<std::string>& inputs) {
  std::string text = make_path(target);
  for (const OutputFile& output : outputs) {
    if (target.empty()) text += fmt::format("{}{}", text.empty() ? "" : " ", make_path(output.path));
  }
  text += ":";
  for (const std::string& input : inputs) text += " \\\n  " + make_path(input);
  return text + "\n";
}

}  // namespace edsc
