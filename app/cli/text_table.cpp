#include "app/cli/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace atomesh::cli {

namespace {

// Width on a terminal: UTF-8 continuation bytes take no room.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& cell, std::size_t to, bool right) {
  const std::string blanks(to - std::min(to, width(cell)), ' ');
  return right ? blanks + cell : cell + blanks;
}

}  // namespace

std::vector<bool> TextTable::numeric_columns() const {
  std::vector<bool> numeric(headings_.size(), !rows_.empty());
  for (const auto& row : rows_) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (row[c].find_first_not_of("0123456789.,+-×% ") != std::string::npos) numeric[c] = false;
    }
  }
  return numeric;
}

std::string TextTable::text() const {
  std::vector<std::size_t> widths;
  for (const std::string& heading : headings_) widths.push_back(width(heading));
  for (const auto& row : rows_) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width(row[c]));
  }
  const std::vector<bool> numeric = numeric_columns();
  std::string out;
  const auto append = [&](const std::vector<std::string>& cells) {
    std::string line;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (c > 0) line += "  ";
      line += padded(cells[c], widths[c], numeric[c]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + '\n';
  };
  append(headings_);
  for (const auto& row : rows_) append(row);
  return out;
}

std::string TextTable::markdown() const {
  const std::vector<bool> numeric = numeric_columns();
  std::string out = fmt::format("| {} |\n|", fmt::join(headings_, " | "));
  for (std::size_t c = 0; c < headings_.size(); ++c) out += numeric[c] ? " ---: |" : " --- |";
  out += '\n';
  for (const auto& row : rows_) out += fmt::format("| {} |\n", fmt::join(row, " | "));
  return out;
}

std::string TextTable::csv() const {
  std::string out;
  const auto append = [&](const std::vector<std::string>& cells) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (c > 0) out += ',';
      if (cells[c].find_first_of(",\"\r\n") == std::string::npos) {
        out += cells[c];
        continue;
      }
      out += '"';
      for (const char letter : cells[c]) {
        if (letter == '"') out += '"';
        out += letter;
      }
      out += '"';
    }
    out += '\n';
  };
  append(headings_);
  for (const auto& row : rows_) append(row);
  return out;
}

std::string grouped(std::uint64_t count) {
  const std::string digits = std::to_string(count);
  std::string out;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) out += ',';
    out += digits[i];
  }
  return out;
}

std::string milliseconds(double ms) {
  if (ms >= 99.95) return grouped(static_cast<std::uint64_t>(std::llround(ms)));
  return ms >= 9.995 ? fmt::format("{:.1f}", ms) : fmt::format("{:.2f}", ms);
}

std::string byte_size(std::uint64_t bytes) {
  const double size = static_cast<double>(bytes);
  if (size >= 1e9) return fmt::format("{:.2f} GB", size * 1e-9);
  if (size >= 1e6) return fmt::format("{:.1f} MB", size * 1e-6);
  if (size >= 1e3) return fmt::format("{:.1f} kB", size * 1e-3);
  return fmt::format("{} bytes", bytes);
}

}  // namespace atomesh::cli
