#include "device/resolve_information.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "device/information_rows.hpp"
#include "diagnostics/quote.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"
#include "eds/sections/section_name.hpp"

namespace edsc {
namespace {

namespace rows = information_rows;

class InformationReader {
 public:
  InformationReader(const DataSheet& sheet, const Options& options, Diagnostics& diagnostics)
      : sheet_{sheet}, options_{options}, diagnostics_{diagnostics} {}

  Information read() {
    read_rows(rows::file_texts, sheet_.file_info, information_.file, "device-info");
    information_.comments = lines_of(sheet_.comments);
    for (const Tool& tool : sheet_.tools)
      information_.tools.push_back({std::string{tool.name.text}, std::string{tool.command.text}});
    read_capabilities();
    read_commissioning();
    read_dynamic_channels();
    read_modules();
    std::apply([&](const auto&... sections) { (read_plain(sections), ...); }, plain_sections);
    return std::move(information_);
  }

 private:
  std::optional<std::uint32_t> number(const Field& field, WarningRule rule) {
    return read_number(field, rule, diagnostics_);
  }

  void read(const Field& field, WarningRule, std::string& text) { text = field.text; }
  void read(const Field& field, WarningRule, std::optional<bool>& value) { value = flag(field); }
  void read(const Field& field, WarningRule rule, std::optional<std::uint32_t>& value) { value = number(field, rule); }

  /// Invalid numbers are reported with `rule`.
  template <typename Rows, typename Source, typename Target>
  void read_rows(const Rows& rows, const Source& source, Target& target, WarningRule rule) {
    for (const auto& row : rows) read(source.*row.from, rule, target.*row.to);
  }

  /// The rules report values other than 0 and 1.
  static std::optional<bool> flag(const Field& field) {
    const auto value = number_of(field);
    return field.present && value ? std::optional{*value != 0} : std::nullopt;
  }

  static std::vector<std::string> lines_of(const Comments& comments) {
    std::vector<std::string> lines;
    for (const NumberedField& line : comments.text) lines.emplace_back(line.field.text);
    return lines;
  }

  void read_capabilities() {
    Capabilities& capabilities = information_.capabilities;
    const DeviceInfo& info = sheet_.device_info;
    capabilities.order_code = info.order_code.text;
    read_rows(rows::device_flags, info, capabilities, "device-info");
    read_rows(rows::device_numbers, info, capabilities, "device-info");
    for (const DeviceInfo::BaudRate& rate : info.baud_rates) {
      if (flag(rate.field).value_or(false)) capabilities.baud_rates.push_back(rate.kbit_per_second);
    }
    std::ranges::sort(capabilities.baud_rates);
  }

  void read_commissioning() {
    const DeviceCommissioning& section = sheet_.commissioning;
    if (!section.present) return;
    Commissioning& commissioning = information_.commissioning.emplace();
    read_rows(rows::commissioning_texts, section, commissioning, "commissioning");
    read_rows(rows::commissioning_numbers, section, commissioning, "commissioning");
    read_rows(rows::commissioning_flags, section, commissioning, "commissioning");
  }

  void read_dynamic_channels() {
    for (const DynamicSegment& segment : sheet_.dynamic_channels.segments) {
      DynamicChannel channel;
      channel.data_type = number(segment.type, "dynamic-segment");
      channel.direction = strip_inline_comment(segment.direction.text);
      channel.process_picture_offset = number(segment.process_picture_offset, "dynamic-segment");
      read_range(segment.range, channel);
      information_.dynamic_channels.push_back(channel);
    }
  }

  /// `0xA080-0xA0BF`, or one index.
  void read_range(const Field& field, DynamicChannel& channel) {
    const std::string_view text = strip_inline_comment(field.text);
    const std::size_t dash = text.find('-');
    const auto first = parse_unsigned(text.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : parse_unsigned(text.substr(dash + 1));
    if (!first || !last || *first > *last || *last > 0xFFFF) {
      diagnostics_.warning("dynamic-segment", field.position,
                           fmt::format("{} is not an index range such as 0xA080-0xA0BF", quote(field.text)));
      return;
    }
    channel.first_index = static_cast<std::uint32_t>(*first);
    channel.last_index = static_cast<std::uint32_t>(*last);
  }

  template <typename Struct, std::size_t n>
  void read_plain(const PlainSection<Struct, n>& plain) {
    if (plain.dumped == Dumped::by_member || !(sheet_.*plain.member).present) return;
    information_.sections.push_back(
        {section_title(plain.kind), section_values(plain.keys, sheet_.*plain.member, plain.rule, diagnostics_)});
  }

  void read_modules() {
    for (const ModuleDescription& module : sheet_.modules.supported) {
      ModuleInformation& added = information_.supported_modules.emplace_back();
      added.number = module.number;
      added.product_name = module.product_name.text;
      added.order_code = module.order_code.text;
      read_rows(rows::module_numbers, module, added, "modules");
      added.comments = lines_of(module.comments);
    }
    information_.connected_modules = options_.connected_modules;
    if (!information_.connected_modules.empty()) return;
    for (const NumberedField& slot : sheet_.modules.connected) {
      const auto module = number(slot.field, "modules");
      if (module && *module <= 0xFFFF) {
        information_.connected_modules.push_back(static_cast<std::uint16_t>(*module));
      } else if (module) {
        diagnostics_.warning("modules", slot.field.position,
                             fmt::format("{} is not the number of a module; ignored", quote(slot.field.text)));
      }
    }
  }

  const DataSheet& sheet_;
  const Options& options_;
  Diagnostics& diagnostics_;
  Information information_;
};

}  // namespace

Information resolve_information(const DataSheet& sheet, const Options& options, Diagnostics& diagnostics) {
  return InformationReader{sheet, options, diagnostics}.read();
}

std::optional<std::uint32_t> read_number(const Field& field, WarningRule rule, Diagnostics& diagnostics) {
  const std::string_view text = strip_inline_comment(field.text);
  if (!field.present || text.empty()) return std::nullopt;
  const auto number = parse_unsigned(text);
  if (number && is_octal(text)) {
    diagnostics.warning("number-spelling", field.position,
                        fmt::format("a leading 0 makes {} an octal number: {}", quote(text), *number));
  }
  if (number && *number <= 0xFFFF'FFFF) return static_cast<std::uint32_t>(*number);
  diagnostics.warning(rule, field.position, fmt::format("{} is not an UNSIGNED32 value; ignored", quote(field.text)));
  return std::nullopt;
}

}  // namespace edsc
