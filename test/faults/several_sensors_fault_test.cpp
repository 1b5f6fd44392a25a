// What a user is told when something is wrong with one of several sensors.

#include <stdexcept>

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <gtest/gtest.h>

#include "diagnostic_summary.h"

namespace fiimap {
namespace {

TEST(SeveralSensorsFaultTest, ADeadSensorHidesNoMissingPoses) {
  const InputTopics topics = {{{"front", "/front/image", "/front/info"}, {"lidar", "/points", ""}},
                              "/odom"};
  InputTotals now;
  now.sensors = {{5, 5}, {0, 0}};
  now.counters.sensors.resize(2);
  EXPECT_EQ(missingInput(topics, now),
            "lidar: no scans received on /points; no poses received on /odom: check that it is "
            "published and remapped");
  EXPECT_EQ(summarizeInputs(topics, now, now).text, missingInput(topics, now));
  now.poses = 1;
  EXPECT_EQ(missingInput(topics, now),
            "lidar: no scans received on /points: check that it is published and remapped");
}

class NoObserver : public MapObserver {
 public:
  void onUpdate(const MapUpdate& /*update*/) override {}
  void onReset(const std::string& /*why*/) override {}
  void onDrop(const Drop& /*drop*/) override {}
  void onWarning(const std::string& /*text*/) override {}
};

TEST(SeveralSensorsFaultTest, MapAndNodeMustHaveTheSameSensors) {
  NoObserver observer;
  MapperConfig mapper;
  NodeConfig node;
  node.sensors.resize(2);
  node.sensors[0].name = "front";
  node.sensors[1].name = "lidar";
  const auto handle = std::make_shared<MapHandle>("several_sensors");
  EXPECT_THROW(MappingThread(mapper, node, handle, &observer), std::invalid_argument);
  mapper.sensors.assign(2, mapper);
  EXPECT_NO_THROW(MappingThread(mapper, node, handle, &observer));
}

}  // namespace
}  // namespace fiimap
