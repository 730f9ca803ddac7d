/// A language server (Language Server Protocol 3.17): gets messages, answers requests, and publishes findings. The
/// caller reads and writes the streams.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "lsp/features.hpp"
#include "lsp/workspace.hpp"

namespace edsc::lsp {

struct ServerHooks {
  std::string version;                                       ///< of edsc
  std::function<void(std::string_view message)> send;        ///< gets a JSON text
  std::function<void(std::string_view text)> log;            ///< gets faults, for a person
  std::function<std::string(const Rule& rule)> url_of = {};  ///< where a rule is documented; may be empty
  Committed committed = {};                                  ///< the file of git HEAD; may be empty
  CheckDeviations check_deviations = {};                     ///< may be empty
  std::vector<ConformanceCase> conformance_cases = {};       ///< those that a file of deviations can name
};

class Server {
 public:
  explicit Server(ServerHooks hooks);

  /// Handles a message. Whatever it contains, the server continues.
  void receive(std::string_view message);
  /// Publishes the findings of what has changed: to be called when no message is waiting.
  void publish();

  [[nodiscard]] bool has_ended() const { return has_ended_; }
  /// Whether the client has asked for the end as the protocol states it.
  [[nodiscard]] bool was_shut_down() const { return was_shut_down_; }

 private:
  struct Method;
  static const std::map<std::string_view, Method>& methods();

  void dispatch(const Json& message);
  [[nodiscard]] Json answer(const std::string& method, const Json& params, bool is_request);
  void send(const Json& message);
  void send_error(const Json& id, int code, const std::string& message);

  Json initialize(const Json& params);
  void open(const Json& params);
  void change(const Json& params);
  void close(const Json& params);
  void save(const Json& params);
  /// Calls `use` with the document of the parameters; null if it is not open.
  Json with_view(const Json& params, const std::function<Json(const View&)>& use);

  ServerHooks hooks_;
  Workspace workspace_;
  PositionEncoding encoding_ = PositionEncoding::utf16;
  bool resolves_actions_ = false;  ///< the client asks for the edit of an action that the user selects
  bool is_initialized_ = false;
  bool was_shut_down_ = false;
  bool has_ended_ = false;
  std::map<std::string, Published> findings_;                             ///< by the URI of the document
  std::map<std::string, std::shared_ptr<const LoadedDevice>> committed_;  ///< by path; null without one
};

}  // namespace edsc::lsp
