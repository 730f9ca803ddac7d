#include "document/document.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "backend/render.hpp"
#include "backend/template_parts.hpp"
#include "document/views.hpp"
#include "eds/ini.hpp"
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

void add_head(const DocumentHead& head, Json& view) {
  view["author"] = head.author;
  view["date"] = head.date;
  view["has_author_or_date"] = !head.author.empty() || !head.date.empty();
  view["has_author_and_date"] = !head.author.empty() && !head.date.empty();
  view["logo"] = head.logo;
  view["has_logo"] = !head.logo.empty();
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
                             const std::string& page, const DocumentHead& head) {
  Json view;
  view["source"] = file_name_of(network.source->name());
  const std::string title = head.title.empty() ? std::string{file_name_of(network.source->name())} : head.title;
  view["title"] = title;
  view["page_title"] = title + ", CANopen network";
  add_head(head, view);
  view["checked"] = head.has_findings;
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

std::string DocumentHead::logo_url(std::string_view file_name, std::string_view contents) {
  struct Row {
    std::string_view extension, type;
  };
  constexpr Row rows[] = {
      {".svg", "image/svg+xml"}, {".png", "image/png"}, {".jpg", "image/jpeg"}, {".jpeg", "image/jpeg"}};
  for (const Row& row : rows) {
    if (ends_with_ignoring_case(file_name, row.extension)) {
      return fmt::format("data:{},{}", row.type, document::url_of(contents));
    }
  }
  return {};
}

std::string document_of(const DeviceToDocument& device, DocumentFormat format, const DocumentHead& head) {
  Json view;
  document::add_identity(device, view);
  if (!head.title.empty()) view["title"] = head.title;
  add_head(head, view);
  const bool has_findings = device.diagnostics != nullptr && head.has_findings;
  view["checked"] = has_findings;
  if (has_findings) document::add_findings(*device.diagnostics, view);
  document::add_changes(device.compared, view);
  document::add_pdos(device, view);
  document::add_error_codes(device.device(), view);
  document::add_objects(device, view);
  view["page_title"] = view["title"].get<std::string>() + ", CANopen device";
  return rendered("device", std::move(view), format);
}

std::string document_of(const Network& network, const Diagnostics& diagnostics, DocumentFormat format,
                        const DocumentHead& head) {
  return network_document(network, diagnostics, format, {}, head);
}

std::vector<OutputFile> documents_of(const Network& network, const Diagnostics& diagnostics, DocumentFormat format,
                                     const std::string& path, const DocumentHead& head) {
  const std::string name{file_name_of(network.source->name())};
  std::vector<OutputFile> files{{path, network_document(network, diagnostics, format, path, head)}};
  for (const NetworkNode& node : network.nodes) {
    const NodeOfNetwork in_network{node, name, std::string{file_name_of(path)}};
    DeviceToDocument device{*node.loaded};
    device.node = &in_network;
    DocumentHead of_node = head;
    of_node.title.clear();  // that of the network
    files.push_back({node_page(path, node), document_of(device, format, of_node)});
  }
  return files;
}

}  // namespace edsc
