/// The documents that an editor has opened, each with what edsc reads from it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/ini.hpp"
#include "load/load_device.hpp"
#include "lsp/text_position.hpp"
#include "network/network.hpp"

namespace edsc::lsp {

enum class DocumentKind : std::uint8_t {
  device,  ///< EDS or DCF
  overlay,
  xml,  ///< XDD or XDC: diagnostics only
  options,
  deviations,
  network,
  other,  ///< JSON that edsc does not read
};

/// What edsc reads from one version of a document. Positions point to files that it keeps.
struct Analysis {
  std::shared_ptr<const SourceFile> own;  ///< the text of the document
  IniFile ini;                            ///< of `own`, if it is an EDS, a DCF or an overlay
  std::unique_ptr<LoadedDevice> loaded;   ///< null for a document that is not a device
  std::unique_ptr<LoadedNetwork> network;
  std::vector<std::string> inputs;  ///< paths of all files that were read
  Diagnostics diagnostics;

  [[nodiscard]] const Device* device() const { return loaded && loaded->device ? &*loaded->device : nullptr; }
};

struct Document {
  std::string uri;
  std::string path;
  std::int64_t version = 0;
  DocumentKind kind = DocumentKind::other;
  std::string text;
  bool is_dirty = true;        ///< what edsc has read is older than the text, or than another file
  bool is_unpublished = true;  ///< the editor does not have the findings of this text
  std::unique_ptr<Analysis> analysis;
  std::unique_ptr<Analysis> last_network;  ///< the last version of a network file that was JSON
};

/// Reports the findings of a file of deviations.
using CheckDeviations = std::function<void(const SourceFile& source, Diagnostics& diagnostics)>;

/// A case of `edsc conform`, which a file of deviations names.
struct ConformanceCase {
  std::string id;  ///< `2.5`
  std::string title;
};

class Workspace {
 public:
  Workspace(CheckDeviations check_deviations, std::vector<ConformanceCase> cases)
      : check_deviations_{std::move(check_deviations)}, conformance_cases_{std::move(cases)} {}

  [[nodiscard]] const std::vector<ConformanceCase>& conformance_cases() const { return conformance_cases_; }

  void open(const std::string& uri, std::int64_t version, std::string text);
  void close(const std::string& uri);
  /// Null if it is not open.
  [[nodiscard]] Document* find(std::string_view uri);
  [[nodiscard]] Document* find_path(std::string_view path);
  [[nodiscard]] std::map<std::string, Document, std::less<>>& documents() { return documents_; }

  /// The documents that read this file must be read again.
  void changed(const std::string& path);
  void all_changed();

  /// What edsc reads from the current text.
  Analysis& analyse(Document& document);

 private:
  [[nodiscard]] ReadBase reader();
  [[nodiscard]] std::unique_ptr<SourceFile> read(const std::string& path, const ReadingChoices& choices,
                                                 std::string& error);
  void analyse_device(Document& document, Analysis& analysis);
  void analyse_options(const Document& document, Analysis& analysis);
  void analyse_network(const Document& document, Analysis& analysis);

  CheckDeviations check_deviations_;
  std::vector<ConformanceCase> conformance_cases_;
  std::map<std::string, Document, std::less<>> documents_;  ///< by URI
};

[[nodiscard]] DocumentKind kind_of(std::string_view path, std::string_view text);

/// The file of a position, and its place there: that of an overlay or base for a composed text.
[[nodiscard]] Json location_of(const Position& position, PositionEncoding encoding);

}  // namespace edsc::lsp
