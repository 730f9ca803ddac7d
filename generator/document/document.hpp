/// A device or a network as a page for people: HTML that needs no other file, or Markdown.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compare/change.hpp"
#include "diagnostics/diagnostics.hpp"
#include "load/load_device.hpp"
#include "network/network.hpp"
#include "system/write_files.hpp"

namespace edsc {

enum class DocumentFormat : std::uint8_t { html, markdown };

/// What a user adds to a page, all of it optional.
struct DocumentHead {
  std::string title;         ///< in place of the name of the device or of the network file
  std::string author, date;  ///< as they were given
  std::string logo;          ///< the URL of a picture: `data:image/svg+xml,...`; HTML only
  bool has_findings = true;  ///< otherwise the page does not have those of `edsc check`

  /// Of a picture in this file, with its contents: SVG, PNG or JPEG, by the name. Empty for another name.
  [[nodiscard]] static std::string logo_url(std::string_view file_name, std::string_view contents);
};

/// The changes since another version of a device.
struct ComparedWith {
  std::string name;  ///< of the file: `drive-1.0.eds`, `main:drive.eds`
  Changes changes;
};

/// The node of a network that a device is.
struct NodeOfNetwork {
  const NetworkNode& node;
  std::string network;  ///< the name of the network file
  std::string page;     ///< the file of the page of the network, in the same folder
};

/// A device that was loaded, and what is known about it.
struct DeviceToDocument {
  const LoadedDevice& loaded;                ///< has a device, unless `node` has it
  const Diagnostics* diagnostics = nullptr;  ///< the findings of `edsc check`; null if the page has none
  const ComparedWith* compared = nullptr;    ///< null without another version
  const NodeOfNetwork* node = nullptr;       ///< null outside of a network

  /// The device with the values that the network sets, if it is a node of one.
  [[nodiscard]] const Device& device() const { return node != nullptr ? node->node.device() : *loaded.device; }
};

/// Renders identity, services, PDO layouts, findings, changes and the object dictionary. Texts of the EDS are printable
/// and escaped. The result depends only on the contents of the files and the name of the EDS without its folders.
[[nodiscard]] std::string document_of(const DeviceToDocument& device, DocumentFormat format, const DocumentHead& head);

/// Renders nodes, PDO links, SYNC cycle, bus load and response times of a network.
[[nodiscard]] std::string document_of(const Network& network, const Diagnostics& diagnostics, DocumentFormat format,
                                      const DocumentHead& head);

/// Returns the page of a network at this path, with links to a page for each node in the same folder: `plant.html` and
/// `plant-axis1.html`. The page of a node shows the values that the network sets beside the default values.
[[nodiscard]] std::vector<OutputFile> documents_of(const Network& network, const Diagnostics& diagnostics,
                                                   DocumentFormat format, const std::string& path,
                                                   const DocumentHead& head);

}  // namespace edsc
