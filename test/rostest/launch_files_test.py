#!/usr/bin/python3
"""The launch files make maps of the recordings that come with the package, as they are."""
import rospy
import rostest
from nav_msgs.msg import Path
from visualization_msgs.msg import Marker

from rostest_support import FLIGHT_BAG, PATIENCE, MapTest, cut, program, wait_for

COW_SCANS = 4


class LaunchFilesTest(MapTest):
    def launch(self, file, *arguments):
        listener = self.listen('fiimap')
        launch = self.start('roslaunch', 'fiimap', file, *arguments)
        return launch, listener

    def check_end(self, launch):
        self.assertEqual(launch.interrupt(), 0, launch.output())
        self.assertNotIn('escalating', launch.output())
        self.assertNotIn('process has died', launch.output())

    def test_cow_and_lady(self):
        launch, listener = self.launch('cow_and_lady.launch')
        newest = listener.wait_for_integrated(COW_SCANS)
        self.assertEqual((newest.received, newest.dropped), (COW_SCANS, 0))
        self.assertEqual(newest.header.frame_id, 'vicon')
        self.assertGreater(newest.occupied, 100)
        # There is no odometry and no TF, and rviz still has something to show.
        for topic, kind in (('path', Path), ('vehicle', Marker)):
            shown = rospy.wait_for_message(f'/fiimap/{topic}', kind, PATIENCE)
            self.assertEqual((shown.header.stamp, shown.header.frame_id),
                             (newest.header.stamp, 'vicon'), topic)
        self.check_end(launch)

    def test_replay_of_the_flight(self):
        # Faster and with an end, so that the launch file's own end is tried too.
        launch, listener = self.launch('replay.launch', 'rate:=2', 'exit_at_end:=true')
        self.assertEqual(launch.wait(), 0, launch.output())
        newest = listener.newest()
        self.assertGreater(newest.integrated, 0, launch.output())
        self.assertEqual(set(listener.dropped()) - {'overload'}, set(), launch.output())
        self.assertGreater(newest.occupied, 1000)

    def test_mapping_into_a_running_manager(self):
        self.start(program('nodelet', 'nodelet'), 'manager', '__name:=manager')
        rospy.wait_for_service('/manager/list')
        launch, listener = self.launch('mapping.launch', 'manager:=manager')
        scans = 5
        bag = cut(FLIGHT_BAG, self.directory / 'flight.bag', '/camera/depth/image_rect_raw', scans)
        self.play(bag)
        listener.wait_for_received(scans)
        self.check_end(launch)


if __name__ == '__main__':
    rospy.init_node('launch_files_test')
    rostest.rosrun('fiimap', 'launch_files_test', LaunchFilesTest)
