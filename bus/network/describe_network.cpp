#include "network/describe_network.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "system/path.hpp"
#include "text/ascii.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& text) { return json_text(nlohmann::json(text)); }

/// `Live device; vendor-ID 00ABCDEFh, product code 00001001h`
std::string device_text(const FoundNode& node, bool only_listened) {
  if (!node.answers_sdo && !only_listened) return "does not answer over SDO";
  std::string text = node.name ? printable(*node.name) : std::string{};
  std::string_view separator = text.empty() ? "" : "; ";
  for (const IdentityNumber& number : identity_numbers) {
    const auto& value = node.identity.*number.value;
    if (!value) continue;
    text += fmt::format("{}{} {:08X}h", separator, number.name, *value);
    separator = ", ";
  }
  return text.empty() ? "identity not known" : text;
}

std::string match_text(const FittingSheet& sheet, const Identity& identity) {
  std::string text{sheet.match == IdentityMatch::same ? "" : to_text(sheet.match)};
  if (const auto missing = not_compared(sheet.file->identity, identity); !missing.empty()) {
    text += fmt::format("{}{} not compared", text.empty() ? "" : "; ", names_of(missing));
  }
  return text;
}

class NetworkText {
 public:
  NetworkText(const std::vector<SheetFile>& sheets, const DescribeSettings& settings)
      : sheets_{sheets}, settings_{settings} {}

  DescribedNetwork describe(const std::vector<FoundNode>& nodes) {
    for (const FoundNode& node : nodes) add(node);
    std::string& text = result_.text;
    text = settings_.bit_rate ? fmt::format("{{\n  \"bit_rate\": {},\n", *settings_.bit_rate)
                              : "{\n  // \"bit_rate\": 500,  (in kbit/s; not known)\n";
    text += "  \"nodes\": {\n";
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      text += "    " + lines_[i];
      if (i < last_node_) text += is_node_[i] ? "," : "";
      text += '\n';
    }
    text += settings_.guessed.empty() ? "  }\n}\n" : "  },\n" + guessed_lines() + "}\n";
    return std::move(result_);
  }

 private:
  void add(const FoundNode& node) {
    comment(fmt::format("node {}: {}", node.node_id, device_text(node, settings_.only_listened)));
    if (const auto remark = settings_.remarks.find(node.node_id); remark != settings_.remarks.end()) {
      comment(fmt::format("node {}: {}", node.node_id, remark->second));
    }
    if (node.has_extra_responses) error(node, extra_responses_text(node.node_id));
    const auto fitting = fitting_sheets(sheets_, node.node_id, node.identity);
    if (fitting.empty()) {
      add_without_file(node);
      return;
    }
    const SheetFile& best = *fitting.front().file;
    if (const std::string remark = match_text(fitting.front(), node.identity); !remark.empty()) {
      note(fmt::format("node {}: {}: {}", node.node_id, best.path, remark));
    }
    for (std::size_t i = 1; i < fitting.size(); ++i) {
      note(fmt::format("node {}: {} fits too; using {}", node.node_id, fitting[i].file->path, best.path));
    }
    std::string line = fmt::format("{}: {{\"node_id\": {}, \"{}\": {}", quoted(name_of(node, best)), node.node_id,
                                   best.is_dcf ? "dcf" : "eds", quoted(beside_network_file(best.path)));
    const std::uint32_t heartbeat = node.heartbeat_ms.value_or(best.heartbeat_ms);
    if (best.has_heartbeat && heartbeat != best.heartbeat_ms) line += fmt::format(", \"heartbeat_ms\": {}", heartbeat);
    if (const std::uint32_t serial_number = node.identity.serial_number.value_or(0); serial_number != 0) {
      line += fmt::format(", \"serial_number\": {}", serial_number);
    }
    ++result_.nodes;
    last_node_ = lines_.size();
    lines_.push_back(line + "}");
    is_node_.push_back(true);
  }

  /// The closest file and its differences help to find out why.
  void add_without_file(const FoundNode& node) {
    std::string why = node.answers_sdo || settings_.only_listened ? "no file fits" : "does not answer over SDO";
    const SheetFile* closest = nullptr;
    for (const SheetFile& sheet : sheets_) {
      const unsigned count = count_differences(sheet.identity, node.identity);
      if (count == 0) continue;
      if (closest == nullptr || count < count_differences(closest->identity, node.identity)) closest = &sheet;
    }
    if (closest != nullptr) {
      why +=
          fmt::format("; the closest is {}: {}", closest->path, identity_differences(closest->identity, node.identity));
    }
    error(node, why);
    comment(fmt::format("\"node_{}\": {{\"node_id\": {}, \"eds\": \"\"}}", node.node_id, node.node_id));
  }

  /// The member, indented.
  [[nodiscard]] std::string guessed_lines() const {
    std::string text =
        "  // Guesses from the frames of the bus. Commands for networks ignore this member.\n  \"guessed\": ";
    for (const char c : settings_.guessed) {
      text += c;
      if (c == '\n') text += "  ";
    }
    return text + '\n';
  }

  void error(const FoundNode& node, const std::string& text) {
    result_.errors.push_back(fmt::format("node {}: {}", node.node_id, text));
    comment(text);
  }

  void note(const std::string& text) {
    result_.notes.push_back(text);
    comment(text);
  }

  void comment(const std::string& text) {
    lines_.push_back("// " + printable(text));
    is_node_.push_back(false);
  }

  /// The name in a DCF, or else that of the file with the node-ID: `drive_5`.
  std::string name_of(const FoundNode& node, const SheetFile& sheet) {
    const bool is_usable = !sheet.node_name.empty() && sheet.node_name.find('.') == std::string::npos;
    if (is_usable && names_.insert(sheet.node_name).second) return sheet.node_name;
    std::string name{stem_of(sheet.path)};
    for (char& c : name) c = is_letter(c) || is_digit(c) ? to_lower(c) : '_';
    name += fmt::format("_{}", node.node_id);
    while (!names_.insert(name).second) name += '_';
    return name;
  }

  [[nodiscard]] std::string beside_network_file(const std::string& path) const {
    std::error_code error;
    const fs::path relative =
        fs::proximate(to_native(path), settings_.folder.empty() ? fs::path{"."} : to_native(settings_.folder), error);
    return error ? path : from_native(relative);
  }

  const std::vector<SheetFile>& sheets_;
  const DescribeSettings& settings_;
  DescribedNetwork result_;
  std::vector<std::string> lines_;
  std::vector<bool> is_node_;
  std::size_t last_node_ = 0;  ///< in `lines_`
  std::set<std::string> names_;
};

}  // namespace

DescribedNetwork describe_network(const std::vector<FoundNode>& nodes, const std::vector<SheetFile>& sheets,
                                  const DescribeSettings& settings) {
  return NetworkText{sheets, settings}.describe(nodes);
}

}  // namespace edsc
