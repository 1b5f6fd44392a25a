#include <memory>
#include <string>

#include "experiments.h"
#include "inflation_replay.h"
#include "interleave.h"
#include "thread_clock.h"

namespace fiimap::bench {
namespace {

constexpr int kMaxReach = 10;  // voxels
/// A frame of the searches takes seconds beyond.
constexpr int kMaxBfsReach = 4;  // voxels

struct Contender {
  Series series;
  std::unique_ptr<InflationReplay> replay;
};

class InflationRace {
 public:
  InflationRace(const Recording& recording, const std::vector<InflationStep>& steps, int reach)
      : recording_(recording), steps_(steps), reach_(reach) {}

  void add(ElementShape shape, const std::string& shape_name, InflationMethod method,
           const std::string& name) {
    MapperConfig config = configAt(kResolution, reach_, shape);
    config.inflation_method = method;
    add(shape_name, name, std::make_unique<InflaterReplay>(config));
  }

  void addByteBatch(ElementShape shape, const std::string& shape_name) {
    const MapperConfig config = configAt(kResolution, reach_, shape);
    add(shape_name, "byte_batch",
        std::make_unique<BatchReplay>(config, boxAroundFrames(config, recording_.frames)));
  }

  void run(Samples* samples) {
    interleave(contenders_.size(), steps_.size(), [&](std::size_t contender, std::size_t step) {
      contenders_[contender].replay->prepare(steps_[step]);
      contenders_[contender].series.values.push_back(
          microsecondsOf([&] { contenders_[contender].replay->update(); }));
    });
    for (const Contender& contender : contenders_) samples->add(contender.series);
  }

 private:
  void add(const std::string& shape_name, const std::string& name,
           std::unique_ptr<InflationReplay> replay) {
    const nlohmann::json setting = {
        {"resolution", kResolution}, {"reach", reach_}, {"shape", shape_name}};
    contenders_.push_back({{"inflation", recording_.name, name, setting, {}}, std::move(replay)});
  }

  const Recording& recording_;
  const std::vector<InflationStep>& steps_;
  int reach_;
  std::vector<Contender> contenders_;
};

}  // namespace

void measureInflation(const Recording& recording, Samples* samples) {
  const std::vector<InflationStep> steps =
      recordInflationSteps(recording.frames, configAt(kResolution, 1));
  Series scores{"change_score", recording.name, "", {{"resolution", kResolution}}, {}};
  for (const InflationStep& step : steps) {
    scores.values.push_back(static_cast<double>(step.score()));
  }
  samples->add(scores);
  for (int reach = 1; reach <= kMaxReach; ++reach) {
    InflationRace race(recording, steps, reach);
    race.add(ElementShape::kBall, "ball", InflationMethod::kIncremental, "incremental");
    race.add(ElementShape::kCube, "cube", InflationMethod::kIncremental, "incremental");
    race.addByteBatch(ElementShape::kBall, "ball");
    race.addByteBatch(ElementShape::kCube, "cube");
    if (reach <= kMaxBfsReach) {
      race.add(ElementShape::kBall, "ball", InflationMethod::kBfs, "bfs");
    }
    race.run(samples);
  }
}

}  // namespace fiimap::bench
