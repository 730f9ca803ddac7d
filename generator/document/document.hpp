/// A device or a network as a page for people: HTML that needs no other file, or Markdown.
#pragma once

#include <cstdint>
#include <string>

#include "compare/change.hpp"
#include "diagnostics/diagnostics.hpp"
#include "load/load_device.hpp"
#include "network/network.hpp"

namespace edsc {

enum class DocumentFormat : std::uint8_t { html, markdown };

/// The changes since another version of a device.
struct ComparedWith {
  std::string name;  ///< of the file: `drive-1.0.eds`, `main:drive.eds`
  Changes changes;
};

/// A device that was loaded, and what is known about it.
struct DeviceToDocument {
  const LoadedDevice& loaded;              ///< has a device
  const Diagnostics& diagnostics;          ///< the findings of `edsc check`
  const ComparedWith* compared = nullptr;  ///< null without another version
};

/// Renders identity, services, PDO layouts, findings, changes and the object dictionary. Texts of the EDS are printable
/// and escaped. The result depends only on the contents of the files and the name of the EDS without its folders.
[[nodiscard]] std::string document_of(const DeviceToDocument& device, DocumentFormat format);

/// Renders nodes, PDO links, SYNC cycle, bus load and response times of a network.
[[nodiscard]] std::string document_of(const Network& network, const Diagnostics& diagnostics, DocumentFormat format);

}  // namespace edsc
