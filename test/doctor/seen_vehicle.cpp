#include "seen_vehicle.h"

#include <boost/make_shared.hpp>
#include <cstring>
#include <map>

#include "doctor/mount.h"

namespace fiimap {
namespace {

constexpr std::uint32_t kStart = 1600000000;        // s
constexpr std::uint32_t kWidth = 80, kHeight = 60;  // pixels
constexpr double kWall = 3.0;                       // m
constexpr double kSpeed = 1.0;                      // m/s

ros::Time at(double seconds) { return ros::Time(kStart) + ros::Duration(seconds); }

/// By the time of arrival.
using Arrivals = std::multimap<ros::Time, std::function<void(Observation*)>>;

template <typename Message>
void arrive(const std::string& topic, const Message& message, const ros::Time& time,
            Arrivals* arrivals) {
  const boost::shared_ptr<const Message> shared = boost::make_shared<Message>(message);
  arrivals->emplace(time, [=](Observation* seen) { observe(topic, shared, time, seen); });
}

}  // namespace

SeenVehicle::SeenVehicle()
    : static_transforms({transformOf("base_link", "camera_optical", opticalRotation())}) {}

geometry_msgs::TransformStamped transformOf(const std::string& parent, const std::string& child,
                                            const Eigen::Quaterniond& rotation,
                                            const Eigen::Vector3d& translation) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.header.stamp = at(0.0);
  transform.child_frame_id = child;
  transform.transform.translation.x = translation.x();
  transform.transform.translation.y = translation.y();
  transform.transform.translation.z = translation.z();
  transform.transform.rotation.x = rotation.x();
  transform.transform.rotation.y = rotation.y();
  transform.transform.rotation.z = rotation.z();
  transform.transform.rotation.w = rotation.w();
  return transform;
}

void fillImage(double value, const std::string& encoding, sensor_msgs::Image* image) {
  const bool is_float = encoding == "32FC1";
  const std::size_t bytes = is_float ? sizeof(float) : sizeof(std::uint16_t);
  image->encoding = encoding;
  image->step = static_cast<std::uint32_t>(image->width * bytes);
  image->data.resize(image->step * image->height);
  const auto as_float = static_cast<float>(value);
  const auto as_integer = is_float ? std::uint16_t{0} : static_cast<std::uint16_t>(value);
  for (std::size_t i = 0; i < image->data.size(); i += bytes) {
    std::memcpy(&image->data[i], is_float ? static_cast<const void*>(&as_float) : &as_integer,
                bytes);
  }
}

void fillCloud(const std::vector<Eigen::Vector3f>& points, sensor_msgs::PointCloud2* cloud) {
  cloud->fields.clear();
  for (const char* name : {"x", "y", "z"}) {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(cloud->fields.size() * sizeof(float));
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    cloud->fields.push_back(field);
  }
  cloud->height = 1;
  cloud->width = static_cast<std::uint32_t>(points.size());
  cloud->point_step = 3 * sizeof(float);
  cloud->row_step = cloud->point_step * cloud->width;
  cloud->data.resize(cloud->row_step);
  if (!points.empty()) std::memcpy(cloud->data.data(), points.data(), cloud->data.size());
}

Observation SeenVehicle::observation() const {
  Arrivals arrivals;
  for (const geometry_msgs::TransformStamped& transform : static_transforms) {
    tf2_msgs::TFMessage message;
    message.transforms.push_back(transform);
    arrive("/tf_static", message, at(-1.0), &arrivals);
  }
  for (int i = 0; i < kSeconds * pose_rate; ++i) {
    const double time = i / pose_rate;
    auto message = transformOf("world", "base_link", Eigen::Quaterniond::Identity(),
                               {kSpeed * time, 0.0, 1.0});
    message.header.stamp = at(time);
    const ros::Time arrival = at(time + pose_delay);
    tf2_msgs::TFMessage tf;
    tf.transforms = transforms;
    for (auto& transform : tf.transforms) transform.header.stamp = at(time);
    if (pose_on_tf) tf.transforms.push_back(message);
    if (!tf.transforms.empty()) arrive("/tf", tf, arrival, &arrivals);
    if (!pose(&message)) continue;
    const std::string topic = pose_topic;
    const std::string type = pose_type;
    arrivals.emplace(arrival, [=](Observation* seen) {
      seen->types[topic] = type;
      observe(topic, message, arrival, seen);
    });
  }
  for (int i = 0; i < kSeconds * image_rate; ++i) {
    // Not at the time of a pose.
    const ros::Time stamp = at((i + 0.33) / image_rate);
    const ros::Time arrival = stamp + ros::Duration(image_delay);
    sensor_msgs::Image message;
    message.header.stamp = stamp;
    message.header.frame_id = "camera_optical";
    message.width = kWidth;
    message.height = kHeight;
    fillImage(kWall * 1000.0, "16UC1", &message);
    sensor_msgs::CameraInfo of_camera;
    of_camera.header = message.header;
    of_camera.width = kWidth;
    of_camera.height = kHeight;
    of_camera.K = {60.0, 0.0, 40.0, 0.0, 60.0, 30.0, 0.0, 0.0, 1.0};
    if (info(&of_camera)) arrive(info_topic, of_camera, arrival, &arrivals);
    if (image(&message)) arrive(image_topic, message, arrival, &arrivals);
    sensor_msgs::PointCloud2 points;
    points.header.stamp = stamp;
    points.header.frame_id = "lidar";
    fillCloud({{20.0F, 0.0F, 0.0F}, {0.0F, 5.0F, 0.0F}, {-15.0F, 0.0F, 1.0F}}, &points);
    if (cloud(&points)) arrive(cloud_topic, points, arrival, &arrivals);
  }
  Observation seen;
  seen.seconds = kSeconds;
  for (const auto& [time, action] : arrivals) action(&seen);
  more(&seen);
  return seen;
}

Diagnosis SeenVehicle::diagnosis(const DoctorWishes& wishes) const {
  return diagnose(observation(), wishes);
}

Finding expectFinding(const Diagnosis& diagnosis, Severity severity,
                      const std::vector<std::string>& words) {
  std::string all;
  for (const Finding& finding : diagnosis.findings) {
    const std::string text = finding.what + " -> " + finding.remedy + " " + finding.command;
    all += std::to_string(static_cast<int>(finding.severity)) + ": " + text + '\n';
    bool has_all = finding.severity == severity;
    for (const std::string& word : words) has_all &= text.find(word) != std::string::npos;
    if (has_all) return finding;
  }
  ADD_FAILURE() << "not found: " << (words.empty() ? "" : words.front()) << ", only:\n" << all;
  return {};
}

void expectNothingWrong(const Diagnosis& diagnosis) {
  for (const Finding& finding : diagnosis.findings) {
    EXPECT_EQ(finding.severity, Severity::kNote) << finding.what;
  }
}

std::string launchLine(const Diagnosis& diagnosis) {
  std::string line;
  for (const std::string& word : diagnosis.launch_words) line += (line.empty() ? "" : " ") + word;
  return line;
}

void expectContains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
}

}  // namespace fiimap
