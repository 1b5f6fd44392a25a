#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fiimap {

/// Which scans of a recording are held out to test the map that the others build.
class HeldOutSplit {
 public:
  /// Those whose index modulo `folds` is `fold`.
  /// \throws std::invalid_argument unless folds >= 2 and 0 <= fold < folds.
  static HeldOutSplit byFold(int fold, int folds);
  /// Every fold once, so that each scan is held out in one of them.
  /// \throws std::invalid_argument unless folds >= 2.
  static std::vector<HeldOutSplit> everyFold(int folds);
  /// Those that a file names: lines "INDEX build" or "INDEX test"; '#' begins a comment. Scans that
  /// it does not name build the map.
  /// \throws std::invalid_argument when the file cannot be read or holds anything else.
  static HeldOutSplit fromFile(const std::string& file);

  bool holdsOut(std::size_t index) const;
  /// In words, for reports.
  const std::string& text() const { return text_; }

 private:
  std::size_t fold_ = 0;
  std::size_t folds_ = 0;       // 0: the list counts
  std::vector<bool> held_out_;  // by index
  std::string text_;
};

}  // namespace fiimap
