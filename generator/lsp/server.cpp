#include "lsp/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace edsc::lsp {
namespace {

// Error codes of JSON-RPC 2.0 and of the Language Server Protocol.
constexpr int parse_error = -32700;
constexpr int invalid_request = -32600;
constexpr int method_not_found = -32601;
constexpr int invalid_params = -32602;
constexpr int internal_error = -32603;
constexpr int server_not_initialized = -32002;
constexpr int request_failed = -32803;

constexpr int incremental_sync = 2;

class MethodNotFound : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class NotInitialized : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class InvalidRequest : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

Json capabilities(PositionEncoding encoding) {
  return {{"positionEncoding", encoding == PositionEncoding::utf8 ? "utf-8" : "utf-16"},
          {"textDocumentSync", {{"openClose", true}, {"change", incremental_sync}, {"save", true}}},
          {"hoverProvider", true},
          {"completionProvider", {{"triggerCharacters", {"=", "[", "\"", ".", "$"}}}},
          {"definitionProvider", true},
          {"referencesProvider", true},
          {"documentSymbolProvider", true},
          {"foldingRangeProvider", true},
          {"documentFormattingProvider", true},
          {"inlayHintProvider", true},
          {"codeLensProvider", Json::object()},
          {"codeActionProvider", {{"codeActionKinds", {"quickfix", "source.fixAll.edsc"}}, {"resolveProvider", true}}},
          {"renameProvider", {{"prepareProvider", true}}}};
}

/// Whether a list of the parameters of `initialize` has a text.
bool lists(const Json& params, const Json::json_pointer& list, std::string_view text) {
  if (!params.is_object() || !params.contains(list)) return false;
  const Json& found = params.at(list);
  return found.is_array() && std::ranges::find(found, Json(text)) != found.end();
}

TextPosition position_in(const Json& params) { return position_from(params.at("position")); }

}  // namespace

struct Server::Method {
  Json (*run)(Server& server, const Json& params);
};

Server::Server(ServerHooks hooks)
    : hooks_{std::move(hooks)}, workspace_{hooks_.check_deviations, hooks_.conformance_cases} {}

const std::map<std::string_view, Server::Method>& Server::methods() {
  static const std::map<std::string_view, Method> all{
      {"initialize", {[](Server& server, const Json& params) { return server.initialize(params); }}},
      {"initialized", {[](Server&, const Json&) { return Json(nullptr); }}},
      {"shutdown", {[](Server& server, const Json&) {
         server.was_shut_down_ = true;
         return Json(nullptr);
       }}},
      {"exit", {[](Server& server, const Json&) {
         server.has_ended_ = true;
         return Json(nullptr);
       }}},
      {"textDocument/didOpen", {[](Server& server, const Json& params) {
         server.open(params);
         return Json(nullptr);
       }}},
      {"textDocument/didChange", {[](Server& server, const Json& params) {
         server.change(params);
         return Json(nullptr);
       }}},
      {"textDocument/didClose", {[](Server& server, const Json& params) {
         server.close(params);
         return Json(nullptr);
       }}},
      {"textDocument/didSave", {[](Server& server, const Json& params) {
         server.save(params);
         return Json(nullptr);
       }}},
      {"workspace/didChangeWatchedFiles", {[](Server& server, const Json&) {
         server.committed_.clear();
         server.workspace_.all_changed();
         return Json(nullptr);
       }}},
      {"workspace/didChangeConfiguration", {[](Server&, const Json&) { return Json(nullptr); }}},
      {"textDocument/hover", {[](Server& server, const Json& params) {
         return server.with_view(params, [&](const View& view) { return hover(view, position_in(params)); });
       }}},
      {"textDocument/inlayHint", {[](Server& server, const Json& params) {
         return server.with_view(params,
                                 [&](const View& view) { return inlay_hints(view, range_from(params.at("range"))); });
       }}},
      {"textDocument/completion", {[](Server& server, const Json& params) {
         return server.with_view(params, [&](const View& view) { return completion(view, position_in(params)); });
       }}},
      {"textDocument/definition", {[](Server& server, const Json& params) {
         return server.with_view(params, [&](const View& view) { return definition(view, position_in(params)); });
       }}},
      {"textDocument/references", {[](Server& server, const Json& params) {
         return server.with_view(params, [&](const View& view) {
           const bool with_declaration = params.value("/context/includeDeclaration"_json_pointer, true);
           return references(view, position_in(params), with_declaration);
         });
       }}},
      {"textDocument/documentSymbol",
       {[](Server& server, const Json& params) { return server.with_view(params, document_symbols); }}},
      {"textDocument/foldingRange",
       {[](Server& server, const Json& params) { return server.with_view(params, folding_ranges); }}},
      {"textDocument/formatting",
       {[](Server& server, const Json& params) { return server.with_view(params, formatting); }}},
      {"textDocument/codeLens", {[](Server& server, const Json& params) {
         const Committed cached = [&server](const std::string& path) -> std::shared_ptr<const LoadedDevice> {
           if (!server.hooks_.committed) return nullptr;
           const auto [at, is_new] = server.committed_.try_emplace(path);
           if (is_new) at->second = server.hooks_.committed(path);
           return at->second;
         };
         return server.with_view(params, [&](const View& view) { return code_lenses(view, cached); });
       }}},
      {"textDocument/codeAction", {[](Server& server, const Json& params) {
         return server.with_view(params, [&](const View& view) {
           return code_actions(view, range_from(params.at("range")), params.value("context", Json::object()),
                               server.resolves_actions_);
         });
       }}},
      {"codeAction/resolve", {[](Server& server, const Json& params) {
         const Json document{{"textDocument", {{"uri", params.at("data").at("uri")}}}};
         return server.with_view(document, [&](const View& view) { return resolved_action(view, params); });
       }}},
      {"textDocument/prepareRename", {[](Server& server, const Json& params) {
         return server.with_view(params, [&](const View& view) { return prepare_rename(view, position_in(params)); });
       }}},
      {"textDocument/rename", {[](Server& server, const Json& params) {
         return server.with_view(params, [&](const View& view) {
           return rename(view, position_in(params), params.at("newName").get<std::string>());
         });
       }}},
  };
  return all;
}

void Server::send(const Json& message) { hooks_.send(message.dump(-1, ' ', false, Json::error_handler_t::replace)); }

void Server::send_error(const Json& id, int code, const std::string& message) {
  send({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", message}}}});
}

void Server::receive(std::string_view message) {
  const Json parsed = Json::parse(message, nullptr, false);
  if (parsed.is_discarded()) {
    hooks_.log("a message is not JSON");
    return send_error(nullptr, parse_error, "the message is not JSON");
  }
  if (parsed.is_object() && !parsed.contains("method") && parsed.contains("id") &&
      (parsed.contains("result") || parsed.contains("error"))) {
    return;  // a response; this server sends no requests
  }
  if (!parsed.is_object() || !parsed.contains("method") || !parsed.at("method").is_string()) {
    hooks_.log("a message is not a request");
    return send_error(nullptr, invalid_request, "the message is not a request");
  }
  dispatch(parsed);
}

void Server::dispatch(const Json& message) {
  const auto& method = message.at("method").get_ref<const std::string&>();
  const bool is_request = message.contains("id");
  const Json id = is_request ? message.at("id") : Json(nullptr);
  const auto fail = [&](int code, const std::string& text) {
    if (code != request_failed && code != method_not_found) hooks_.log(fmt::format("{}: {}", method, text));
    if (is_request) send_error(id, code, text);
  };
  try {
    const Json params = message.value("params", Json::object());
    Json result = answer(method, params, is_request);
    if (is_request) send({{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}});
  } catch (const MethodNotFound& problem) {
    fail(method_not_found, problem.what());
  } catch (const NotInitialized& problem) {
    fail(server_not_initialized, problem.what());
  } catch (const InvalidRequest& problem) {
    fail(invalid_request, problem.what());
  } catch (const RequestFailed& problem) {
    fail(request_failed, problem.what());
  } catch (const Json::exception& problem) {
    fail(invalid_params, problem.what());
  } catch (const std::exception& problem) {
    fail(internal_error, problem.what());
  }
}

Json Server::answer(const std::string& method, const Json& params, bool is_request) {
  if (!is_initialized_ && method != "initialize" && method != "exit") {
    if (!is_request) return nullptr;
    throw NotInitialized{"the server is not initialized"};
  }
  if (was_shut_down_ && method != "exit") {
    if (!is_request) return nullptr;
    throw InvalidRequest{"the server was shut down"};
  }
  const auto found = methods().find(method);
  if (found == methods().end()) {
    if (!is_request) return nullptr;
    throw MethodNotFound{fmt::format("unknown method {}", method)};
  }
  return found->second.run(*this, params);
}

Json Server::initialize(const Json& params) {
  encoding_ = lists(params, "/capabilities/general/positionEncodings"_json_pointer, "utf-8") ? PositionEncoding::utf8
                                                                                             : PositionEncoding::utf16;
  resolves_actions_ =
      lists(params, "/capabilities/textDocument/codeAction/resolveSupport/properties"_json_pointer, "edit");
  is_initialized_ = true;
  return {{"capabilities", capabilities(encoding_)}, {"serverInfo", {{"name", "edsc"}, {"version", hooks_.version}}}};
}

void Server::open(const Json& params) {
  const Json& document = params.at("textDocument");
  workspace_.open(document.at("uri").get<std::string>(), document.value("version", std::int64_t{0}),
                  document.at("text").get<std::string>());
}

void Server::change(const Json& params) {
  Document* const document = workspace_.find(params.at("textDocument").at("uri").get<std::string>());
  if (document == nullptr) throw RequestFailed{"the document is not open"};
  std::string text = document->text;
  for (const Json& change : params.at("contentChanges")) {
    const auto& by = change.at("text").get_ref<const std::string&>();
    if (change.contains("range")) {
      replace_range(text, range_from(change.at("range")), by, encoding_);
    } else {
      text = by;
    }
  }
  document->text = std::move(text);
  document->version = params.at("textDocument").value("version", document->version);
  workspace_.changed(document->path);
}

void Server::close(const Json& params) { workspace_.close(params.at("textDocument").at("uri").get<std::string>()); }

void Server::save(const Json& params) {
  const Document* const document = workspace_.find(params.at("textDocument").at("uri").get<std::string>());
  if (document == nullptr) return;
  committed_.erase(document->path);
  workspace_.changed(document->path);
}

Json Server::with_view(const Json& params, const std::function<Json(const View&)>& use) {
  Document* const document = workspace_.find(params.at("textDocument").at("uri").get<std::string>());
  if (document == nullptr) return nullptr;
  const Analysis& analysis = workspace_.analyse(*document);
  return use(View{workspace_, *document, analysis, encoding_});
}

/// An open document has its own findings only, not those that other documents have in its file.
void Server::publish() {
  std::set<std::string> touched;
  const auto touch = [&](const Published& rows) {
    for (const auto& [uri, ignored] : rows) touched.insert(uri);
  };
  for (auto at = findings_.begin(); at != findings_.end();) {
    const bool is_open = workspace_.find(at->first) != nullptr;
    if (!is_open) {
      touch(at->second);
      touched.insert(at->first);
    }
    at = is_open ? std::next(at) : findings_.erase(at);
  }
  for (auto& [uri, document] : workspace_.documents()) {
    if (!document.is_unpublished) continue;
    document.is_unpublished = false;
    touch(findings_[uri]);
    touched.insert(uri);
    Published& rows = findings_[uri] = {};
    try {
      rows = diagnostics_of(workspace_.analyse(document), hooks_.url_of, encoding_);
    } catch (const std::exception& problem) {
      hooks_.log(fmt::format("{}: {}", uri, problem.what()));
    }
    // The client may spell its URI in another way.
    if (const auto own = rows.find(uri_of_file(document.path)); own != rows.end() && own->first != uri) {
      rows[uri] = std::move(own->second);
      rows.erase(uri_of_file(document.path));
    }
    touch(rows);
  }
  for (const std::string& uri : touched) {
    const Document* document = workspace_.find(uri);
    if (document == nullptr && workspace_.find_path(path_of_uri(uri)) != nullptr) continue;
    Json rows = Json::array();
    for (const auto& [owner, of_owner] : findings_) {
      const auto found = of_owner.find(uri);
      if (found == of_owner.end() || (document != nullptr && owner != uri)) continue;
      rows.insert(rows.end(), found->second.begin(), found->second.end());
    }
    Json params{{"uri", uri}, {"diagnostics", std::move(rows)}};
    if (document != nullptr) params["version"] = document->version;
    send({{"jsonrpc", "2.0"}, {"method", "textDocument/publishDiagnostics"}, {"params", std::move(params)}});
  }
}

}  // namespace edsc::lsp
