/// An HTTP server for a page that edits a file.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "web/web_server.hpp"

namespace edsc {

/// An answer in JSON, with the status of HTTP.
struct JsonAnswer {
  int status = 200;
  std::string body;
};

/// What the server asks for. It never calls two at a time.
struct EditHandlers {
  std::function<JsonAnswer(std::string_view action, std::string_view body)> post;
  std::function<std::string(std::uint64_t since)> update;
  std::function<std::uint64_t()> version;
  std::function<bool()> look_for_changes;  ///< of the file; whether there is a new version
  std::function<JsonAnswer(std::string_view title)> section;
  std::function<std::string()> diff;
  std::function<bool()> has_unsaved_edits;
};

/// Serves, in threads of its own, the page and its requests, to this computer only. The token of a URL can be exchanged
/// once for that of a session. What changes something also needs the origin of the page and JSON with a stated length.
class EditServer {
 public:
  static constexpr std::size_t max_body_bytes = 65'536;
  static constexpr std::size_t max_import_bytes = 4'194'304;  ///< of the text of a file to import from

  /// `page` has the placeholder `{{{nonce}}}`. `port` 0: the system picks one. Throws CannotListen.
  EditServer(std::uint16_t port, std::string page, EditHandlers handlers);
  ~EditServer();
  EditServer(const EditServer&) = delete;
  EditServer& operator=(const EditServer&) = delete;

  /// A URL of the page with a new token.
  [[nodiscard]] std::string new_url();

  [[nodiscard]] bool has_unsaved_edits();

  /// The time since the last page was closed; nothing while one is open, and before the first one.
  [[nodiscard]] std::optional<std::chrono::milliseconds> time_without_page();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace edsc
