#include "fault_rig.h"

#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

#include <boost/make_shared.hpp>

#include "fiimap/ros/steady_time.h"

namespace fiimap {
namespace {

constexpr double kPoseDistance = 0.02;         // s between the poses around a scan
constexpr double kScanBeforePose = 0.01;       // s
constexpr double kFocalLength = 25.0;          // pixels
constexpr double kMillimetre = 0.001;          // m
constexpr std::chrono::milliseconds kPoll{1};  // of settle()
constexpr double kTimePerPoll = 0.01;          // s of simulated time
constexpr std::chrono::seconds kPatience{60};

/// The camera looks along the body's x axis.
geometry_msgs::TransformStamped cameraOnBody() {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "body";
  transform.child_frame_id = "camera";
  auto& q = transform.transform.rotation;
  q.x = q.z = -0.5;
  q.y = q.w = 0.5;
  return transform;
}

sensor_msgs::CameraInfo cameraInfo() {
  sensor_msgs::CameraInfo info;
  info.width = FaultRig::kWidth;
  info.height = FaultRig::kHeight;
  info.K = {kFocalLength, 0.0,          FaultRig::kWidth / 2.0,
            0.0,          kFocalLength, FaultRig::kHeight / 2.0,
            0.0,          0.0,          1.0};
  return info;
}

sensor_msgs::Image wallImage() {
  sensor_msgs::Image image;
  image.header.frame_id = "camera";
  image.encoding = "16UC1";
  image.width = FaultRig::kWidth;
  image.height = FaultRig::kHeight;
  image.step = FaultRig::kWidth * sizeof(std::uint16_t);
  image.data.resize(std::size_t{image.step} * image.height);
  const auto depth = static_cast<std::uint16_t>(FaultRig::kWall / kMillimetre);
  for (std::size_t i = 0; i < image.data.size(); i += sizeof(depth)) {
    std::memcpy(&image.data[i], &depth, sizeof(depth));
  }
  return image;
}

sensor_msgs::PointCloud2 wallCloud() {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = "lidar";
  cloud.point_step = 4 * sizeof(float);
  cloud.width = FaultRig::kWidth * FaultRig::kHeight;
  cloud.height = 1;
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.resize(cloud.row_step);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    sensor_msgs::PointField field;
    field.name = std::string("xyz").substr(axis, 1);
    field.offset = axis * sizeof(float);
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  for (int i = 0; i < FaultRig::kWidth * FaultRig::kHeight; ++i) {
    const float point[3] = {FaultRig::kWall, 0.05F * (i % FaultRig::kWidth - 16),
                            0.05F * (i / FaultRig::kWidth - 12)};
    std::memcpy(&cloud.data[static_cast<std::size_t>(i) * cloud.point_step], point, sizeof(point));
  }
  return cloud;
}

}  // namespace

MapperConfig FaultRig::mapperConfig() {
  MapperConfig config;
  config.map_size_x = config.map_size_y = 10.0;
  config.map_size_z = 6.0;
  config.pixel_step = 1;
  config.border_margin = 0;
  return config;
}

NodeConfig FaultRig::nodeConfig(RigInputs inputs) {
  NodeConfig config;
  config.max_pose_wait = 0.05;
  if (inputs == RigInputs::kPoints) {
    config.sensor = SensorKind::kPoints;
    config.extrinsics = ExtrinsicsSource::kParameter;
  }
  if (inputs == RigInputs::kTf) config.pose_source = PoseSource::kTf;
  return config;
}

FaultRig::FaultRig(RigInputs inputs, double clock) : inputs_(inputs), clock_(clock) {
  ros::Time::init();
  ros::Time::setNow(ros::Time(clock_));
  const bool from_tf = inputs == RigInputs::kTf;
  const bool points = inputs == RigInputs::kPoints;
  topics_.sensors = {{"", points ? "points" : "depth/image", points ? "" : "depth/camera_info"}};
  topics_.poses = from_tf ? "/tf" : "odom";
  handle_ = std::make_shared<MapHandle>("rig");
  MapObserver* const observer = this;
  mapping_ = std::make_unique<MappingThread>(mapperConfig(), nodeConfig(inputs), handle_, observer);
  mapping_->start();
  sendTransform(cameraOnBody(), true);
}

FaultRig::~FaultRig() {
  release();
  mapping_->stop();
}

ros::Time FaultRig::stampAt(double seconds) const { return ros::Time(1.6e9 + seconds); }

nav_msgs::Odometry FaultRig::poseAt(double seconds) const {
  nav_msgs::Odometry pose;
  pose.header.stamp = stampAt(seconds);
  pose.header.frame_id = "world";
  pose.child_frame_id = "body";
  pose.pose.pose.orientation.w = 1.0;
  return pose;
}

geometry_msgs::TransformStamped FaultRig::transformAt(double seconds) const {
  geometry_msgs::TransformStamped transform;
  transform.header = poseAt(seconds).header;
  transform.child_frame_id = "body";
  transform.transform.rotation.w = 1.0;
  return transform;
}

Frame FaultRig::next() {
  now_ += kPeriod;
  Frame frame;
  for (const double seconds : {now_ - kPoseDistance, now_}) {
    if (inputs_ == RigInputs::kTf) {
      frame.transforms.push_back(transformAt(seconds));
    } else {
      frame.poses.push_back(poseAt(seconds));
    }
  }
  const ros::Time stamp = stampAt(now_ - kScanBeforePose);
  if (inputs_ == RigInputs::kPoints) {
    frame.cloud = wallCloud();
    frame.cloud->header.stamp = stamp;
    return frame;
  }
  frame.info = cameraInfo();
  frame.image = wallImage();
  frame.info->header.stamp = frame.image->header.stamp = stamp;
  return frame;
}

void FaultRig::sendPose(const nav_msgs::Odometry& pose) {
  ++poses_;
  mapping_->post([pose](ScanSynchronizer* synchronizer) { synchronizer->add(pose); });
}

void FaultRig::sendTransform(const geometry_msgs::TransformStamped& transform, bool is_static) {
  poses_ += inputs_ == RigInputs::kTf && !is_static;
  tf2_msgs::TFMessage message;
  message.transforms.push_back(transform);
  mapping_->post([message, is_static](ScanSynchronizer* synchronizer) {
    synchronizer->addTf(message, is_static);
  });
}

void FaultRig::send(Frame frame) {
  for (const nav_msgs::Odometry& pose : frame.poses) sendPose(pose);
  for (const auto& transform : frame.transforms) sendTransform(transform);
  if (frame.info) {
    ++infos_;
    const auto info = boost::make_shared<const sensor_msgs::CameraInfo>(*frame.info);
    mapping_->post([info](ScanSynchronizer* synchronizer) { synchronizer->add(info); });
  }
  sent_ += frame.image.has_value() + frame.cloud.has_value();
  if (frame.image)
    mapping_->addScan(boost::make_shared<const sensor_msgs::Image>(std::move(*frame.image)));
  if (frame.cloud) {
    mapping_->addScan(boost::make_shared<const sensor_msgs::PointCloud2>(std::move(*frame.cloud)));
  }
}

void FaultRig::fly(int frames) {
  for (int i = 0; i < frames; ++i) {
    send(next());
    ++flown_;
    settle();
  }
}

void FaultRig::settle() {
  const SteadyTime end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end) {
    const ScanCounters counters = mapping_->counters();
    if (counters.received == sent_ && counters.waiting == 0) return;
    std::this_thread::sleep_for(kPoll);
    if (clock_is_given_) continue;
    clock_ += kTimePerPoll;
    ros::Time::setNow(ros::Time(clock_));
  }
  throw std::runtime_error("scans are still on their way");
}

void FaultRig::waitUntilReceived() const {
  const SteadyTime end = std::chrono::steady_clock::now() + kPatience;
  while (mapping_->counters().received != sent_) {
    if (std::chrono::steady_clock::now() > end) throw std::runtime_error("scans do not arrive");
    std::this_thread::sleep_for(kPoll);
  }
}

void FaultRig::moveClock(double seconds) {
  clock_is_given_ = true;
  clock_ += seconds;
  ros::Time::setNow(ros::Time(clock_));
}

void FaultRig::block() {
  const std::lock_guard<std::mutex> lock(mutex_);
  block_ = true;
}

void FaultRig::waitUntilBlocked() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, kPatience, [this] { return blocked_; });
}

void FaultRig::release() {
  const std::lock_guard<std::mutex> lock(mutex_);
  block_ = false;
  changed_.notify_all();
}

RigState FaultRig::state() const {
  RigState state;
  state.sent = sent_;
  state.totals.sensors = {{sent_, infos_}};
  state.totals.poses = poses_;
  state.totals.counters = mapping_->counters();
  state.snapshot = handle_->latest();
  const std::lock_guard<std::mutex> lock(mutex_);
  state.update = update_;
  return state;
}

std::vector<std::string> FaultRig::takeTexts() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(texts_, {});
}

void FaultRig::onUpdate(const MapUpdate& update) {
  std::unique_lock<std::mutex> lock(mutex_);
  update_ = update;
  blocked_ = block_;
  changed_.notify_all();
  changed_.wait(lock, [this] { return !block_; });
  blocked_ = false;
}

void FaultRig::onReset(const std::string& why) {
  addText("the map was forgotten: " + why);
  const std::lock_guard<std::mutex> lock(mutex_);
  update_.reset();
}

void FaultRig::onDrop(const Drop& drop) { addText(drop.text()); }

void FaultRig::onWarning(const std::string& text) { addText(text); }

void FaultRig::addText(const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  texts_.push_back(text);
}

}  // namespace fiimap
