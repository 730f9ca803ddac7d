#include "network/generate/device_headers.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <tuple>

#include "backend/cpp/headers.hpp"
#include "backend/cpp/identifier.hpp"
#include "device/value_overlay.hpp"
#include "system/path.hpp"

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
  /// The device with the values of the network, but without the units of its signals: the other nodes do not have them
  /// either. The PDOs of a master without a file cannot be mapped otherwise.
  std::string add_master(const NetworkNode& node) {
    const std::string name = namespaces_.take(to_namespace(node.name), "device");
    Options options = node.loaded->options;
    if (!node.has_file()) options.static_mapping.all = true;
    if (node.signal_quantities.empty()) {
      add(node.device(), options, name);
    } else {
      Diagnostics of_mapping;  // reported when the network was read
      add(with_values(*node.loaded->device, node.settings, node.loaded->options, of_mapping), options, name);
    }
    return name;
  }

  std::string add_sheet(const NetworkNode& node) {
    const bool keeps_going = node.description->keep_going && node.description->keep_going->value;
    const std::string& path = node.loaded->source->name();
    const std::string options = node.loaded->options_source ? node.loaded->options_source->name() : "";
    std::string& name = sheets_[{path, options, keeps_going}];
    if (!name.empty()) return name;
    name = namespaces_.take(to_namespace(stem_of(path)), "device");
    add(device_for(*node.loaded, std::nullopt, keeps_going), node.loaded->options, name);
    return name;
  }

  void add(const Device& device, const Options& options, const std::string& name) {
    std::ranges::move(headers_of(device, options, name, diagnostics_), std::back_inserter(headers_.files));
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
