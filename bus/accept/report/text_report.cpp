#include "accept/report/text_report.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "conform/report/decoded_frames.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"

namespace edsc::accept {
namespace {

constexpr std::size_t max_text_frames = 20;

std::string colored(std::string_view text, std::string_view color, bool on) {
  return on ? fmt::format("{}{}\x1b[0m", color, text) : std::string{text};
}

std::string_view color_of(const Difference& difference) {
  if (difference.is_declared()) return "\x1b[33m";
  return difference.mark == Mark::undecided ? "\x1b[35m" : "\x1b[1;31m";
}

/// A line with a name in a column, unless the text is empty.
void append_line(std::string& out, std::string_view name, std::string_view text) {
  if (!text.empty()) out += fmt::format("{:7}{:<13} {}\n", "", name, printable(text));
}

void append_difference(std::string& out, const Difference& difference, const Acceptance& acceptance, bool color) {
  const std::string mark = colored(fmt::format("{:<13}", row_of(difference.mark).text), color_of(difference), color);
  const std::string name = difference.name.empty() ? "" : ": " + printable(difference.name);
  out += fmt::format("{} {} {}{}\n", entry_label(difference.index, difference.sub_index), mark,
                     row_of(difference.kind).text, name);
  append_line(out, "EDS", difference.in_eds);
  append_line(out, "device", difference.in_device);
  append_line(out, "reason", difference.reason);
  append_line(out, "declared", difference.deviation);
  for (const Correction& correction : difference.corrections) {
    append_line(out, "EDS would be", correction_text(correction));
  }
  for (const std::string& line :
       conform::frame_lines(difference.frames, acceptance.run.node, acceptance.sheet, max_text_frames)) {
    append_line(out, "frame", line);
  }
}

}  // namespace

std::string comparison_text(const Acceptance& acceptance, bool color) {
  const Comparison& comparison = acceptance.comparison;
  std::string out;
  append_line(out, "edsc check",
              fmt::format("{}, {}", counted(acceptance.findings.errors(), "error"),
                          counted(acceptance.findings.warnings(), "warning")));
  for (const IdentityRow& row : acceptance.identity()) {
    const auto number = [](const std::optional<std::uint32_t>& value) {
      return value ? fmt::format("{:08X}h", *value) : std::string{"not known"};
    };
    std::string text = number(row.in_device);
    if (row.differs) text += "; EDS " + number(row.in_eds);
    if (!row.deviation.empty()) text += "; declared: " + row.deviation;
    append_line(out, row.number->name, text);
  }
  for (const Difference& difference : comparison.differences) append_difference(out, difference, acceptance, color);
  for (const std::string& line : comparison.unstable) append_line(out, "unstable", line);
  append_line(out, "dictionary", fmt::format("{}; {}", entries_sentence(comparison), differences_sentence(comparison)));
  append_line(out, "ended early", comparison.lost);
  return out;
}

std::string verdict_text(const Acceptance& acceptance, bool color) {
  const std::vector<std::string> objections = acceptance.objections();
  if (objections.empty()) return colored(headline(acceptance), "\x1b[32m", color) + '\n';
  std::string out = colored(headline(acceptance), "\x1b[1;31m", color) + ":\n";
  for (const std::string& objection : objections) out += fmt::format("  {}\n", printable(objection));
  return out;
}

}  // namespace edsc::accept
