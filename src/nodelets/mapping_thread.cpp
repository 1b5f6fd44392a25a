#include "mapping_thread.h"

#include <chrono>
#include <exception>
#include <future>
#include <stdexcept>
#include <utility>

#include "fiimap/ros/stamps.h"
#include "fiimap/ros/steady_time.h"

namespace fiimap {
namespace {

constexpr std::chrono::milliseconds kPoll{50};  // how often waiting scans are looked at
constexpr double kClockJump = 1.0;              // s

using Clock = std::chrono::steady_clock;

}  // namespace

MappingThread::MappingThread(const MapperConfig& mapper_config, const NodeConfig& node_config,
                             std::shared_ptr<MapHandle> handle, MapObserver* observer)
    : sensors_(node_config.allSensors()),
      handle_(std::move(handle)),
      observer_(observer),
      mapper_(mapper_config),
      synchronizer_(node_config, this),
      ready_(static_cast<std::size_t>(node_config.ready_queue_size), sensors_.size()),
      queue_(static_cast<std::size_t>(node_config.scan_queue_size), sensors_.size()) {
  if (mapper_config.sensorCount() != sensors_.size()) {
    throw std::invalid_argument("the map has " + std::to_string(mapper_config.sensorCount()) +
                                " sensors, the node " + std::to_string(sensors_.size()));
  }
  counters_.sensors.resize(node_config.sensors.size());
  published_counters_ = counters_;
}

void MappingThread::start() {
  thread_ = std::thread([this] { run(); });
}

void MappingThread::stop() {
  stopping_ = true;
  queue_.close();
  if (thread_.joinable()) thread_.join();
}

void MappingThread::addScan(const ScanMessage& scan, std::size_t sensor) {
  queue_.pushScan(
      [this, scan, sensor, received = readClocks()] {
        counters_.countReceived(sensor);
        synchronizer_.add(scan, received, sensor);
      },
      sensor);
}

void MappingThread::post(std::function<void(ScanSynchronizer*)> input) {
  readClocks();
  queue_.pushOther([this, input = std::move(input)] { input(&synchronizer_); });
}

void MappingThread::ignore(std::vector<IgnoredSphere> spheres) {
  queue_.pushOther([this, spheres = std::move(spheres)] { mapper_.ignore(spheres); });
}

bool MappingThread::reset() {
  return doBetweenScans([this] { forget("reset was asked for"); });
}

bool MappingThread::edit(std::function<void(Mapper*)> function) {
  return doBetweenScans([this, function = std::move(function)] {
    function(&mapper_);
    // Before the first scan there is no map that readers could get, unless one was loaded.
    if (!mapper_.hasWindow()) return;
    const std::shared_ptr<const Snapshot> snapshot = mapper_.snapshot();
    handle_->publish(snapshot);
    observer_->onEdit(snapshot);
  });
}

bool MappingThread::reconfigure(const MapperConfig& map, const NodeConfig& node) {
  return edit([&](Mapper* mapper) {
    mapper->reconfigure(map);
    synchronizer_.reconfigure(node);
  });
}

bool MappingThread::doBetweenScans(std::function<void()> work) {
  auto done = std::make_shared<std::promise<void>>();
  std::future<void> finished = done->get_future();
  queue_.pushControl([work = std::move(work), done] {
    try {
      work();
      done->set_value();
    } catch (...) {
      done->set_exception(std::current_exception());
    }
  });
  done.reset();
  try {
    finished.get();
  } catch (const std::future_error&) {
    return false;  // the queue was closed and destroyed the promise
  }
  return true;
}

/// Simulated time that goes back means that a bag began again, whatever the stamps say. Enqueued,
/// so that messages of the old time stay in front of it.
Moment MappingThread::readClocks() {
  // Read under the lock: a thread that comes late with an old time would look like a jump.
  const std::lock_guard<std::mutex> lock(clock_mutex_);
  const Moment now = {ros::Time::now(), Clock::now()};
  const double step_back = secondsBetween(now.ros, newest_time_);
  newest_time_ = now.ros;
  if (step_back > kClockJump) {
    queue_.pushControl([this, step_back] {
      synchronizer_.restart("the clock went back by " + std::to_string(step_back) + " s");
    });
  }
  return now;
}

ScanCounters MappingThread::counters() const {
  const std::lock_guard<std::mutex> lock(counters_mutex_);
  return published_counters_;
}

void MappingThread::countWaiting() {
  counters_.waiting = 0;
  for (std::size_t sensor = 0; sensor < sensors_.size(); ++sensor) {
    const std::size_t waiting = synchronizer_.waiting(sensor) + ready_.size(sensor);
    counters_.waiting += waiting;
    if (!counters_.sensors.empty()) counters_.sensors[sensor].waiting = waiting;
  }
}

void MappingThread::publishCounters() {
  countWaiting();
  counters_.refused_poses = synchronizer_.poses().refusedPoses();
  counters_.refused_transforms = synchronizer_.poses().refusedTransforms();
  const std::lock_guard<std::mutex> lock(counters_mutex_);
  published_counters_ = counters_;
}

void MappingThread::run() {
  while (!stopping_) step();
}

void MappingThread::step() {
  // Before the queue is emptied, so that no scan expires while its pose is in the queue.
  const Moment now = readClocks();
  const InputQueue::Batch batch = queue_.take(ready_.empty() ? kPoll : kPoll * 0);
  for (std::size_t sensor = 0; sensor < batch.displaced_scans.size(); ++sensor) {
    for (std::size_t i = 0; i < batch.displaced_scans[sensor]; ++i) {
      counters_.countReceived(sensor);
      drop({DropReason::kOverload, "a scan was displaced before it could be looked at"}, sensor);
    }
  }
  counters_.displaced_inputs += batch.displaced_others;
  for (const InputQueue::Task& task : batch.tasks) {
    if (stopping_) return;
    task();
  }
  synchronizer_.expire(now);
  if (!ready_.empty()) integrate(ready_.pop());
  publishCounters();
}

void MappingThread::integrate(const SynchronizedScan& scan) {
  MapUpdate update;
  update.sensor = sensors_[scan.sensor].name;
  try {
    update.report = decoder_.integrate(scan, &mapper_);
  } catch (const InputError& error) {
    drop(error.drop(), scan.sensor);
    return;
  }
  counters_.countIntegrated(scan.sensor);
  countWaiting();
  const Clock::time_point start = Clock::now();
  update.snapshot = mapper_.snapshot();
  update.report.times_ms.snapshot = millisecondsSince(start);
  handle_->publish(update.snapshot);

  update.pose = scan.pose;
  update.T_W_B = scan.T_W_B;
  update.pose_gap = scan.pose_gap;
  update.decode_ms = decoder_.decodeTimeMs();
  update.memory_bytes = mapper_.memoryBytes();
  update.counters = counters_;
  observer_->onUpdate(update);
}

void MappingThread::onScan(const SynchronizedScan& scan) {
  if (!ready_.push(scan)) return;
  drop({DropReason::kOverload, "newer scans came while the map was busy"}, scan.sensor);
}

void MappingThread::onTimeJump(const std::string& what) {
  while (!ready_.empty()) {
    drop({DropReason::kTimeJump, what + " while the scan waited for the map"}, ready_.pop().sensor);
  }
  forget(what);
}

void MappingThread::forget(const std::string& why) {
  mapper_.reset();
  handle_->publish(nullptr);
  observer_->onReset(why);
}

void MappingThread::drop(const Drop& drop, std::size_t sensor) {
  Drop named = drop;
  named.sensor = sensors_[sensor].name;
  counters_.countDrop(named, sensor);
  observer_->onDrop(named);
}

}  // namespace fiimap
