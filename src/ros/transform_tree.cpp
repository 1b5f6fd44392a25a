#include "fiimap/ros/transform_tree.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <utility>
#include <vector>

#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/frame_id.h"
#include "fiimap/ros/stamps.h"

namespace fiimap {
namespace {

const char* const kAuthority = "tf";

/// tf2's texts end with a full stop and a blank, which do not fit into a sentence.
std::string withoutEnd(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text;
}

}  // namespace

TransformTree::TransformTree(double history) : history_(history), buffer_(ros::Duration(history)) {}

void TransformTree::add(const geometry_msgs::TransformStamped& message, bool is_static,
                        const ros::Time& other) {
  geometry_msgs::TransformStamped transform = message;
  transform.header.frame_id = plainFrame(message.header.frame_id);
  transform.child_frame_id = plainFrame(message.child_frame_id);
  // What tf2 would refuse with a message on the console.
  const std::string& child = transform.child_frame_id;
  const std::string& parent = transform.header.frame_id;
  if (child.empty() || parent.empty() || child == parent) {
    ++refused_;
    return;
  }
  try {
    const Eigen::Quaterniond rotation(decodeTransform(transform.transform).linear());
    transform.transform.rotation.x = rotation.x();
    transform.transform.rotation.y = rotation.y();
    transform.transform.rotation.z = rotation.z();
    transform.transform.rotation.w = rotation.w();
    if (is_static) {
      buffer_.setTransform(transform, kAuthority, is_static);
    } else {
      addMoving(transform, other);
    }
  } catch (const std::exception&) {
    ++refused_;  // not finite, not a rotation, or a stamp beyond ros::Time
  }
}

void TransformTree::addMoving(const geometry_msgs::TransformStamped& transform,
                              const ros::Time& other) {
  const ros::Time& stamp = transform.header.stamp;
  Link& link = links_[transform.child_frame_id];
  const StampVerdict verdict = link.guard.judge(stamp, std::max(newest_, other));
  const auto doubtful = std::exchange(link.doubtful, std::nullopt);
  switch (verdict) {
    case StampVerdict::kDoubtful:
      if (doubtful) ++refused_;
      link.doubtful = transform;
      return;
    case StampVerdict::kJumpBack:
      link.guard.clear();
      // Beyond the history tf2 would refuse it: time began again, or what came before was wrong.
      if (!link.stamps.empty() && secondsBetween(stamp, *link.stamps.rbegin()) > history_) clear();
      if (doubtful) addMoving(*doubtful, other);
      addMoving(transform, other);
      return;
    case StampVerdict::kLeap:
      if (doubtful) insert(*doubtful);
      break;
    case StampVerdict::kGood:
      if (doubtful) ++refused_;
  }
  insert(transform);
}

void TransformTree::insert(const geometry_msgs::TransformStamped& transform) {
  const ros::Time& stamp = transform.header.stamp;
  std::set<ros::Time>& stamps = links_[transform.child_frame_id].stamps;
  if (!stamps.empty() && secondsBetween(stamp, *stamps.rbegin()) > history_) {
    ++refused_;
    return;
  }
  if (!stamps.insert(stamp).second) return;
  while (secondsBetween(*stamps.begin(), *stamps.rbegin()) > history_) {
    stamps.erase(stamps.begin());
  }
  newest_ = std::max(newest_, stamp);
  const bool is_static = false;
  buffer_.setTransform(transform, kAuthority, is_static);
}

void TransformTree::clear() {
  buffer_.clear();
  links_.clear();
  newest_ = ros::Time();
}

TransformAtStamp TransformTree::at(const std::string& target, const std::string& source,
                                   const ros::Time& stamp, double max_gap) const {
  TransformAtStamp found;
  if (target == source) {
    found.lookup = PoseLookup::kFound;
    return found;
  }
  ros::Time newest;
  try {
    newest = buffer_.lookupTransform(target, source, ros::Time()).header.stamp;
    found.T_target_source =
        decodeTransform(buffer_.lookupTransform(target, source, stamp).transform);
    found.gap = largestGap(target, source, stamp);
  } catch (const std::exception& error) {
    const bool connected = !newest.isZero();
    found.lookup = connected && stamp < newest ? PoseLookup::kTooOld : PoseLookup::kNotYet;
    found.why = withoutEnd(error.what());
    return found;
  }
  found.lookup = found.gap > max_gap ? PoseLookup::kGap : PoseLookup::kFound;
  if (found.lookup == PoseLookup::kGap) {
    found.why = "transforms from " + source + " to " + target + " are " +
                std::to_string(found.gap) + " s apart";
  }
  return found;
}

double TransformTree::largestGap(const std::string& target, const std::string& source,
                                 const ros::Time& stamp) const {
  std::vector<std::string> chain;
  buffer_._chainAsVector(target, stamp, source, stamp, source, chain);
  double largest = 0.0;
  for (const std::string& child : chain) {
    std::string parent;
    // The top of the chain may have a parent too, which does not matter here.
    const bool is_link = buffer_._getParent(child, stamp, parent) &&
                         std::find(chain.begin(), chain.end(), parent) != chain.end();
    if (is_link) largest = std::max(largest, gapOfLink(parent, child, stamp));
  }
  return largest;
}

double TransformTree::gapOfLink(const std::string& parent, const std::string& child,
                                const ros::Time& stamp) const {
  const auto link = links_.find(child);
  if (link == links_.end()) return 0.0;
  const std::set<ros::Time>& stamps = link->second.stamps;
  const auto after = stamps.lower_bound(stamp);
  if (after == stamps.end() || after == stamps.begin() || *after == stamp) return 0.0;
  const auto before = std::prev(after);
  const Eigen::Isometry3d T0 =
      decodeTransform(buffer_.lookupTransform(parent, child, *before).transform);
  const Eigen::Isometry3d T1 =
      decodeTransform(buffer_.lookupTransform(parent, child, *after).transform);
  // A fixed link that is repeated now and then is as good as a static one.
  return T0.matrix() == T1.matrix() ? 0.0 : secondsBetween(*before, *after);
}

}  // namespace fiimap
