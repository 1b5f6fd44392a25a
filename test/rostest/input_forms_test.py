#!/usr/bin/python3
"""The mapping node makes the same map as the offline tool, whatever form its input has."""
import tempfile

import rospy
import rostest

import make_bag_variants
from rostest_support import FLIGHT_BAG, PATIENT_QUEUES, MapTest, cut, recording

SCANS = 30
RESOLUTION = 0.1


class InputFormsTest(MapTest):
    @classmethod
    def setUpClass(cls):
        cls.bag_folder = tempfile.TemporaryDirectory()
        cls.bags = make_bag_variants.write_variants(FLIGHT_BAG, cls.bag_folder.name, SCANS)

    @classmethod
    def tearDownClass(cls):
        cls.bag_folder.cleanup()

    def compare_with_offline(self, bag, parameters, *remappings):
        offline = self.evaluate(bag, parameters)
        self.assertEqual(offline['integrated'], offline['scans'], offline['warnings'])
        _, listener = self.start_map(parameters, *remappings)
        self.play(bag, '--rate=2')
        newest = listener.wait_for_integrated(offline['integrated'])
        self.assertEqual(newest.received, offline['scans'])
        self.assertEqual((newest.occupied, newest.inflated),
                         (offline['occupied'], offline['inflated']))
        self.assert_clouds_equal_offline(listener, parameters['resolution'])

    def check_form(self, sensor, pose_source):
        parameters = {**PATIENT_QUEUES, 'sensor': sensor, 'pose_source': pose_source,
                      'resolution': RESOLUTION, 'map_frame': 'world', 'body_frame': 'base_link'}
        self.compare_with_offline(self.bags[sensor, pose_source], parameters)

    def test_kitchen_clouds_and_transforms(self):
        bag = cut(recording('kitchen_a_cow_format.bag'), self.directory / 'kitchen.bag',
                  '/camera/depth_registered/points', 10)
        parameters = {**PATIENT_QUEUES, 'sensor': 'points', 'pose_source': 'transform',
                      'resolution': 0.1, 'max_ray_length': 5.0, 'map_frame': 'vicon',
                      'extrinsics': 'parameter',
                      'extrinsic_translation': [0.00114049, 0.0450936, 0.0430765],
                      'extrinsic_rotation': [0.0924132, 0.0976455, 0.0702949, 0.9884249]}
        self.compare_with_offline(bag, parameters, 'points:=/camera/depth_registered/points',
                                  'transform:=/kinect/vrpn_client/estimated_transform')

    def test_street_lidar_and_odometry(self):
        bag = cut(recording('kitti_street_a.bag'), self.directory / 'street.bag',
                  '/velodyne_points', 10)
        parameters = {**PATIENT_QUEUES, 'sensor': 'points', 'resolution': 0.2,
                      'max_ray_length': 30.0, 'local_update_range_x': 60.0,
                      'local_update_range_y': 60.0}
        self.compare_with_offline(bag, parameters, 'points:=/velodyne_points')


def add_tests():
    for sensor, pose_source in make_bag_variants.FORMS:
        def test(self, sensor=sensor, pose_source=pose_source):
            self.check_form(sensor, pose_source)
        setattr(InputFormsTest, f'test_{sensor}_and_{pose_source}', test)


if __name__ == '__main__':
    add_tests()
    rospy.init_node('input_forms_test')
    rostest.rosrun('fiimap', 'input_forms_test', InputFormsTest)
