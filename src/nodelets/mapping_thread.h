#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "fiimap/map_handle.h"
#include "fiimap/mapper.h"
#include "fiimap/ros/scan_counters.h"
#include "fiimap/ros/scan_decoder.h"
#include "fiimap/ros/scan_synchronizer.h"
#include "input_queue.h"
#include "ready_queue.h"

namespace fiimap {

/// The map after a scan, and what the scan did.
struct MapUpdate {
  std::string sensor;  ///< name; empty where there is one only
  ScanPose pose;
  Eigen::Isometry3d T_W_B = Eigen::Isometry3d::Identity();  ///< vehicle's body to world
  double pose_gap = 0.0;                                    ///< s between the poses around the scan
  ScanReport report;
  double decode_ms = 0.0;
  std::shared_ptr<const Snapshot> snapshot;
  std::size_t memory_bytes = 0;
  ScanCounters counters;
};

/// Hears of the map; called on the mapping thread.
class MapObserver {
 public:
  virtual ~MapObserver() = default;

  virtual void onUpdate(const MapUpdate& update) = 0;
  /// The map changed by other means than a scan.
  virtual void onEdit(const std::shared_ptr<const Snapshot>& /*snapshot*/) {}
  /// Everything was forgotten.
  virtual void onReset(const std::string& why) = 0;
  virtual void onDrop(const Drop& drop) = 0;
  virtual void onWarning(const std::string& text) = 0;
};

/// Owns the Mapper and the one thread that works with it. Its public methods may be called from any
/// thread; they only enqueue, except reset(), edit() and reconfigure().
class MappingThread : private ScanListener {
 public:
  /// \param handle where readers get the snapshots; \param observer must outlive this object.
  /// \throws std::invalid_argument when a configuration is not valid, or when they have different
  /// numbers of sensors.
  MappingThread(const MapperConfig& mapper_config, const NodeConfig& node_config,
                std::shared_ptr<MapHandle> handle, MapObserver* observer);
  ~MappingThread() override { stop(); }

  void start();
  /// Stops after the scan that is being integrated; other input is forgotten, now and later. No
  /// observer is called any more when this returns.
  void stop();

  /// The mapper, for questions before start().
  const Mapper& mapper() const { return mapper_; }

  /// \param sensor index in NodeConfig::sensors.
  void addScan(const ScanMessage& scan, std::size_t sensor = 0);
  /// Enqueues anything else that the synchronizer takes.
  void post(std::function<void(ScanSynchronizer*)> input);

  /// Ignores returns in spheres, of scans that come later.
  void ignore(std::vector<IgnoredSphere> spheres);

  /// Forgets the map and waits until that is done. \return false when the thread is stopping.
  bool reset();
  /// Lets a function work with the mapper between two scans and waits until it has; then readers
  /// get the map that it left. \return false when the thread is stopping. Rethrows what the
  /// function throws, whose map they do not get before the next scan.
  bool edit(std::function<void(Mapper*)> function);
  /// Goes on with another configuration: edit() with Mapper::reconfigure(), and the same for what
  /// brings scans and poses together. \param node differs in what is `tunable` only.
  bool reconfigure(const MapperConfig& map, const NodeConfig& node);

  /// Copy of the counters as of the last step.
  ScanCounters counters() const;

 private:
  void run();
  void step();
  void integrate(const SynchronizedScan& scan);
  bool doBetweenScans(std::function<void()> work);
  Moment readClocks();
  void forget(const std::string& why);
  void drop(const Drop& drop, std::size_t sensor);
  void countWaiting();
  void publishCounters();

  void onScan(const SynchronizedScan& scan) override;
  void onDrop(const Drop& drop, std::size_t sensor) override { this->drop(drop, sensor); }
  void onTimeJump(const std::string& what) override;
  void onWarning(const std::string& text) override { observer_->onWarning(text); }

  std::vector<SensorConfig> sensors_;
  std::shared_ptr<MapHandle> handle_;
  MapObserver* observer_;

  // Of the mapping thread alone.
  Mapper mapper_;
  ScanSynchronizer synchronizer_;
  ScanDecoder decoder_;
  ScanCounters counters_;
  ReadyQueue ready_;

  std::mutex clock_mutex_;
  ros::Time newest_time_;  // by the ROS clock

  mutable std::mutex counters_mutex_;
  ScanCounters published_counters_;

  std::atomic<bool> stopping_{false};
  InputQueue queue_;
  std::thread thread_;
};

}  // namespace fiimap
