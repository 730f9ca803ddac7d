/// Columns of text.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "text/printable.hpp"
#include "text/utf8.hpp"

namespace edsc {

/// Rows of cells; each column is as wide as its widest cell, with two blanks between columns and none at the end of a
/// line. The first columns are aligned to the left, those after them to the right. Cells are made printable. Width is
/// counted in code points of UTF-8.
class TextTable {
 public:
  explicit TextTable(std::size_t left_columns = std::numeric_limits<std::size_t>::max())
      : left_columns_{left_columns} {}

  void add(std::vector<std::string> row) {
    for (std::string& cell : row) cell = printable(cell);
    rows_.push_back(std::move(row));
  }

  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::size_t> widths;
    for (const auto& row : rows_) {
      widths.resize(std::max(widths.size(), row.size()), 0);
      for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], count_code_points(row[i]));
    }
    std::vector<std::string> lines;
    for (const auto& row : rows_) {
      std::string line;
      for (std::size_t i = 0; i < row.size(); ++i) {
        const std::string padding(widths[i] - count_code_points(row[i]), ' ');
        line += i < left_columns_ ? row[i] + padding : padding + row[i];
        line += "  ";
      }
      line.erase(line.find_last_not_of(' ') + 1);
      lines.push_back(std::move(line));
    }
    return lines;
  }

 private:
  std::size_t left_columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace edsc
