#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "doctor/observation.h"

namespace fiimap {

/// Which frames TF connects, and how they lay to each other last. Frames are without a leading '/'.
class FrameGraph {
 public:
  explicit FrameGraph(const Observation& observation);

  bool contains(const std::string& frame) const;
  /// A frame and those above it, up to the root.
  std::vector<std::string> chainToRoot(const std::string& frame) const;
  bool areConnected(const std::string& a, const std::string& b) const;
  /// Frames right below one.
  std::vector<std::string> childrenOf(const std::string& frame) const;
  /// Newest transform that takes points from `source` to `target`; nothing where there is none.
  std::optional<Eigen::Isometry3d> transform(const std::string& target,
                                             const std::string& source) const;

  /// Whether the link above a frame moved.
  bool moves(const std::string& child) const;
  /// When the link above a frame was stamped and received, in the order of arrival; none of static
  /// links.
  std::vector<Received<geometry_msgs::TransformStamped>> linkAbove(const std::string& child) const;

  /// Transforms that cannot be used: not finite, or no rotation.
  std::size_t bad() const { return bad_; }
  /// Of the newest of them: the frames and what is wrong.
  const std::string& badExample() const { return bad_example_; }
  bool empty() const { return links_.empty(); }
  /// All frames that have a parent, with it: "a -> b, c -> d".
  std::string text() const;

 private:
  struct Link {
    std::string parent;
    Eigen::Isometry3d T_parent_child;  // newest
  };

  void add(const geometry_msgs::TransformStamped& message, bool is_static,
           const Received<tf2_msgs::TFMessage>& from);

  Eigen::Isometry3d toRoot(const std::string& frame) const;

  std::map<std::string, Link> links_;                          // by child
  ReceivedByTopic<geometry_msgs::TransformStamped> messages_;  // by child, of /tf
  std::size_t bad_ = 0;
  std::string bad_example_;
};

}  // namespace fiimap
