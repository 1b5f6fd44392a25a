// Every fault of faults.yaml that meets ~load_map in a file: on files of ~save_map.

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>

#include <gtest/gtest.h>

#include "fault_catalogue.h"
#include "fiimap/mapper.h"
#include "fiimap/ros/map_edits.h"
#include "fiimap/ros/map_files.h"

namespace fiimap {
namespace {

namespace fs = std::filesystem;

class MapLoadingFaultTest : public testing::TestWithParam<Fault> {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("fiimap_loading_fault_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    mapper_ = std::make_unique<Mapper>(config());
    PointScan scan;
    for (int y = -8; y <= 8; ++y) scan.points.emplace_back(1.05F, 0.1F * y, 0.05F);
    for (int i = 0; i < 5; ++i) mapper_->integrate(scan, ScanPose());
    saveMap(*mapper_->snapshot(), folder_, "room");
    for (const char* ending : {".bt", "_occupied.pcd"}) {
      std::ifstream stream(file(ending), std::ios::binary);
      whole_[ending] = std::string(std::istreambuf_iterator<char>(stream), {});
      ASSERT_GT(whole_[ending].size(), 100u);
    }
    fs::remove(file(".bt"));
    fs::remove(file("_occupied.pcd"));
  }
  void TearDown() override { fs::remove_all(folder_); }

  static MapperConfig config() {
    MapperConfig config;
    config.map_size_x = config.map_size_y = 6.0;
    config.map_size_z = 2.0;
    config.slide_distance = 0.1;
    return config;
  }
  fs::path file(const std::string& ending) const { return folder_ / ("room" + ending); }
  void write(const std::string& ending, const std::string& content) const {
    std::ofstream(file(ending), std::ios::binary | std::ios::trunc) << content;
  }

  static std::string load(const std::string& folder, const std::string& name, Mapper* mapper) {
    try {
      return loadMap(readMap(folder, name), LoadMap::Request(), mapper).message;
    } catch (const std::exception& error) {
      return error.what();
    }
  }
  void expectTold(const std::string& message) const {
    for (const std::string& part : GetParam().says) {
      EXPECT_NE(message.find(part), std::string::npos) << message << " lacks " << part;
    }
  }
  /// Loads a file of a content, which is then taken away.
  std::string loadContent(const std::string& ending, const std::string& content) {
    write(ending, content);
    const std::string message = load(folder_, "room", mapper_.get());
    fs::remove(file(ending));
    return message;
  }

  void nameWithPath() {
    for (const char* name : {"../up", "/tmp/absolute", "a/b", "", ".hidden", "a b"}) {
      expectTold(load(folder_, name, mapper_.get()));
    }
  }
  void noDirectory() { expectTold(load("", "room", mapper_.get())); }
  void missing() { expectTold(load(folder_, "room", mapper_.get())); }
  void noFile() {
    fs::create_directories(file(".bt"));
    expectTold(load(folder_, "room", mapper_.get()));
    fs::remove(file(".bt"));
    ASSERT_EQ(mkfifo(file(".bt").c_str(), S_IRUSR | S_IWUSR), 0);
    expectTold(load(folder_, "room", mapper_.get()));
  }
  void otherKind() {
    expectTold(loadContent(".bt", "<html>\n"));
    expectTold(loadContent(".bt", whole_["_occupied.pcd"]));
  }
  void cutOff() {
    for (const auto& [ending, content] : whole_) {
      for (std::size_t size = 0; size < content.size(); ++size) {
        expectTold(loadContent(ending, content.substr(0, size)));
      }
    }
  }
  void tooLong() {
    for (const auto& [ending, content] : whole_) expectTold(loadContent(ending, content + '\n'));
  }
  void otherBytes() {
    int refused = 0, loaded = 0;
    for (const auto& [ending, content] : whole_) {
      for (std::size_t i = 0; i < content.size(); ++i) {
        for (const char change : {'\x01', '\x80', '\xff'}) {
          std::string damaged = content;
          damaged[i] = static_cast<char>(damaged[i] ^ change);
          const std::string message = loadContent(ending, damaged);
          ++(message.rfind("loaded", 0) == 0 ? loaded : refused);
        }
      }
    }
    EXPECT_GT(refused, 100);
    EXPECT_GT(loaded, 0) << "a comment";
  }
  void tooDeep() {
    const std::string& content = whole_[".bt"];
    const std::size_t nodes = content.find("data\n") + 5;
    expectTold(loadContent(".bt", content.substr(0, nodes) + std::string(1 << 20, '\xff')));
  }
  void hugeClaim() {
    for (const auto& [ending, word] :
         std::map<std::string, std::string>{{".bt", "size "}, {"_occupied.pcd", "POINTS "}}) {
      std::string content = whole_[ending];
      content.insert(content.find(word) + word.size(), "99999999999");
      expectTold(loadContent(ending, content));
    }
  }
  void otherPcd() {
    std::string content = whole_["_occupied.pcd"];
    const std::size_t line = content.find("# resolution");
    content.erase(line, content.find('\n', line) + 1 - line);
    expectTold(loadContent("_occupied.pcd", content));
  }
  void otherResolution() {
    MapperConfig coarse = config();
    coarse.resolution = 0.2;
    coarse.slide_distance = 0.2;
    Mapper mapper(coarse);
    mapper.integrate(PointScan(), ScanPose());
    for (const auto& [ending, content] : whole_) {
      write(ending, content);
      expectTold(load(folder_, "room", &mapper));
      EXPECT_EQ(mapper.snapshot()->count(Plane::kKnown), 0);
      fs::remove(file(ending));
    }
  }
  void elsewhere() {
    Mapper mapper(config());
    ScanPose pose;
    pose.vehicle_W.x() = pose.T_W_S.translation().x() = 100.0;
    mapper.integrate(PointScan(), pose);
    for (const auto& [ending, content] : whole_) {
      write(ending, content);
      expectTold(load(folder_, "room", &mapper));
      EXPECT_EQ(mapper.snapshot()->count(Plane::kKnown), 0);
      fs::remove(file(ending));
    }
  }

  using Make = void (MapLoadingFaultTest::*)();
  static const std::map<std::string, Make>& makers() {
    static const std::map<std::string, Make> all = {
        {"loading_name_with_path", &MapLoadingFaultTest::nameWithPath},
        {"loading_no_directory", &MapLoadingFaultTest::noDirectory},
        {"loading_missing", &MapLoadingFaultTest::missing},
        {"loading_no_file", &MapLoadingFaultTest::noFile},
        {"loading_other_kind", &MapLoadingFaultTest::otherKind},
        {"loading_cut_off", &MapLoadingFaultTest::cutOff},
        {"loading_too_long", &MapLoadingFaultTest::tooLong},
        {"loading_other_bytes", &MapLoadingFaultTest::otherBytes},
        {"loading_too_deep", &MapLoadingFaultTest::tooDeep},
        {"loading_huge_claim", &MapLoadingFaultTest::hugeClaim},
        {"loading_other_pcd", &MapLoadingFaultTest::otherPcd},
        {"loading_resolution", &MapLoadingFaultTest::otherResolution},
        {"loading_elsewhere", &MapLoadingFaultTest::elsewhere},
    };
    return all;
  }

  fs::path folder_;
  std::map<std::string, std::string> whole_;  // contents of files, by ending
  std::unique_ptr<Mapper> mapper_;
};

TEST_P(MapLoadingFaultTest, IsRefusedWithASentence) {
  const std::shared_ptr<const Snapshot> before = mapper_->snapshot();
  (this->*makers().at(GetParam().id))();
  if (GetParam().id == "loading_other_bytes") return;
  const std::shared_ptr<const Snapshot> after = mapper_->snapshot();
  for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
    EXPECT_EQ(after->voxels(plane, after->window()), before->voxels(plane, before->window()));
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, MapLoadingFaultTest, testing::ValuesIn(faultsOf("loading")),
                         [](const auto& info) { return info.param.id; });

}  // namespace
}  // namespace fiimap
