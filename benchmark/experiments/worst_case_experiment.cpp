#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <random>
#include <string>

#include "experiments.h"
#include "mapping_method.h"
#include "thread_clock.h"

namespace fiimap::bench {
namespace {

constexpr int kReach = 2;             // voxels
constexpr int kEvents = 10;           // of each kind
constexpr int kUsualFrames = 5;       // between two events
constexpr double kTeleport = 1000.0;  // m
constexpr double kFlippedShare = 0.3;
constexpr int kPatchSide = 16;   // pixels
constexpr double kNearer = 0.7;  // where a patch of the surface appears
constexpr unsigned kSeed = 20230312;

/// A map in use, into which events are thrown.
class EventfulMap {
 public:
  EventfulMap(const MapperConfig& config, const std::vector<Frame>& frames)
      : mapper_(config), frames_(frames) {
    for (std::size_t i = 0; i + 1 < frames_.size() / 2; ++i) integrateNext();
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

/// Times of the frames at which `event` happens.
std::vector<double> timesOf(EventfulMap* map, const std::function<void()>& event) {
  std::vector<double> times;
  for (int i = 0; i < kEvents; ++i) {
    times.push_back(microsecondsOf(event));
    for (int j = 0; j < kUsualFrames; ++j) map->integrateNext();
  }
  return times;
}

/// The vehicle steps by one voxel while the camera looks at the same; nothing else changes.
std::vector<double> timesOfSlide(const MapperConfig& usual_config, const std::vector<Frame>& frames,
                                 int axis) {
  MapperConfig config = usual_config;
  config.slide_distance = 0.0;  // the window follows every step
  EventfulMap map(config, frames);
  std::vector<double> times;
  for (int i = 0; i < kEvents; ++i) {
    map.integrateNewest();
    map.shiftVehicle(axis);
    times.push_back(microsecondsOf([&] { map.integrateNewest(); }));
  }
  return times;
}

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

/// Patches of the surface jump to and fro, and one look is enough to believe it: in every frame
/// they leave one place and appear at another.
std::vector<double> timesOfFlips(const MapperConfig& usual_config, const std::vector<Frame>& frames,
                                 std::vector<double>* change_scores) {
  MapperConfig config = usual_config;
  config.p_hit = 0.97;
  config.p_max = 0.88;
  config.p_miss = 0.30;
  config.p_min = 0.29;
  EventfulMap map(config, frames);
  const Frame still = map.newest();
  const Frame patched = withPatches(still);
  std::vector<double> times;
  for (int i = 0; i < kEvents; ++i) {
    map.see(i % 2 == 0 ? patched : still);
    times.push_back(microsecondsOf([&] { map.integrateNewest(); }));
    change_scores->push_back(static_cast<double>(map.changeScore()));
  }
  return times;
}

}  // namespace

void measureWorstCases(const Recording& recording, Samples* samples) {
  for (const double resolution : {0.1, 0.05}) {
    const MapperConfig config = configAt(resolution, kReach);
    const std::vector<Frame>& frames = recording.frames;
    const auto add = [&](const std::string& event, const std::vector<double>& times) {
      const nlohmann::json setting = {{"resolution", resolution}, {"event", event}};
      samples->add({"worst", recording.name, kFiimap, setting, times});
    };
    EventfulMap usual(config, frames);
    add("none", timesOf(&usual, [&] { usual.integrateNext(); }));
    EventfulMap reset(config, frames);
    add("reset", timesOf(&reset, [&] {
          reset.reset();
          reset.integrateNext();
        }));
    EventfulMap teleported(config, frames);
    add("teleport", timesOf(&teleported, [&] {
          teleported.teleport();
          teleported.integrateNext();
        }));
    add("slide_x", timesOfSlide(config, frames, 0));
    add("slide_y", timesOfSlide(config, frames, 1));
    add("slide_z", timesOfSlide(config, frames, 2));
    std::vector<double> change_scores;
    add("flip", timesOfFlips(config, frames, &change_scores));
    const nlohmann::json setting = {{"resolution", resolution}};
    samples->add({"flip_change_score", recording.name, kFiimap, setting, change_scores});
  }
}

}  // namespace fiimap::bench
