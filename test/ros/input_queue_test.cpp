#include "input_queue.h"

#include <vector>

#include <gtest/gtest.h>

namespace fiimap {
namespace {

constexpr std::chrono::milliseconds kNoWait{0};

/// The numbers of the tasks of a batch, in order.
std::vector<int> run(const InputQueue::Batch& batch, std::vector<int>* done) {
  done->clear();
  for (const InputQueue::Task& task : batch.tasks) task();
  return *done;
}

TEST(InputQueueTest, KeepsTheOrderOfAllKinds) {
  InputQueue queue(5);
  std::vector<int> done;
  queue.pushOther([&done] { done.push_back(1); });
  queue.pushScan([&done] { done.push_back(2); });
  queue.pushControl([&done] { done.push_back(3); });
  queue.pushOther([&done] { done.push_back(4); });
  EXPECT_EQ(run(queue.take(kNoWait), &done), (std::vector<int>{1, 2, 3, 4}));
  EXPECT_TRUE(queue.take(kNoWait).tasks.empty());
}

TEST(InputQueueTest, TheOldestScansGiveWay) {
  InputQueue queue(2);
  std::vector<int> done;
  for (int i = 0; i < 5; ++i) queue.pushScan([&done, i] { done.push_back(i); });
  const InputQueue::Batch batch = queue.take(kNoWait);
  EXPECT_EQ(batch.displaced_scans, std::vector<std::size_t>{3});
  EXPECT_EQ(batch.displaced_others, 0u);
  EXPECT_EQ(run(batch, &done), (std::vector<int>{3, 4}));
  EXPECT_EQ(queue.take(kNoWait).displaced_scans, std::vector<std::size_t>{0});
}

TEST(InputQueueTest, ScansOfOneSensorDoNotDisplaceThoseOfAnother) {
  InputQueue queue(2, 3);
  std::vector<int> done;
  queue.pushScan([&done] { done.push_back(100); }, 2);
  for (int i = 0; i < 5; ++i) queue.pushScan([&done, i] { done.push_back(i); }, 0);
  queue.pushOther([&done] { done.push_back(200); });
  const InputQueue::Batch batch = queue.take(kNoWait);
  EXPECT_EQ(batch.displaced_scans, (std::vector<std::size_t>{3, 0, 0}));
  EXPECT_EQ(run(batch, &done), (std::vector<int>{100, 3, 4, 200}));
}

TEST(InputQueueTest, OnlyDataGivesWayAndIsCounted) {
  InputQueue queue(2);
  std::vector<int> done;
  const int count = static_cast<int>(InputQueue::kMaxOthers) + 3;
  queue.pushControl([&done] { done.push_back(-1); });
  for (int i = 0; i < count; ++i) queue.pushOther([&done, i] { done.push_back(i); });
  queue.pushControl([&done] { done.push_back(-2); });
  const InputQueue::Batch batch = queue.take(kNoWait);
  EXPECT_EQ(batch.displaced_others, 3u);
  EXPECT_EQ(batch.displaced_scans, std::vector<std::size_t>{0});
  run(batch, &done);
  ASSERT_EQ(done.size(), InputQueue::kMaxOthers + 2);
  EXPECT_EQ(done.front(), -1);
  EXPECT_EQ(done[1], 3);
  EXPECT_EQ(done.back(), -2);
}

TEST(InputQueueTest, TakesNothingAfterClose) {
  InputQueue queue(2);
  queue.pushOther([] {});
  queue.close();
  queue.pushControl([] {});
  EXPECT_TRUE(queue.take(kNoWait).tasks.empty());
}

}  // namespace
}  // namespace fiimap
