#include "bag_check.h"

#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace fiimap {
namespace {

class BagCheckTest : public testing::TestWithParam<rosbag::CompressionType> {
 protected:
  BagCheckTest() : file_(testing::TempDir() + "bag_check_" + std::to_string(getpid()) + ".bag") {
    rosbag::Bag bag(file_, rosbag::bagmode::Write);
    bag.setCompression(GetParam());
    for (int i = 1; i <= 3; ++i) {
      bag.write("/pose", ros::Time(i), geometry_msgs::TransformStamped());
    }
    bag.close();
    std::ifstream stream(file_, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(stream), {});
  }
  ~BagCheckTest() override { std::remove(file_.c_str()); }

  /// What is said about a file of these bytes; empty when nothing.
  std::string complaint(const std::string& bytes) const {
    std::ofstream(file_, std::ios::binary) << bytes;
    try {
      requireSoundBag(file_);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }

  std::string file_;
  std::string bytes_;
};

TEST_P(BagCheckTest, SaysNothingAboutWhatRosbagWrites) { EXPECT_EQ(complaint(bytes_), ""); }

TEST_P(BagCheckTest, LeavesOtherFilesToRosbag) {
  EXPECT_EQ(complaint(""), "");
  EXPECT_EQ(complaint("#ROSBAG V1.2\nand more"), "");
}

TEST_P(BagCheckTest, FindsAnEndThatIsMissing) {
  for (std::size_t missing = 1; missing < bytes_.size() - 4200; missing += 97) {
    const std::string message = complaint(bytes_.substr(0, bytes_.size() - missing));
    EXPECT_NE(message.find("is damaged"), std::string::npos) << missing << ": " << message;
  }
}

TEST_P(BagCheckTest, FindsALengthThatLies) {
  constexpr std::size_t kFirstChunk =
      13 + 4096;  // after the format's name and the bag's own record
  int found = 0;
  for (std::size_t at = kFirstChunk; at + 4 < bytes_.size(); at += 9) {
    std::string damaged = bytes_;
    damaged.replace(at, 4, "\xff\xff\xff\xff");
    found += complaint(damaged).empty() ? 0 : 1;
  }
  EXPECT_GT(found, 10) << "lengths, positions and names";
}

INSTANTIATE_TEST_SUITE_P(Compressions, BagCheckTest,
                         testing::Values(rosbag::compression::Uncompressed,
                                         rosbag::compression::BZ2, rosbag::compression::LZ4));

}  // namespace
}  // namespace fiimap
