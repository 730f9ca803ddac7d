#include "device/resolve_information.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "diagnostics/quote.hpp"
#include "eds/number.hpp"

namespace edsc {
namespace {

/// A field that is copied unchanged.
template <typename Source, typename Target>
struct TextRow {
  Field Source::*from;
  std::string Target::*to;
};

template <typename Source, typename Target, typename Number>
struct NumberRow {
  Field Source::*from;
  std::optional<Number> Target::*to;
};

constexpr TextRow<FileInfo, FileInformation> file_texts[] = {
    {&FileInfo::file_name, &FileInformation::file_name},
    {&FileInfo::file_version, &FileInformation::file_version},
    {&FileInfo::file_revision, &FileInformation::file_revision},
    {&FileInfo::eds_version, &FileInformation::eds_version},
    {&FileInfo::description, &FileInformation::description},
    {&FileInfo::creation_time, &FileInformation::creation_time},
    {&FileInfo::creation_date, &FileInformation::creation_date},
    {&FileInfo::created_by, &FileInformation::created_by},
    {&FileInfo::modification_time, &FileInformation::modification_time},
    {&FileInfo::modification_date, &FileInformation::modification_date},
    {&FileInfo::modified_by, &FileInformation::modified_by},
    {&FileInfo::last_eds, &FileInformation::last_eds},
};

constexpr NumberRow<DeviceInfo, Capabilities, bool> device_flags[] = {
    {&DeviceInfo::simple_boot_up_master, &Capabilities::simple_boot_up_master},
    {&DeviceInfo::simple_boot_up_slave, &Capabilities::simple_boot_up_slave},
    {&DeviceInfo::group_messaging, &Capabilities::group_messaging},
    {&DeviceInfo::lss_supported, &Capabilities::lss_supported},
};

constexpr NumberRow<DeviceInfo, Capabilities, std::uint32_t> device_numbers[] = {
    {&DeviceInfo::granularity, &Capabilities::granularity},
    {&DeviceInfo::dynamic_channels_supported, &Capabilities::dynamic_channels_supported},
    {&DeviceInfo::nr_of_rx_pdo, &Capabilities::nr_of_rx_pdo},
    {&DeviceInfo::nr_of_tx_pdo, &Capabilities::nr_of_tx_pdo},
    {&DeviceInfo::compact_pdo, &Capabilities::compact_pdo},
};

constexpr TextRow<DeviceCommissioning, Commissioning> commissioning_texts[] = {
    {&DeviceCommissioning::node_name, &Commissioning::node_name},
    {&DeviceCommissioning::network_name, &Commissioning::network_name},
    {&DeviceCommissioning::node_refd, &Commissioning::node_refd},
    {&DeviceCommissioning::net_refd, &Commissioning::net_refd},
};

constexpr NumberRow<DeviceCommissioning, Commissioning, std::uint32_t> commissioning_numbers[] = {
    {&DeviceCommissioning::baudrate, &Commissioning::baudrate},
    {&DeviceCommissioning::net_number, &Commissioning::net_number},
    {&DeviceCommissioning::lss_serial_number, &Commissioning::lss_serial_number},
};

class InformationReader {
 public:
  InformationReader(const DataSheet& sheet, const Options& options, Diagnostics& diagnostics)
      : sheet_{sheet}, options_{options}, diagnostics_{diagnostics} {}

  Information read() {
    for (const auto& row : file_texts) information_.file.*row.to = (sheet_.file_info.*row.from).text;
    information_.comments = lines_of(sheet_.comments);
    for (const Tool& tool : sheet_.tools)
      information_.tools.push_back({std::string{tool.name.text}, std::string{tool.command.text}});
    read_capabilities();
    read_commissioning();
    read_dynamic_channels();
    read_modules();
    return std::move(information_);
  }

 private:
  std::optional<std::uint32_t> number(const Field& field, WarningRule rule) {
    return read_number(field, rule, diagnostics_);
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
    for (const auto& row : device_flags) capabilities.*row.to = flag(info.*row.from);
    for (const auto& row : device_numbers) capabilities.*row.to = number(info.*row.from, "device-info");
    for (const DeviceInfo::BaudRate& rate : info.baud_rates) {
      if (flag(rate.field).value_or(false)) capabilities.baud_rates.push_back(rate.kbit_per_second);
    }
    std::ranges::sort(capabilities.baud_rates);
  }

  void read_commissioning() {
    const DeviceCommissioning& section = sheet_.commissioning;
    if (!section.present) return;
    Commissioning& commissioning = information_.commissioning.emplace();
    for (const auto& row : commissioning_texts) commissioning.*row.to = (section.*row.from).text;
    for (const auto& row : commissioning_numbers) commissioning.*row.to = number(section.*row.from, "commissioning");
    commissioning.canopen_manager = flag(section.canopen_manager);
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

  void read_modules() {
    for (const ModuleDescription& module : sheet_.modules.supported) {
      information_.supported_modules.push_back({module.number, std::string{module.product_name.text},
                                                std::string{module.order_code.text},
                                                number(module.product_version, "modules"),
                                                number(module.product_revision, "modules"), lines_of(module.comments)});
    }
    information_.connected_modules = options_.connected_modules;
    if (!information_.connected_modules.empty()) return;
    for (const NumberedField& slot : sheet_.modules.connected) {
      const auto module = number(slot.field, "modules");
      if (module && *module <= 0xFFFF) {
        information_.connected_modules.push_back(static_cast<std::uint16_t>(*module));
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
  diagnostics.warning(rule, field.position,
                      fmt::format("{} is not an UNSIGNED32 value; it is left out", quote(field.text)));
  return std::nullopt;
}

}  // namespace edsc
