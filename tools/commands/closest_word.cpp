#include "tools/commands/closest_word.h"

#include <algorithm>
#include <vector>

namespace ossa::commands {
namespace {

// Optimal string alignment (Boytsov 2011, section 2.1): insertions, deletions, changes, swaps.
size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (size_t k = 0; k <= b.size(); ++k) d[0][k] = k;
  for (size_t i = 1; i <= a.size(); ++i) {
    for (size_t k = 1; k <= b.size(); ++k) {
      const size_t change = a[i - 1] == b[k - 1] ? 0 : 1;
      d[i][k] = std::min({d[i - 1][k] + 1, d[i][k - 1] + 1, d[i - 1][k - 1] + change});
      if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1]) {
        d[i][k] = std::min(d[i][k], d[i - 2][k - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string ClosestWord(std::string_view typed, std::span<const std::string> words) {
  constexpr size_t kLongest = 64;  // characters; by hand: twice the longest word to match
  if (typed.size() < 2 || typed.size() > kLongest) return {};
  std::string best;
  size_t fewest =
      1 + std::max<size_t>(
              1, typed.size() / 3);  // by hand: at most a third of the characters may differ
  for (const std::string& word : words) {
    const size_t edits = EditDistance(typed, word);
    if (edits >= fewest) continue;
    fewest = edits;
    best = word;
  }
  if (!best.empty()) return best;
  const auto begins = [&](const std::string& word) { return word.starts_with(typed); };
  if (std::count_if(words.begin(), words.end(), begins) != 1) return {};
  return *std::find_if(words.begin(), words.end(), begins);
}

}  // namespace ossa::commands
