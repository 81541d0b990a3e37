// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/series_lines.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "solver/error.hpp"

namespace esfem {

bool is_csv(const std::string& file) {
  return std::filesystem::path(file).extension() == ".csv";
}

std::string csv_lines(const Series& series, std::size_t first) {
  std::vector<const Series::value_type*> columns = {&*series.find("t")};
  for (const auto& column : series)
    if (column.first != "t") columns.push_back(&column);
  const auto line = [&](const auto& entry) {
    std::string text;
    for (const auto* column : columns) text += (text.empty() ? "" : ",") + entry(*column);
    return text + "\n";
  };
  std::string lines;
  if (first == 0) lines = line([](const auto& column) { return column.first; });
  for (std::size_t i = first; i < series.at("t").size(); ++i)
    lines += line([&](const auto& column) { return format("%.17g", column.second[i]); });
  return lines;
}

void SeriesLines::append(const Series& series) {
  errno = 0;
  if (written_ == 0) stream_.open(file_, std::ios::trunc);
  stream_ << csv_lines(series, written_) << std::flush;
  if (!stream_) throw InputError(file_ + ": cannot be written: " + std::strerror(errno));
  written_ = series.at("t").size();
}

}  // namespace esfem
