#include "ready_queue.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fiimap {
namespace {

SynchronizedScan scanOf(std::size_t sensor, std::int64_t number = 0) {
  SynchronizedScan scan;
  scan.sensor = sensor;
  scan.pose.stamp_ns = number;
  return scan;
}

/// Sensor and number of all scans in the queue, in the order in which they go.
std::string emptied(ReadyQueue* queue) {
  std::string text;
  while (!queue->empty()) {
    const SynchronizedScan scan = queue->pop();
    text += std::to_string(scan.sensor) + ':' + std::to_string(scan.pose.stamp_ns) + ' ';
  }
  return text;
}

TEST(ReadyQueueTest, ScansGoInTheOrderInWhichTheyCameAsLongAsAllHaveRoom) {
  ReadyQueue queue(3, 2);
  // Whatever their stamps are: a sensor of higher latency comes later.
  EXPECT_FALSE(queue.push(scanOf(0, 5)));
  EXPECT_FALSE(queue.push(scanOf(1, 2)));
  EXPECT_FALSE(queue.push(scanOf(1, 3)));
  EXPECT_FALSE(queue.push(scanOf(0, 6)));
  EXPECT_FALSE(queue.push(scanOf(1, 4)));
  EXPECT_EQ(queue.size(0), 2u);
  EXPECT_EQ(queue.size(1), 3u);
  EXPECT_EQ(emptied(&queue), "0:5 1:2 1:3 0:6 1:4 ");
  EXPECT_TRUE(queue.empty());
}

TEST(ReadyQueueTest, OfEachSensorTheNewestAreKept) {
  ReadyQueue queue(2, 2);
  queue.push(scanOf(1, 100));
  for (int number = 1; number <= 5; ++number) {
    EXPECT_EQ(queue.push(scanOf(0, number)), number > 2);
  }
  EXPECT_EQ(queue.size(0), 2u);
  EXPECT_EQ(queue.size(1), 1u);
}

TEST(ReadyQueueTest, OneSensorAloneIsAQueueOfItsNewest) {
  ReadyQueue queue(2, 1);
  for (int number = 1; number <= 5; ++number) queue.push(scanOf(0, number));
  EXPECT_EQ(emptied(&queue), "0:4 0:5 ");
}

/// Sensors send at their rates to a map that takes `capacity` scans a second.
/// \return scans that each got into the map, and that each sent, in `seconds`.
std::vector<std::pair<int, int>> share(const std::vector<int>& rates, int capacity, int seconds) {
  constexpr int kTicks = 100000;  // per second
  ReadyQueue queue(2, rates.size());
  std::vector<std::pair<int, int>> shares(rates.size());
  for (int tick = 0; tick < seconds * kTicks; ++tick) {
    for (std::size_t sensor = 0; sensor < rates.size(); ++sensor) {
      if (tick % (kTicks / rates[sensor]) != 0) continue;
      queue.push(scanOf(sensor, tick));
      ++shares[sensor].second;
    }
    if (tick % (kTicks / capacity) != 0) continue;
    if (!queue.empty()) ++shares[queue.pop().sensor].first;
  }
  return shares;
}

TEST(ReadyQueueTest, AnOverloadedMapStillTakesAllScansOfASlowSensor) {
  // Three cameras at 30 Hz and a LiDAR at 10 Hz, in a map that takes half of them.
  const auto shares = share({30, 30, 30, 10}, 50, 10);
  EXPECT_GE(shares[3].first, shares[3].second - 2);
  for (const int camera : {0, 1, 2}) EXPECT_NEAR(shares[camera].first, 133, 5) << camera;
}

TEST(ReadyQueueTest, SensorsThatAllSendTooMuchShareEqually) {
  // A slow sensor must not take it all either, though its scans are always the older ones.
  const auto shares = share({300, 300, 300, 100}, 20, 10);
  for (const auto& [integrated, sent] : shares) {
    EXPECT_NEAR(integrated, 50, 2);
    EXPECT_GT(sent, 900);
  }
}

TEST(ReadyQueueTest, AfterAnOverloadTheOrderReturns) {
  ReadyQueue queue(2, 2);
  for (int number = 1; number <= 3; ++number) queue.push(scanOf(0, number));
  queue.push(scanOf(1, 4));
  EXPECT_EQ(emptied(&queue), "0:2 1:4 0:3 ");
  for (const int number : {6, 7}) queue.push(scanOf(1, number));
  queue.push(scanOf(0, 5));
  EXPECT_EQ(emptied(&queue), "1:6 1:7 0:5 ");
}

}  // namespace
}  // namespace fiimap
