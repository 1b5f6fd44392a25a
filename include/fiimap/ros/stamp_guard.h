#pragma once

#include <ros/time.h>

#include <string>

#include "fiimap/ros/drop_reason.h"

namespace fiimap {

/// What the stamp of a message says, seen from those before it on the same topic.
enum class StampVerdict {
  kGood,      ///< in order, or late by no more than StampGuard::kJump
  kDoubtful,  ///< far from all before it: wait for what the next message says
  kLeap,      ///< time went on further ahead: the doubtful message before it was right
  kJumpBack,  ///< time began again: the doubtful message before it was right
};

/// Tells a single wrong stamp from time that really jumped: one stamp that is far from those before
/// it is doubtful, a second one in a row is believed. Not thread-safe.
class StampGuard {
 public:
  static constexpr double kJump = 1.0;  ///< s; what is nearer is in order or late

  /// Judges a stamp and remembers it. After kJumpBack clear() must follow.
  /// \param other newest good stamp of other topics, zero when there is none: near or before it no
  /// stamp is too far ahead; far ahead of it even the first is doubtful.
  StampVerdict judge(const ros::Time& stamp, const ros::Time& other);
  /// Forgets all stamps.
  void clear();

  /// Newest good stamp; zero when there is none.
  const ros::Time& newest() const { return newest_; }

 private:
  ros::Time newest_;
  ros::Time doubtful_;
};

/// Of a message with a single wrong stamp. \param newest good stamp before it.
Drop strayStamp(const std::string& what, const ros::Time& newest, const ros::Time& stamp);

}  // namespace fiimap
