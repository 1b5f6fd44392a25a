#!/usr/bin/python3
"""The path and the vehicle's marker show the poses of the scans, and are gone when the map is."""
import rosbag
import rospy
import rostest
from nav_msgs.msg import Path
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker

import make_bag_variants
from rostest_support import FLIGHT_BAG, PATIENT_QUEUES, MapTest, wait_for

SCANS = 20
MAX_ERROR = 1e-6  # m


def position_at(odometry, stamp):
    """Position between the two messages around a stamp."""
    after = next(i for i, pose in enumerate(odometry) if pose.header.stamp >= stamp)
    a, b = odometry[max(after - 1, 0)], odometry[after]
    gap = (b.header.stamp - a.header.stamp).to_sec()
    ratio = (stamp - a.header.stamp).to_sec() / gap if gap else 1.0
    p, q = a.pose.pose.position, b.pose.pose.position
    return [(1 - ratio) * getattr(p, axis) + ratio * getattr(q, axis) for axis in 'xyz']


class VehiclePathTest(MapTest):
    def start_and_listen(self, sensor, pose_source):
        form = sensor, pose_source
        self.bag = make_bag_variants.write_variants(FLIGHT_BAG, self.directory, SCANS, [form])[form]
        self.node, self.listener = self.start_map(
            {**PATIENT_QUEUES, 'sensor': sensor, 'pose_source': pose_source,
             'body_frame': 'base_link'})
        self.paths, self.markers = [], []
        for topic, kind, messages in (('path', Path, self.paths),
                                      ('vehicle', Marker, self.markers)):
            subscriber = rospy.Subscriber(f'/map/{topic}', kind, messages.append)
            self.addCleanup(subscriber.unregister)
            wait_for(subscriber.get_num_connections, topic)

    def play_to_end(self, scans=SCANS):
        """Plays the bag; the path and the marker at its end."""
        self.play(self.bag, '--rate=2')
        stamp = self.listener.wait_for_integrated(scans).header.stamp
        for messages in self.paths, self.markers:
            wait_for(lambda messages=messages: messages and messages[-1].header.stamp == stamp,
                     'the newest pose')
        return self.paths[-1], self.markers[-1]

    def check_shown(self, path, marker):
        self.assertEqual((path.header.frame_id, marker.header.frame_id), ('world', 'world'))
        self.assertEqual((marker.action, marker.pose), (Marker.ADD, path.poses[-1].pose))
        self.assertGreater(len(path.poses), 3)
        stamps = [pose.header.stamp for pose in path.poses]
        of_scans = [statistics.header.stamp for statistics in self.listener.statistics]
        self.assertEqual(stamps, [stamp for stamp in of_scans if stamp in stamps])

    def test_path_of_odometry(self):
        self.start_and_listen('points', 'odometry')
        path, marker = self.play_to_end()
        self.check_shown(path, marker)
        with rosbag.Bag(str(self.bag)) as bag:
            odometry = [message for _, message, _ in bag.read_messages(topics=['/odom'])]
        for pose in path.poses:
            expected = position_at(odometry, pose.header.stamp)
            for axis, value in zip('xyz', expected):
                self.assertLess(abs(getattr(pose.pose.position, axis) - value), MAX_ERROR)

        # Time goes back to the beginning, and so does the path.
        again, marker = self.play_to_end(2 * SCANS)
        self.assertIn('the map was forgotten', self.node.output())
        self.assertEqual([pose.pose for pose in again.poses], [pose.pose for pose in path.poses])

        response = rospy.ServiceProxy('/map/reset', Trigger)()
        self.assertTrue(response.success, response.message)
        wait_for(lambda: self.paths[-1].poses == [], 'an empty path')
        wait_for(lambda: self.markers[-1].action == Marker.DELETE, 'the end of the marker')
        self.assertEqual(self.markers[-1].ns, marker.ns)

    def test_path_of_tf(self):
        self.start_and_listen('depth', 'tf')
        self.check_shown(*self.play_to_end())


if __name__ == '__main__':
    rospy.init_node('vehicle_path_test')
    rostest.rosrun('fiimap', 'vehicle_path_test', VehiclePathTest)
