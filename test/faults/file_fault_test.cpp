// Every fault of faults.yaml that meets ~save_map while it writes: on real files of a real map.

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "fault_catalogue.h"
#include "fiimap/mapper.h"
#include "fiimap/ros/map_files.h"

namespace fiimap {
namespace {

namespace fs = std::filesystem;

const char* const kName = "room";
const std::vector<std::string> kEndings = {"_occupied.pcd", "_inflated.pcd", ".bt"};

/// A map of a wall, or of nothing.
std::shared_ptr<const Snapshot> makeMap(bool with_wall) {
  MapperConfig config;
  config.map_size_x = config.map_size_y = 12.0;
  config.inflation_radius = 0.1;
  Mapper mapper(config);
  PointScan scan;
  for (int y = -30; with_wall && y <= 30; ++y) {
    for (int z = -10; z <= 10; ++z) scan.points.emplace_back(3.05F, 0.1F * y, 0.1F * z);
  }
  for (int i = 0; i < 5; ++i) mapper.integrate(scan, ScanPose());
  return mapper.snapshot();
}

std::string contentOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

class FileFaultTest : public testing::TestWithParam<Fault> {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("fiimap_file_fault_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    map_ = makeMap(true);
    ASSERT_GT(map_->count(Plane::kOccupied), 0);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string save(const Snapshot& map, const std::string& folder, const std::string& name) {
    try {
      return saveMap(map, folder, name);
    } catch (const std::exception& error) {
      return error.what();
    }
  }
  fs::path file(const std::string& ending) const { return folder_ / (kName + ending); }

  /// What complete files hold, by ending.
  std::map<std::string, std::string> completeFiles() const {
    std::map<std::string, std::string> contents;
    saveMap(*map_, folder_, kName);
    for (const std::string& ending : kEndings) {
      contents[ending] = contentOf(file(ending));
      fs::remove(file(ending));
    }
    return contents;
  }

  void expectTold(const std::string& message) const {
    for (const std::string& part : GetParam().says) {
      EXPECT_NE(message.find(part), std::string::npos) << message << " lacks " << part;
    }
  }
  void expectRefused(const std::string& folder, const std::string& name) const {
    expectTold(save(*map_, folder, name));
    EXPECT_TRUE(fs::is_empty(folder_)) << name;
  }

  void nameWithPath() {
    for (const char* name : {"../up", "/tmp/absolute", "a/b", "a/../b", "a\\b"}) {
      expectRefused(folder_, name);
    }
    EXPECT_FALSE(fs::exists(folder_.parent_path() / "up.bt"));
  }
  void strangeName() {
    for (const std::string& name :
         {std::string(), std::string(".hidden"), std::string("a b"), std::string("a\n"),
          std::string("a\0b", 3), std::string("\xC3\xA4"), std::string("~"), std::string("$x")}) {
      expectRefused(folder_, name);
    }
  }
  void longName() { expectRefused(folder_, std::string(300, 'a')); }
  void noDirectory() { expectRefused("", kName); }
  void missingDirectory() { expectRefused(folder_ / "missing", kName); }
  void fileForDirectory() {
    std::ofstream(folder_ / "file") << "x";
    expectTold(save(*map_, folder_ / "file", kName));
    EXPECT_EQ(contentOf(folder_ / "file"), "x");
  }
  // Of a file system that refuses everybody, because tests may run as root.
  void directoryNotWritable() { expectRefused("/proc", kName); }

  /// A limit of the size of files stands for the disk: both fail in the middle of a write.
  void fullDisk() {
    const auto complete = completeFiles();
    signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    std::size_t largest = 0;
    for (const auto& [ending, content] : complete) largest = std::max(largest, content.size());
    int refused = 0;
    for (std::size_t limit = 0; limit <= largest; limit += std::max<std::size_t>(largest / 40, 1)) {
      for (const std::string& ending : kEndings) std::ofstream(file(ending)) << "old";
      const rlimit small = {limit, before.rlim_max};
      setrlimit(RLIMIT_FSIZE, &small);
      const std::string message = save(*map_, folder_, kName);
      setrlimit(RLIMIT_FSIZE, &before);
      if (limit < largest) expectTold(message);
      refused += message.find("cannot be written") != std::string::npos;
      expectOldOrComplete(complete);
    }
    EXPECT_GT(refused, 1);
  }

  void expectOldOrComplete(const std::map<std::string, std::string>& complete) const {
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 3) << "parts were left";
    for (const auto& [ending, content] : complete) {
      const std::string now = contentOf(file(ending));
      EXPECT_TRUE(now == "old" || now == content) << ending << " of " << now.size() << " bytes";
    }
  }

  void existing() {
    const auto complete = completeFiles();
    for (const std::string& ending : kEndings) std::ofstream(file(ending)) << "old";
    expectTold(save(*map_, folder_, kName));
    for (const auto& [ending, content] : complete) EXPECT_EQ(contentOf(file(ending)), content);
  }
  void directoryForFile() {
    fs::create_directories(file(".bt") / "inside");
    expectTold(save(*map_, folder_, kName));
    EXPECT_TRUE(fs::exists(file(".bt") / "inside"));
    EXPECT_FALSE(fs::exists(folder_ / (std::string(".") + kName + ".bt.part")));
  }

  /// Kills processes that save again and again, each a little later than the one before.
  void interrupted() {
    const auto complete = completeFiles();
    constexpr int kKills = 20;
    constexpr int kStep = 400;  // us
    for (int i = 0; i < kKills; ++i) {
      const pid_t child = fork();
      if (child == 0) {
        while (true) save(*map_, folder_, kName);
      }
      usleep(static_cast<unsigned>(1 + i * kStep));
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
      for (const auto& [ending, content] : complete) {
        EXPECT_TRUE(!fs::exists(file(ending)) || contentOf(file(ending)) == content) << ending;
      }
    }
    EXPECT_NE(save(*map_, folder_, kName).find("wrote"), std::string::npos);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 3) << "parts were left";
  }

  void noObstacles() {
    expectTold(save(*makeMap(false), folder_, kName));
    EXPECT_TRUE(fs::is_empty(folder_));
  }
  void outOfOctomap() {
    MapperConfig config;
    Mapper mapper(config);
    PointScan scan;
    scan.points.emplace_back(3.0F, 0.0F, 0.0F);
    ScanPose pose;
    pose.T_W_S.translation().x() = pose.vehicle_W.x() = 1e5;
    for (int i = 0; i < 5; ++i) mapper.integrate(scan, pose);
    expectTold(save(*mapper.snapshot(), folder_, kName));
    EXPECT_TRUE(fs::exists(file("_occupied.pcd")));
    EXPECT_FALSE(fs::exists(file(".bt")));
  }

  using Make = void (FileFaultTest::*)();
  static const std::map<std::string, Make>& makers() {
    static const std::map<std::string, Make> all = {
        {"file_name_with_path", &FileFaultTest::nameWithPath},
        {"file_name_strange", &FileFaultTest::strangeName},
        {"file_name_long", &FileFaultTest::longName},
        {"file_no_directory", &FileFaultTest::noDirectory},
        {"file_directory_missing", &FileFaultTest::missingDirectory},
        {"file_directory_is_a_file", &FileFaultTest::fileForDirectory},
        {"file_directory_not_writable", &FileFaultTest::directoryNotWritable},
        {"file_disk_full", &FileFaultTest::fullDisk},
        {"file_exists", &FileFaultTest::existing},
        {"file_is_a_directory", &FileFaultTest::directoryForFile},
        {"file_interrupted", &FileFaultTest::interrupted},
        {"file_no_obstacles", &FileFaultTest::noObstacles},
        {"file_out_of_octomap", &FileFaultTest::outOfOctomap},
    };
    return all;
  }

  fs::path folder_;
  std::shared_ptr<const Snapshot> map_;
};

TEST_P(FileFaultTest, LeavesCompleteFilesOnly) { (this->*makers().at(GetParam().id))(); }

INSTANTIATE_TEST_SUITE_P(Catalogue, FileFaultTest, testing::ValuesIn(faultsOf("files")),
                         [](const auto& info) { return info.param.id; });

}  // namespace
}  // namespace fiimap
