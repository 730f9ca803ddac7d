/// An options file that is read from a text.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "backend/cpp/identifier.hpp"
#include "backend/cpp/views.hpp"
#include "device/options/options.hpp"
#include "diagnostics/diagnostics.hpp"
#include "text/source_file.hpp"

namespace edsc {

struct ReadOptions {
  /// Members of canopen::DeviceOptions and their values in C++.
  using Runtime = std::vector<std::pair<std::string, std::string>>;

  explicit ReadOptions(std::string text)
      : source("test.options.json", std::move(text)), options(read_options(source, is_identifier, diagnostics)) {}

  [[nodiscard]] Runtime runtime() const {
    Runtime found;
    for (const auto& row : options_view({}, options).runtime) {
      found.emplace_back(row["name"].get<std::string>(), row["value"].get<std::string>());
    }
    return found;
  }

  SourceFile source;
  Diagnostics diagnostics;
  Options options;
};

}  // namespace edsc
