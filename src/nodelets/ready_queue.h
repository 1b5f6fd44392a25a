#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "fiimap/ros/scan_listener.h"

namespace fiimap {

/// Scans that wait for the map, of each sensor the newest few. They go in the order in which they
/// came as long as the map keeps up; when scans have to give way, sensors take turns until none
/// waits any more: a sensor of few scans gets each of its turns, however many the others send. Not
/// thread-safe.
class ReadyQueue {
 public:
  /// \param max_scans of each sensor.
  ReadyQueue(std::size_t max_scans, std::size_t sensors) : max_(max_scans), lines_(sensors) {}

  /// \return whether the oldest scan of the same sensor gave way to it.
  bool push(SynchronizedScan scan);
  /// The scan whose turn it is; there must be one.
  SynchronizedScan pop();

  bool empty() const;
  /// Scans of a sensor.
  std::size_t size(std::size_t sensor) const { return lines_.at(sensor).scans.size(); }

 private:
  struct Waiting {
    SynchronizedScan scan;
    std::int64_t number;  // of the push that brought it
  };
  struct Line {
    std::deque<Waiting> scans;
    std::int64_t last_turn = 0;  // number of the pop that took from it
  };

  std::size_t max_;
  std::vector<Line> lines_;  // by sensor
  std::int64_t pushes_ = 0;
  std::int64_t turns_ = 0;
  bool overloaded_ = false;  // a scan gave way since the queue was empty
};

}  // namespace fiimap
