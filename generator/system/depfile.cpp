#include "system/depfile.hpp"

#include <fmt/format.h>

#include <string_view>

namespace edsc {
namespace {

/// A path in a make rule: blanks, dollars and hashes escaped.
std::string make_path(std::string_view path) {
  std::string out;
  for (const char c : path) {
    if (c == ' ' || c == '#') out += '\\';
    if (c == '$') out += '$';
    out += c;
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
