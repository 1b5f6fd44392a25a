#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <string>

namespace fiimap {

/// Progress on standard error, when that is a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::size_t total) : total_(total), visible_(isatty(STDERR_FILENO) != 0) {}
  ~ProgressBar() { end(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(std::size_t done) {
    const int percent = total_ == 0 ? 100 : static_cast<int>(100 * done / total_);
    if (!visible_ || percent == percent_) return;
    percent_ = percent;
    const std::string filled(percent * kWidth / 100, '#');
    std::fprintf(stderr, "\r[%-*s] %3d %%", kWidth, filled.c_str(), percent);
    std::fflush(stderr);
  }

  /// Ends the line; shows nothing any more.
  void end() {
    if (visible_) std::fputc('\n', stderr);
    visible_ = false;
  }

 private:
  static constexpr int kWidth = 50;

  std::size_t total_;
  bool visible_;
  int percent_ = -1;
};

}  // namespace fiimap
