#include "held_out_split.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace fiimap {

HeldOutSplit HeldOutSplit::byFold(int fold, int folds) {
  if (folds < 2) throw std::invalid_argument("--folds must be at least 2");
  if (fold < 0 || fold >= folds) {
    throw std::invalid_argument("--fold must be in [0, " + std::to_string(folds - 1) + "]");
  }
  HeldOutSplit split;
  split.fold_ = fold;
  split.folds_ = folds;
  split.text_ = "index % " + std::to_string(folds) + " == " + std::to_string(fold);
  return split;
}

std::vector<HeldOutSplit> HeldOutSplit::everyFold(int folds) {
  std::vector<HeldOutSplit> splits = {byFold(0, folds)};
  for (int fold = 1; fold < folds; ++fold) splits.push_back(byFold(fold, folds));
  return splits;
}

HeldOutSplit HeldOutSplit::fromFile(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw std::invalid_argument("cannot read " + file);
  HeldOutSplit split;
  split.text_ = file;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string index, use, rest;
    if (!(words >> index)) continue;
    constexpr std::size_t kMostDigits = 9;
    const bool is_number =
        index.find_first_not_of("0123456789") == std::string::npos && index.size() <= kMostDigits;
    if (!is_number || !(words >> use) || (use != "build" && use != "test") || words >> rest) {
      throw std::invalid_argument(file + ": not \"INDEX build\" or \"INDEX test\": " + line);
    }
    const std::size_t i = std::stoul(index);
    if (i >= split.held_out_.size()) split.held_out_.resize(i + 1, false);
    split.held_out_[i] = use == "test";
  }
  return split;
}

bool HeldOutSplit::holdsOut(std::size_t index) const {
  if (folds_ > 0) return index % folds_ == fold_;
  return index < held_out_.size() && held_out_[index];
}

}  // namespace fiimap
