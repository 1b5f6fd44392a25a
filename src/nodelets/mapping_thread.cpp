#include "mapping_thread.h"

#include <chrono>
#include <future>
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
    : config_(node_config),
      handle_(std::move(handle)),
      observer_(observer),
      mapper_(mapper_config),
      synchronizer_(node_config, this),
      queue_(static_cast<std::size_t>(node_config.scan_queue_size)) {}

void MappingThread::start() {
  thread_ = std::thread([this] { run(); });
}

void MappingThread::stop() {
  stopping_ = true;
  queue_.close();
  if (thread_.joinable()) thread_.join();
}

void MappingThread::addScan(const ScanMessage& scan) {
  queue_.pushScan([this, scan, received = readClocks()] {
    ++counters_.received;
    synchronizer_.add(scan, received);
  });
}

void MappingThread::post(std::function<void(ScanSynchronizer*)> input) {
  readClocks();
  queue_.pushOther([this, input = std::move(input)] { input(&synchronizer_); });
}

bool MappingThread::reset() {
  auto done = std::make_shared<std::promise<void>>();
  std::future<void> finished = done->get_future();
  queue_.pushControl([this, done] {
    forget("reset was asked for");
    done->set_value();
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

void MappingThread::countWaiting() { counters_.waiting = synchronizer_.waiting() + ready_.size(); }

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
  for (std::size_t i = 0; i < batch.displaced_scans; ++i) {
    ++counters_.received;
    drop({DropReason::kOverload, "a scan was displaced before it could be looked at"});
  }
  counters_.displaced_inputs += batch.displaced_others;
  for (const InputQueue::Task& task : batch.tasks) {
    if (stopping_) return;
    task();
  }
  synchronizer_.expire(now);
  if (!ready_.empty()) integrateNext();
  publishCounters();
}

void MappingThread::integrateNext() {
  const SynchronizedScan scan = std::move(ready_.front());
  ready_.pop_front();
  MapUpdate update;
  try {
    update.report = decoder_.integrate(scan, &mapper_);
  } catch (const InputError& error) {
    drop(error.drop());
    return;
  }
  ++counters_.integrated;
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
  ready_.push_back(scan);
  if (ready_.size() <= static_cast<std::size_t>(config_.ready_queue_size)) return;
  ready_.pop_front();
  drop({DropReason::kOverload, "newer scans came while the map was busy"});
}

void MappingThread::onTimeJump(const std::string& what) {
  for (; !ready_.empty(); ready_.pop_front()) {
    drop({DropReason::kTimeJump, what + " while the scan waited for the map"});
  }
  forget(what);
}

void MappingThread::forget(const std::string& why) {
  mapper_.reset();
  handle_->publish(nullptr);
  observer_->onReset(why);
}

void MappingThread::drop(const Drop& drop) {
  counters_.countDrop(drop);
  observer_->onDrop(drop);
}

}  // namespace fiimap
