#include "status_markers.h"

#include <gtest/gtest.h>

namespace fiimap {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kResolution = 0.5;  // m

class StatusMarkersTest : public testing::Test {
 protected:
  StatusMarkersTest() : grid_(VoxelIndex(8, 6, 4)) {
    ChangeSet changes;
    grid_.moveTo(VoxelIndex(-4, -3, -2), &changes);
    update_.pose.vehicle_W = Eigen::Vector3d(0.2, 0.2, 0.2);  // in voxel (0, 0, 0)
  }

  /// The map as it is now becomes that of the update.
  std::shared_ptr<const Snapshot> takeSnapshot() {
    Snapshot::Info info;
    info.resolution = kResolution;
    update_.snapshot = std::make_shared<const Snapshot>(&grid_, info);
    return update_.snapshot;
  }

  Marker marker(const std::string& name, const Snapshot* before = nullptr) const {
    for (const Marker& marker : toStatusMarkers(update_, before, "map").markers) {
      if (marker.ns == name) return marker;
    }
    throw std::out_of_range(name);
  }
  std::string text() const { return marker("statistics").text; }

  SlidingGrid grid_;
  MapUpdate update_;
};

TEST_F(StatusMarkersTest, CellShowsTheStateOfTheVehiclesVoxel) {
  std::vector<std_msgs::ColorRGBA> colors;
  const auto look = [&](const std::string& state) {
    takeSnapshot();
    const Marker cell = marker("cell");
    EXPECT_EQ(cell.header.frame_id, "map");
    EXPECT_EQ(cell.pose.position.x, 0.25);
    EXPECT_NEAR(cell.scale.x, kResolution, 0.1 * kResolution);
    EXPECT_NE(text().find("vehicle in " + state), std::string::npos) << text();
    for (const std_msgs::ColorRGBA& other : colors) EXPECT_FALSE(other == cell.color) << state;
    colors.push_back(cell.color);
  };
  look("unknown space");
  grid_.set(Plane::kKnown, {0, 0, 0}, true);
  look("free space");
  grid_.set(Plane::kInflated, {0, 0, 0}, true);
  look("the inflation of an obstacle");
  grid_.set(Plane::kOccupied, {0, 0, 0}, true);
  look("an obstacle");
  update_.pose.vehicle_W.x() = 100.0;
  EXPECT_NE(text().find("vehicle outside of the map"), std::string::npos) << text();
}

TEST_F(StatusMarkersTest, ShowsWhatAppearedAndWhatIsGone) {
  grid_.set(Plane::kOccupied, {1, 1, 1}, true);
  const auto before = takeSnapshot();
  grid_.set(Plane::kOccupied, {1, 1, 1}, false);
  grid_.set(Plane::kOccupied, {2, 2, 0}, true);
  grid_.set(Plane::kOccupied, {2, 2, 1}, true);
  takeSnapshot();
  const Marker appeared = marker("appeared", before.get()), gone = marker("gone", before.get());
  ASSERT_EQ(appeared.points.size(), 2u);
  EXPECT_EQ(appeared.points[0].z, 0.25);
  EXPECT_EQ(appeared.points[1].z, 0.75);
  ASSERT_EQ(gone.points.size(), 1u);
  EXPECT_EQ(gone.points[0].x, 0.75);
}

TEST_F(StatusMarkersTest, WhereNothingChangedTheListsGoAway) {
  const auto before = takeSnapshot();
  takeSnapshot();
  EXPECT_EQ(marker("appeared", before.get()).action, Marker::DELETE);
  EXPECT_EQ(marker("gone", before.get()).action, Marker::DELETE);
  EXPECT_EQ(marker("appeared").action, Marker::DELETE);
}

TEST_F(StatusMarkersTest, TextTellsTheFigures) {
  grid_.set(Plane::kOccupied, {1, 1, 1}, true);
  takeSnapshot();
  update_.counters.received = 12;
  update_.report.lower = 34;
  update_.report.raise = 56;
  update_.memory_bytes = 7'800'000;
  EXPECT_NE(text().find("1 occupied, 0 inflated, 7.8 MB"), std::string::npos) << text();
  EXPECT_NE(text().find("34 became occupied, 56 free"), std::string::npos) << text();
  EXPECT_NE(text().find("12 scans, 0 of them dropped"), std::string::npos) << text();
}

TEST(NoStatusMarkersTest, TakeAllAway) {
  const MarkerArray markers = noStatusMarkers("map");
  ASSERT_EQ(markers.markers.size(), 1u);
  EXPECT_EQ(markers.markers[0].action, Marker::DELETEALL);
  EXPECT_EQ(markers.markers[0].header.frame_id, "map");
}

}  // namespace
}  // namespace fiimap
