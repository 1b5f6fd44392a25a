#include "fiimap/ros/transform_tree.h"

#include <tf2/exceptions.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/frame_id.h"
#include "fiimap/ros/stamps.h"

namespace fiimap {
namespace {

const char* const kAuthority = "tf";

}  // namespace

TransformTree::TransformTree(double history) : history_(history), buffer_(ros::Duration(history)) {}

void TransformTree::add(const geometry_msgs::TransformStamped& message, bool is_static) {
  geometry_msgs::TransformStamped transform = message;
  transform.header.frame_id = plainFrame(message.header.frame_id);
  transform.child_frame_id = plainFrame(message.child_frame_id);
  const std::string& child = transform.child_frame_id;
  // What tf2 would refuse with a message on the console.
  if (child.empty() || transform.header.frame_id.empty()) return;
  if (child == transform.header.frame_id) return;
  try {
    decodeTransform(transform.transform);
  } catch (const InputError&) {
    return;
  }
  if (!is_static) {
    const ros::Time& stamp = transform.header.stamp;
    std::set<ros::Time>& stamps = stamps_[child];
    const bool too_old = !stamps.empty() && secondsBetween(stamp, *stamps.rbegin()) > history_;
    if (too_old || !stamps.insert(stamp).second) return;
    while (secondsBetween(*stamps.begin(), *stamps.rbegin()) > history_) {
      stamps.erase(stamps.begin());
    }
  }
  buffer_.setTransform(transform, kAuthority, is_static);
}

void TransformTree::clear() {
  buffer_.clear();
  stamps_.clear();
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
    found.lookup = PoseLookup::kFound;
  } catch (const tf2::TransformException& error) {
    found.why = error.what();
    const bool connected = !newest.isZero();
    found.lookup = connected && stamp < newest ? PoseLookup::kTooOld : PoseLookup::kNotYet;
    return found;
  }
  found.gap = largestGap(target, source, stamp);
  if (found.gap > max_gap) {
    found.lookup = PoseLookup::kGap;
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
  const auto link = stamps_.find(child);
  if (link == stamps_.end()) return 0.0;
  const std::set<ros::Time>& stamps = link->second;
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
