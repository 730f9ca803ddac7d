#include "network/generate/device_headers.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <tuple>

#include "backend/cpp/cpp_view.hpp"
#include "backend/cpp/identifier.hpp"
#include "backend/render.hpp"

namespace edsc {
namespace {

class HeaderWriter {
 public:
  HeaderWriter(const Network& network, const std::string& taken, Diagnostics& diagnostics)
      : network_{network}, diagnostics_{diagnostics} {
    static_cast<void>(namespaces_.take(taken, ""));
  }

  DeviceHeaders write() {
    for (const NetworkNode& node : network_.nodes) {
      headers_.names.push_back(&node == network_.master() ? add_master(node) : add_sheet(node));
    }
    return std::move(headers_);
  }

 private:
  /// The device with the values of the network. The PDOs of a master without a file cannot be mapped otherwise.
  std::string add_master(const NetworkNode& node) {
    const std::string name = namespaces_.take(to_namespace(node.name), "device");
    Options options = node.loaded->options;
    if (!node.has_file()) options.static_mapping.all = true;
    add(node.device, options, name);
    return name;
  }

  std::string add_sheet(const NetworkNode& node) {
    const bool keeps_going = node.description->keep_going && node.description->keep_going->value;
    const std::string& path = node.loaded->source->name();
    const std::string options = node.loaded->options_source ? node.loaded->options_source->name() : "";
    std::string& name = sheets_[{path, options, keeps_going}];
    if (!name.empty()) return name;
    name = namespaces_.take(to_namespace(std::filesystem::path{path}.stem().string()), "device");
    LoadSettings settings;
    settings.path = path;
    settings.options_path = options;
    settings.name = name;
    settings.check = false;
    settings.keep_going = keeps_going;
    Diagnostics known;  // reported when the network was loaded
    const std::unique_ptr<LoadedDevice> loaded = load_device(settings, known);
    if (loaded->device) {
      add(*loaded->device, loaded->options, name);
    } else {
      diagnostics_.error("network-file", node.position, fmt::format("{} has changed meanwhile", path));
    }
    return name;
  }

  void add(const Device& device, const Options& options, const std::string& name) {
    const CppNames names{device, options, name};
    const nlohmann::ordered_json view = cpp_view({device, names}, options, diagnostics_);
    for (const Template& header : built_in_templates()) {
      if (!is_needed(header, view)) continue;
      headers_.files.push_back({fmt::format("{}/{}", name, header.file_name), render(header.text, view)});
    }
  }

  const Network& network_;
  Diagnostics& diagnostics_;
  IdentifierScope namespaces_;
  std::map<std::tuple<std::string, std::string, bool>, std::string> sheets_;
  DeviceHeaders headers_;
};

}  // namespace

DeviceHeaders device_headers(const Network& network, const std::string& taken, Diagnostics& diagnostics) {
  return HeaderWriter{network, taken, diagnostics}.write();
}

}  // namespace edsc
