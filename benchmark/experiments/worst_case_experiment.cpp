#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "experiments.h"
#include "mapping_method.h"
#include "thread_clock.h"

namespace fiimap::bench {
namespace {

constexpr int kRounds = 10;           // of each event
constexpr int kUsualFrames = 5;       // between two events
constexpr double kTeleport = 1000.0;  // m
constexpr double kFlippedShare = 0.3;
constexpr int kPatchSide = 16;   // pixels
constexpr double kNearer = 0.7;  // where a patch of the surface appears

/// A map in use, into which events are thrown.
class EventfulMap {
 public:
  EventfulMap(const MapperConfig& config, const std::vector<Frame>& frames)
      : mapper_(config), frames_(frames) {
    for (std::size_t i = 0; i <= frames_.size() / 2; ++i) integrateNext();
  }

  /// Goes on along the recording, at its end from the beginning.
  void integrateNext() {
    newest_ = frames_[next_++ % frames_.size()];
    integrateNewest();
  }
  void integrateNewest() {
    ScanPose pose = newest_.pose;
    pose.T_W_S.pretranslate(jump_W_);
    pose.vehicle_W += jump_W_ + vehicle_shift_W_;
    change_score_ = mapper_.integrate(newest_.image.view, newest_.intrinsics, pose).changeScore();
    snapshot_ = mapper_.snapshot();
  }
  /// Of the newest frame.
  std::size_t changeScore() const { return change_score_; }

  void reset() { mapper_.reset(); }
  void teleport() { jump_W_.x() += kTeleport; }
  void shiftVehicle(int axis) { vehicle_shift_W_[axis] += mapper_.config().resolution; }
  void see(const Frame& frame) { newest_ = frame; }
  const Frame& newest() const { return newest_; }

 private:
  Mapper mapper_;
  const std::vector<Frame>& frames_;
  std::shared_ptr<const Snapshot> snapshot_;
  Frame newest_;
  std::size_t change_score_ = 0;
  std::size_t next_ = 0;
  Eigen::Vector3d jump_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d vehicle_shift_W_ = Eigen::Vector3d::Zero();
};

/// The frame with patches, a share of the image, moved nearer to the camera.
Frame withPatches(const Frame& frame) {
  const DepthImage& image = frame.image.view;
  const auto bytes = std::make_shared<std::vector<std::uint8_t>>(image.row_bytes * image.height);
  std::memcpy(bytes->data(), image.data, bytes->size());
  std::mt19937 random(kSeed);
  std::bernoulli_distribution is_moved(kFlippedShare);
  for (int v0 = 0; v0 < image.height; v0 += kPatchSide) {
    for (int u0 = 0; u0 < image.width; u0 += kPatchSide) {
      if (!is_moved(random)) continue;
      for (int v = v0; v < std::min(v0 + kPatchSide, image.height); ++v) {
        auto* row = reinterpret_cast<std::uint16_t*>(bytes->data() + v * image.row_bytes);
        for (int u = u0; u < std::min(u0 + kPatchSide, image.width); ++u) {
          row[u] = static_cast<std::uint16_t>(row[u] * kNearer);
        }
      }
    }
  }
  Frame changed = frame;
  changed.image.view.data = bytes->data();
  changed.image.pixels = bytes;
  return changed;
}

/// Something that happens to a map of its own, again and again.
struct Event {
  std::string name;
  std::unique_ptr<EventfulMap> map;
  std::function<void()> prepare;
  std::function<void()> happen;  ///< what is measured
  std::vector<double> times;
  std::vector<double> change_scores;
};

/// A jump or a reset between usual frames.
Event usualEvent(const std::string& name, const MapperConfig& config,
                 const std::vector<Frame>& frames,
                 const std::function<void(EventfulMap*)>& disturb) {
  auto map = std::make_unique<EventfulMap>(config, frames);
  EventfulMap* m = map.get();
  const auto prepare = [m] {
    for (int i = 0; i < kUsualFrames; ++i) m->integrateNext();
  };
  const auto happen = [m, disturb] {
    disturb(m);
    m->integrateNext();
  };
  return {name, std::move(map), prepare, happen, {}, {}};
}

/// The vehicle steps by one voxel while the camera looks at the same; nothing else changes.
Event slideEvent(const std::string& name, MapperConfig config, const std::vector<Frame>& frames,
                 int axis) {
  config.slide_distance = 0.0;  // the window follows every step
  auto map = std::make_unique<EventfulMap>(config, frames);
  EventfulMap* m = map.get();
  const auto prepare = [m, axis] {
    m->integrateNewest();
    m->shiftVehicle(axis);
  };
  return {name, std::move(map), prepare, [m] { m->integrateNewest(); }, {}, {}};
}

/// Patches of the surface jump to and fro, and one look is enough to believe it: in every frame
/// they leave one place and appear at another.
Event flipEvent(MapperConfig config, const std::vector<Frame>& frames) {
  config.p_hit = 0.97;
  config.p_max = 0.88;
  config.p_miss = 0.30;
  config.p_min = 0.29;
  auto map = std::make_unique<EventfulMap>(config, frames);
  EventfulMap* m = map.get();
  const auto prepare = [m, next = withPatches(m->newest()), other = m->newest()]() mutable {
    m->see(next);
    std::swap(next, other);
  };
  return {"flip", std::move(map), prepare, [m] { m->integrateNewest(); }, {}, {}};
}

std::vector<Event> makeEvents(const MapperConfig& config, const std::vector<Frame>& frames) {
  std::vector<Event> events;
  events.push_back(usualEvent("none", config, frames, [](EventfulMap* /*map*/) {}));
  events.push_back(usualEvent("reset", config, frames, [](EventfulMap* map) { map->reset(); }));
  events.push_back(
      usualEvent("teleport", config, frames, [](EventfulMap* map) { map->teleport(); }));
  events.push_back(slideEvent("slide_x", config, frames, 0));
  events.push_back(slideEvent("slide_y", config, frames, 1));
  events.push_back(slideEvent("slide_z", config, frames, 2));
  events.push_back(flipEvent(config, frames));
  return events;
}

}  // namespace

void measureWorstCases(const Recording& recording, Samples* samples) {
  for (const double resolution : {0.1, 0.05}) {
    std::vector<Event> events = makeEvents(configAt(resolution, kReach), recording.frames);
    for (int round = 0; round < kRounds; ++round) {
      for (Event& event : events) {
        event.prepare();
        event.times.push_back(microsecondsOf(event.happen));
        event.change_scores.push_back(static_cast<double>(event.map->changeScore()));
      }
    }
    for (const Event& event : events) {
      const nlohmann::json setting = {{"resolution", resolution}, {"event", event.name}};
      samples->add({"worst", recording.name, kFiimap, setting, event.times});
      samples->add({"worst_change_score", recording.name, kFiimap, setting, event.change_scores});
    }
  }
}

}  // namespace fiimap::bench
