#include "doctor/frame_graph.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <exception>
#include <stdexcept>

#include "fiimap/ros/frame_id.h"
#include "fiimap/ros/pose_history.h"

namespace fiimap {
namespace {

constexpr bool kStatic = true;

}  // namespace

FrameGraph::FrameGraph(const Observation& observation) {
  for (const auto& received : observation.tf_static) {
    for (const auto& transform : received.message->transforms) add(transform, kStatic, received);
  }
  for (const auto& received : observation.tf) {
    for (const auto& transform : received.message->transforms) add(transform, !kStatic, received);
  }
}

void FrameGraph::add(const geometry_msgs::TransformStamped& message, bool is_static,
                     const Received<tf2_msgs::TFMessage>& from) {
  const std::string parent = plainFrame(message.header.frame_id);
  const std::string child = plainFrame(message.child_frame_id);
  try {
    if (parent.empty() || child.empty() || parent == child) {
      throw std::invalid_argument("parent and child must be two frames");
    }
    links_[child] = {parent, decodeTransform(message.transform)};
  } catch (const std::exception& error) {
    ++bad_;
    bad_example_ = "'" + parent + "' -> '" + child + "': " + error.what();
    return;
  }
  if (is_static) return;
  messages_[child].push_back(
      {boost::make_shared<geometry_msgs::TransformStamped>(message), from.time, from.order});
}

bool FrameGraph::contains(const std::string& frame) const {
  return std::any_of(links_.begin(), links_.end(), [&frame](const auto& link) {
    return link.first == frame || link.second.parent == frame;
  });
}

std::vector<std::string> FrameGraph::chainToRoot(const std::string& frame) const {
  std::vector<std::string> chain = {frame};
  // Never longer than the links: two publishers may have made a ring.
  while (chain.size() <= links_.size()) {
    const auto link = links_.find(chain.back());
    if (link == links_.end()) break;
    chain.push_back(link->second.parent);
  }
  return chain;
}

bool FrameGraph::areConnected(const std::string& a, const std::string& b) const {
  return contains(a) && contains(b) && chainToRoot(a).back() == chainToRoot(b).back();
}

std::vector<std::string> FrameGraph::childrenOf(const std::string& frame) const {
  std::vector<std::string> children;
  for (const auto& [child, link] : links_) {
    if (link.parent == frame) children.push_back(child);
  }
  return children;
}

Eigen::Isometry3d FrameGraph::toRoot(const std::string& frame) const {
  Eigen::Isometry3d T_root_frame = Eigen::Isometry3d::Identity();
  for (const std::string& child : chainToRoot(frame)) {
    const auto link = links_.find(child);
    if (link != links_.end()) T_root_frame = link->second.T_parent_child * T_root_frame;
  }
  return T_root_frame;
}

std::optional<Eigen::Isometry3d> FrameGraph::transform(const std::string& target,
                                                       const std::string& source) const {
  if (target == source) return Eigen::Isometry3d::Identity();
  if (!areConnected(target, source)) return std::nullopt;
  return toRoot(target).inverse() * toRoot(source);
}

bool FrameGraph::moves(const std::string& child) const {
  const auto link = messages_.find(child);
  if (link == messages_.end()) return false;
  const auto& messages = link->second;
  const Eigen::Matrix4d first = decodeTransform(messages.front().message->transform).matrix();
  return std::any_of(messages.begin(), messages.end(), [&first](const auto& received) {
    return decodeTransform(received.message->transform).matrix() != first;
  });
}

std::vector<Received<geometry_msgs::TransformStamped>> FrameGraph::linkAbove(
    const std::string& child) const {
  const auto link = messages_.find(child);
  return link == messages_.end() ? std::vector<Received<geometry_msgs::TransformStamped>>()
                                 : link->second;
}

std::string FrameGraph::text() const {
  std::string text;
  for (const auto& [child, link] : links_) {
    text += (text.empty() ? "" : ", ") + link.parent + " -> " + child;
  }
  return text;
}

}  // namespace fiimap
