#!/usr/bin/python3
"""Maps of recordings that do not come with the package.

  recordings_test.py kitchen|street

They lie in the folder that the environment variable FIIMAP_DATA names."""
import sys
import unittest

import rospy
import rostest

from rostest_support import PATIENT_QUEUES, MapTest, cut, recording

SCANS = 10
POINTS = {**PATIENT_QUEUES, 'sensor': 'points'}


class KitchenTest(MapTest):
    FILE = 'kitchen_a_cow_format.bag'
    SCAN_TOPIC = '/camera/depth_registered/points'

    def test_clouds_and_transforms(self):
        bag = cut(recording(self.FILE), self.directory / 'kitchen.bag', self.SCAN_TOPIC, SCANS)
        parameters = {**POINTS, 'pose_source': 'transform', 'resolution': 0.1,
                      'max_ray_length': 5.0, 'map_frame': 'vicon', 'extrinsics': 'parameter',
                      'extrinsic_translation': [0.00114049, 0.0450936, 0.0430765],
                      'extrinsic_rotation': [0.0924132, 0.0976455, 0.0702949, 0.9884249]}
        self.assert_same_map_offline(bag, parameters, f'points:={self.SCAN_TOPIC}',
                                     'transform:=/kinect/vrpn_client/estimated_transform')


class StreetTest(MapTest):
    FILE = 'kitti_street_a.bag'
    SCAN_TOPIC = '/velodyne_points'

    def cut(self):
        return cut(recording(self.FILE), self.directory / 'street.bag', self.SCAN_TOPIC, SCANS)

    def test_clouds_and_odometry(self):
        parameters = {**POINTS, 'resolution': 0.2, 'max_ray_length': 30.0,
                      'local_update_range_x': 60.0, 'local_update_range_y': 60.0}
        self.assert_same_map_offline(self.cut(), parameters, f'points:={self.SCAN_TOPIC}')

    def test_launch_file(self):
        listener = self.listen('fiimap')
        # With names of topics, playing waits for their subscribers.
        launch = self.start('roslaunch', 'fiimap', 'lidar.launch', f'bag:={self.cut()}',
                            f'bag_topics:={self.SCAN_TOPIC} /odom /tf_static')
        self.assertGreater(listener.wait_for_received(SCANS).occupied, 1000)
        self.assertEqual(set(listener.dropped()) - {'overload'}, set(), launch.output())
        self.assertEqual(launch.interrupt(), 0, launch.output())


def skipping_test(file):
    """A test whose name tells in the summary why the others did not run."""
    def skip(_):
        raise unittest.SkipTest(f'no {file}')
    # Without a dot, at which the summary would cut it.
    name = f'test_SKIPPED_set_FIIMAP_DATA_to_the_folder_with_{file.replace(".bag", "")}'
    return type('SkippedTest', (unittest.TestCase,), {name: skip})


def main():
    name = sys.argv[1]
    test = {'kitchen': KitchenTest, 'street': StreetTest}[name]
    if recording(test.FILE) is None:
        test = skipping_test(test.FILE)
    rospy.init_node(f'recordings_{name}_test')
    rostest.rosrun('fiimap', f'recordings_{name}', test)


if __name__ == '__main__':
    main()
