/// The environment of a node on a host: its settings, its storage and a log.
#pragma once

#include <canopen/can/node_id.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "node_storage.hpp"

namespace nodes {

/// It outlives the node, so that stored values are available when the node is switched on again.
class Surroundings {
 public:
  using Log = std::function<void(std::string_view line)>;

  /// `store` is the path FILE of the file for parameters; other values are stored in FILE.lss and FILE.application.
  /// Empty: no files.
  Surroundings(std::optional<canopen::NodeId> chosen_node_id, std::uint32_t serial, std::string store, Log log_to)
      : node_id{chosen_node_id},
        serial_number{serial},
        parameters{store},
        lss{with_suffix(store, "lss")},
        application{with_suffix(store, "application")},
        log{std::move(log_to)},
        store_{std::move(store)} {}
  explicit Surroundings(std::optional<canopen::NodeId> chosen_node_id = std::nullopt)
      : Surroundings{chosen_node_id, 1, {}, [](std::string_view) {}} {}

  /// The environment of one of several nodes, by its name: logs lines with the name first and stores in FILE.NAME.
  [[nodiscard]] Surroundings& part(const std::string& name) {
    std::unique_ptr<Surroundings>& found = parts_[name];
    if (!found) {
      const auto log_with_name = [this, name](std::string_view line) { log(name + ": " + std::string{line}); };
      found = std::make_unique<Surroundings>(std::nullopt, serial_number, with_suffix(store_, name), log_with_name);
    }
    return *found;
  }

  std::optional<canopen::NodeId> node_id;  ///< of the switches; std::nullopt: the default of the device
  std::uint32_t serial_number;             ///< 1018h:04, if it can be set in the device
  NodeStorage parameters;                  ///< for 1010h and 1011h
  NodeStorage lss;                         ///< node-ID and bit rate
  NodeStorage application;                 ///< values that are not in an object
  Log log;

 private:
  [[nodiscard]] static std::string with_suffix(const std::string& store, const std::string& name) {
    return store.empty() ? store : store + "." + name;
  }

  std::string store_;
  std::map<std::string, std::unique_ptr<Surroundings>> parts_;
};

}  // namespace nodes
