// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/did_you_mean.hpp"

#include <algorithm>
#include <cctype>

namespace esfem {
namespace {

/// How many letters are left out, added, replaced or exchanged with their neighbours between two names.
int edit_distance(const std::string& a, const std::string& b) {
  const std::size_t m = a.size(), n = b.size();
  std::vector<std::vector<int>> d(m + 1, std::vector<int>(n + 1));  // of the first i and j letters
  for (std::size_t i = 0; i <= m; ++i)
    for (std::size_t j = 0; j <= n; ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = static_cast<int>(i + j);
        continue;
      }
      const int replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({replaced, d[i - 1][j] + 1, d[i][j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[m][n];
}

}  // namespace

std::string did_you_mean(const std::string& unknown, const std::vector<std::string>& known) {
  const auto lower = [](std::string name) {
    for (char& c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
    return name;
  };
  const std::size_t longest = 100;  // of a text that is a misspelt name
  if (unknown.size() > longest) return "";
  const int most = std::min(2, static_cast<int>(unknown.size()) / 2);
  int least = 2 * most + 1;
  std::string closest;
  for (const std::string& name : known) {
    const int distance = edit_distance(lower(unknown), lower(name));
    if (distance > most) continue;
    // Of names that are equally close, the one that only goes on: "steps" and not "stop" for "step".
    const int twice = 2 * distance - (lower(name).rfind(lower(unknown), 0) == 0 ? 1 : 0);
    if (twice == least) closest.clear();
    if (twice >= least) continue;
    least = twice;
    closest = name;
  }
  return closest.empty() ? "" : "; did you mean \"" + closest + "\"?";
}

}  // namespace esfem
