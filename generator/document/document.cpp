#include "document/document.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "backend/render.hpp"
#include "backend/template_parts.hpp"
#include "document/views.hpp"
#include "system/path.hpp"
#include "text/counted.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

using document::Json;

/// Empties the lines `~`. The template library removes an empty line after one that only has a tag, so that the
/// templates of Markdown have these. In a value, ~ is escaped.
std::string with_empty_lines(std::string text) {
  constexpr std::string_view mark = "\n~\n";
  for (std::size_t at = 0; (at = text.find(mark, at)) != std::string::npos;) text.replace(at, mark.size(), "\n\n");
  return text;
}

/// Renders the template of this name: `device` or `network`.
std::string rendered(std::string_view name, Json view, DocumentFormat format) {
  if (format == DocumentFormat::markdown) {
    return with_empty_lines(render_markdown(with_parts(fmt::format("{}.md", name)), view));
  }
  view["style"] = with_parts("document.css");
  view["script"] = report_template("document.js");
  return render_html(with_parts(fmt::format("{}.html", name)), view);
}

/// The file of the page of a node, beside that of the network: `plant-axis1.html`.
std::string node_page(const std::string& network_page, const NetworkNode& node) {
  const fs::path page = to_native(network_page);
  fs::path name = page.stem();
  name += to_native("-" + node.name);
  name += page.extension();
  return from_native(page.parent_path() / name);
}

/// `page` is that of the network if its nodes have pages, otherwise empty.
Json node_view(const NetworkNode& node, const std::string& page) {
  const Device& device = node.device();
  return {{"name", node.name},
          {"page", page.empty() ? Json(nullptr)
                                : Json(document::url_of(from_native(to_native(node_page(page, node)).filename())))},
          {"node_id", node.node_id},
          {"role", node.is_master ? "NMT master" : ""},
          {"vendor", device.vendor_name},
          {"product", device.product_name},
          {"file", node.has_file() ? file_name_of(device.source->name()) : "generated"},
          {"settings", node.settings.size()}};
}

std::string network_document(const Network& network, const Diagnostics& diagnostics, DocumentFormat format,
                             const std::string& page) {
  Json view;
  view["source"] = file_name_of(network.source->name());
  view["page_title"] = std::string{file_name_of(network.source->name())} + ", CANopen network";
  view["bit_rate"] = network.description.bit_rate ? Json(network.description.bit_rate->value) : Json(nullptr);
  view["length"] = network.description.length_m ? Json(network.description.length_m->value) : Json(nullptr);
  view["node_count"] = counted(network.nodes.size(), "node");
  Json nodes = Json::array();
  for (const NetworkNode& node : network.nodes) nodes.push_back(node_view(node, page));
  view["members"] = std::move(nodes);
  document::add_findings(diagnostics, view);
  document::add_topology(network, view);
  document::add_timing(network, view);
  return rendered("network", std::move(view), format);
}

}  // namespace

std::string document_of(const DeviceToDocument& device, DocumentFormat format) {
  Json view;
  document::add_identity(device, view);
  view["checked"] = device.diagnostics != nullptr;
  if (device.diagnostics != nullptr) document::add_findings(*device.diagnostics, view);
  document::add_changes(device.compared, view);
  document::add_pdos(device, view);
  document::add_error_codes(device.device(), view);
  document::add_objects(device, view);
  view["page_title"] = view["title"].get<std::string>() + ", CANopen device";
  return rendered("device", std::move(view), format);
}

std::string document_of(const Network& network, const Diagnostics& diagnostics, DocumentFormat format) {
  return network_document(network, diagnostics, format, {});
}

std::vector<OutputFile> documents_of(const Network& network, const Diagnostics& diagnostics, DocumentFormat format,
                                     const std::string& path) {
  const std::string name{file_name_of(network.source->name())};
  std::vector<OutputFile> files{{path, network_document(network, diagnostics, format, path)}};
  for (const NetworkNode& node : network.nodes) {
    const NodeOfNetwork in_network{node, name, std::string{file_name_of(path)}};
    DeviceToDocument device{*node.loaded};
    device.node = &in_network;
    files.push_back({node_page(path, node), document_of(device, format)});
  }
  return files;
}

}  // namespace edsc
