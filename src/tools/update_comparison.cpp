#include "update_comparison.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "baselines/interleave.h"
#include "baselines/octomap_map.h"
#include "baselines/thread_clock.h"

namespace fiimap {
namespace {

bool isMap(const std::string& name) {
  return std::find(std::begin(bench::kMappingMethods), std::end(bench::kMappingMethods), name) !=
         std::end(bench::kMappingMethods);
}

}  // namespace

UpdateComparison::UpdateComparison(const MapperConfig& config,
                                   const std::vector<std::string>& methods, const VoxelBox& box)
    : config_(config), recorder_(std::make_unique<bench::InflationRecorder>(config)) {
  for (const std::string& name : methods) {
    const bool is_map = isMap(name);
    replays_.push_back(is_map ? nullptr : bench::makeReplay(name, config, box));
    maps_.push_back(is_map ? bench::makeMethod(name, config, box) : nullptr);
    times_.push_back({name, !is_map, {}});
  }
}

std::optional<MapAgreement> UpdateComparison::agreement() const {
  const bench::FiimapMethod* ours = nullptr;
  const bench::OctomapMap* theirs = nullptr;
  for (const auto& map : maps_) {
    if (const auto* fiimap = dynamic_cast<const bench::FiimapMethod*>(map.get())) ours = fiimap;
    if (const auto* octomap = dynamic_cast<const bench::OctomapMap*>(map.get())) theirs = octomap;
  }
  if (ours == nullptr || theirs == nullptr || !ours->snapshot()) return std::nullopt;
  return compareWithOctomap(*ours->snapshot(), *theirs);
}

void UpdateComparison::addScan(const SynchronizedScan& scan, std::size_t /*index*/) {
  bench::Frame frame = bench::frameOf(scan, config_.pixel_step);
  bench::InflationStep step;
  try {
    step = recorder_->add(frame);
  } catch (const std::invalid_argument& error) {
    throw InputError(DropReason::kBadPose, error.what());
  }
  change_scores_.push_back(static_cast<double>(step.score()));
  stamps_ns_.push_back(scan.pose.stamp_ns);
  frames_.push_back(std::move(frame));
  steps_.push_back(std::move(step));
  if (frames_.size() == bench::kBlockFrames) runBlock();
}

void UpdateComparison::forget() {
  throw std::runtime_error("the recording begins anew; cut it there to compare methods on it");
}

/// The first method of a block is another one each time.
void UpdateComparison::runBlock() {
  for (std::size_t turn = 0; turn < times_.size(); ++turn) {
    const std::size_t method = (turn + blocks_) % times_.size();
    for (std::size_t frame = 0; frame < frames_.size(); ++frame) {
      times_[method].times_us.push_back(run(method, frame));
    }
  }
  ++blocks_;
  frames_.clear();
  steps_.clear();
}

double UpdateComparison::run(std::size_t method, std::size_t frame) {
  if (maps_[method]) {
    return bench::microsecondsOf([&] { maps_[method]->integrate(frames_[frame]); });
  }
  replays_[method]->prepare(steps_[frame]);
  return bench::microsecondsOf([&] { replays_[method]->update(); });
}

}  // namespace fiimap
