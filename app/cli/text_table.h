// Rows and columns for a person (aligned text, Markdown) or a spreadsheet (CSV).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace atomesh::cli {

class TextTable {
 public:
  explicit TextTable(std::vector<std::string> headings) : headings_(std::move(headings)) {}
  void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  bool empty() const { return rows_.empty(); }
  const std::vector<std::string>& headings() const { return headings_; }
  const std::vector<std::vector<std::string>>& rows() const { return rows_; }
  // Which columns hold numbers alone.
  std::vector<bool> numeric_columns() const;

  // Columns padded to their widest cell, numbers to the right, two blanks between.
  std::string text() const;
  std::string markdown() const;
  // RFC 4180: cells with a comma, a quote or a line break are quoted.
  std::string csv() const;

 private:
  std::vector<std::string> headings_;
  std::vector<std::vector<std::string>> rows_;
};

// 1234567 → "1,234,567".
std::string grouped(std::uint64_t count);
// Milliseconds with about three significant digits: "0.42", "8.31", "1,234".
std::string milliseconds(double ms);
// 1536 → "1.5 kB"; decimal prefixes.
std::string byte_size(std::uint64_t bytes);

}  // namespace atomesh::cli
