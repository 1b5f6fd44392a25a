#include "mapping_nodelet.h"

#include <unistd.h>

#include <boost/make_shared.hpp>
#include <pluginlib/class_list_macros.hpp>

#include "fiimap/ros/map_handle_message.h"
#include "fiimap/ros/map_messages.h"
#include "fiimap/ros/parameter_sources.h"
#include "statistics_message.h"

namespace fiimap {
namespace {

constexpr int kStatisticsQueue = 100;
constexpr int kHandleQueue = 10;
// One input after another; services may wait, write files or ask much of the map, and however many
// of them do, diagnostics go on.
constexpr unsigned kInputThreads = 1;
constexpr unsigned kServiceThreads = 4;
constexpr unsigned kDiagnosticsThreads = 1;
constexpr double kDiagnosticsPeriod = 1.0;               // s
constexpr std::chrono::seconds kMissingInputPeriod{10};  // between warnings, and before the first
constexpr std::chrono::seconds kDropPeriod{5};           // between warnings of one kind
constexpr double kBytesPerMegabyte = 1e6;

/// Parameters of others that live in our namespace.
bool isForeignParameter(const std::string& name) { return name == "diagnostic_period"; }

double physicalMemoryBytes() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace

MappingNodelet::MappingNodelet()
    : input_threads_(kInputThreads),
      service_threads_(kServiceThreads),
      diagnostics_threads_(kDiagnosticsThreads) {}

void MappingNodelet::onInit() {
  MapperConfig mapper_config;
  try {
    configureFromParameters(&mapper_config);
    handle_ = std::make_shared<MapHandle>(getName());
    MapObserver* const observer = this;
    mapping_ = std::make_unique<MappingThread>(mapper_config, node_config_, handle_, observer);
  } catch (const std::exception& error) {
    NODELET_FATAL("%s", error.what());
    throw;
  }
  logStart(mapping_->mapper());
  inputs_ = std::make_unique<InputSubscriber>(input_threads_.attach(getNodeHandle()), node_config_,
                                              mapping_.get());
  advertise();
  tuning_ = std::make_unique<TuningServer>(
      service_threads_.attach(getPrivateNodeHandle()), getName(), mapper_config, node_config_,
      [this](const MapperConfig& map, const NodeConfig& node) { return retune(map, node); });
  MapRegistry::add(handle_);
  mapping_->start();
  input_threads_.start();
  service_threads_.start();
  diagnostics_threads_.start();
}

MappingNodelet::~MappingNodelet() {
  if (!mapping_) return;
  // Nothing may call back any more before that goes which callbacks use. The mapping thread stops
  // first: a reset service that waits for it returns then.
  mapping_->stop();
  input_threads_.stop();
  service_threads_.stop();
  diagnostics_threads_.stop();
}

void MappingNodelet::configureFromParameters(MapperConfig* mapper_config) {
  const ParameterMap values = parameterMapFromRos(getPrivateNodeHandle());
  for (const std::string& name : configure(values, mapper_config, &node_config_)) {
    if (isForeignParameter(name)) continue;
    NODELET_WARN("parameter %s is unknown and has no effect%s", name.c_str(),
                 hintForUnknown(name).c_str());
  }
}

bool MappingNodelet::retune(const MapperConfig& map, const NodeConfig& node) {
  if (!mapping_->reconfigure(map, node)) return false;
  clouds_->setRate(node.publish_rate);
  changes_->setRate(node.publish_rate);
  vehicle_->setRate(node.publish_rate);
  status_->setRate(node.publish_rate);
  return true;
}

void MappingNodelet::logStart(const Mapper& mapper) {
  const MapperConfig& config = mapper.config();
  const VoxelIndex size = mapper.grid().window().size();
  const double memory = static_cast<double>(mapper.grid().worstCaseMemoryBytes());
  NODELET_INFO("map: resolution %g m, window %d x %d x %d voxels, about %.0f MB when all is seen",
               config.resolution, size.x(), size.y(), size.z(), memory / kBytesPerMegabyte);
  NODELET_INFO("inflation: radius %g m is %g voxels, reaches %d voxels", config.inflation_radius,
               config.inflation_radius / config.resolution, config.structuringElement().reach());
  NODELET_INFO("a voxel is occupied after %d hits, cleared after at most %d misses",
               mapper.logOdds().hitsToOccupy(), mapper.logOdds().missesToClear());
  if (memory > physicalMemoryBytes()) {
    NODELET_WARN(
        "the map may grow beyond this machine's memory: lower map_size_x/y/z or raise "
        "resolution");
  }
}

void MappingNodelet::advertise() {
  ros::NodeHandle node = input_threads_.attach(getPrivateNodeHandle());
  const bool latch = true;
  statistics_publisher_ = node.advertise<Statistics>("statistics", kStatisticsQueue, latch);
  handle_publisher_ = node.advertise<MapHandleMessage>("map_handle", kHandleQueue, latch);
  clouds_ =
      std::make_unique<CloudPublisher>(node, node_config_.map_frame, node_config_.publish_rate);
  changes_ = std::make_unique<ChangesPublisher>(
      node, node_config_.map_frame, node_config_.publish_rate, node_config_.keyframe_period);
  vehicle_ =
      std::make_unique<VehiclePublisher>(node, node_config_.map_frame, node_config_.publish_rate);
  status_ =
      std::make_unique<StatusPublisher>(node, node_config_.map_frame, node_config_.publish_rate);
  diagnostics_ = std::make_unique<MappingDiagnostics>(getNodeHandle(), node, getName(), *inputs_,
                                                      [this] { return mapping_->counters(); });

  services_ = std::make_unique<MapServices>(service_threads_.attach(getPrivateNodeHandle()),
                                            node_config_, handle_, mapping_.get());
  diagnostics_timer_ = diagnostics_threads_.attach(node).createWallTimer(
      ros::WallDuration(kDiagnosticsPeriod),
      [this](const ros::WallTimerEvent&) { onDiagnosticsTimer(); });
}

void MappingNodelet::onDiagnosticsTimer() {
  const std::string missing = diagnostics_->publish();
  // By the steady clock: without /clock the ROS clock stands still, and that is a reason to warn.
  const auto now = std::chrono::steady_clock::now();
  if (missing.empty() || now - missing_warned_ < kMissingInputPeriod) return;
  missing_warned_ = now;
  NODELET_WARN("%s", missing.c_str());
}

void MappingNodelet::publishHandle(const Snapshot& snapshot) {
  const auto message = boost::make_shared<MapHandleMessage>();
  message->info = toMapInfo(snapshot, handle_->id(), node_config_.map_frame);
  message->handle = handle_;
  handle_publisher_.publish(message);
}

void MappingNodelet::onUpdate(const MapUpdate& update) {
  const Snapshot& snapshot = *update.snapshot;
  const std::string& frame = node_config_.map_frame;
  publishHandle(snapshot);
  statistics_publisher_.publish(boost::make_shared<Statistics>(toStatistics(update, frame)));

  update_box_ = update.report.update_box;
  clouds_->offer(update.snapshot, update_box_);
  changes_->offer(update.snapshot);
  vehicle_->add(toPose(update.T_W_B, toHeader(update.pose.stamp_ns, frame)));
  status_->offer(update);
  diagnostics_->onUpdate(update);
}

void MappingNodelet::onEdit(const std::shared_ptr<const Snapshot>& snapshot) {
  publishHandle(*snapshot);
  clouds_->offer(snapshot, update_box_);
  changes_->offer(snapshot);
}

void MappingNodelet::onReset(const std::string& why) {
  NODELET_WARN("the map was forgotten: %s", why.c_str());
  clouds_->clear();
  changes_->offer(nullptr);
  vehicle_->clear();
  status_->clear();
  diagnostics_->onReset();
}

void MappingNodelet::onDrop(const Drop& drop) {
  const auto now = std::chrono::steady_clock::now();
  const std::pair<DropReason, std::string> kind(drop.reason, drop.sensor);
  const auto last = warned_.find(kind);
  if (last != warned_.end() && now - last->second < kDropPeriod) return;
  warned_[kind] = now;
  NODELET_WARN("scan dropped: %s", drop.text().c_str());
}

void MappingNodelet::onWarning(const std::string& text) { NODELET_WARN("%s", text.c_str()); }

}  // namespace fiimap

PLUGINLIB_EXPORT_CLASS(fiimap::MappingNodelet, nodelet::Nodelet)
