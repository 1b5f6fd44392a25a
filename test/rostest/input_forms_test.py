#!/usr/bin/python3
"""The mapping node makes the same map as the offline tool, whatever form its input has."""
import tempfile

import rospy
import rostest

import make_bag_variants
from rostest_support import FLIGHT_BAG, PATIENT_QUEUES, MapTest

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

    def check_form(self, sensor, pose_source):
        parameters = {**PATIENT_QUEUES, 'sensor': sensor, 'pose_source': pose_source,
                      'resolution': RESOLUTION, 'map_frame': 'world', 'body_frame': 'base_link'}
        self.assert_same_map_offline(self.bags[sensor, pose_source], parameters)


def add_tests():
    for sensor, pose_source in make_bag_variants.FORMS:
        def test(self, sensor=sensor, pose_source=pose_source):
            self.check_form(sensor, pose_source)
        setattr(InputFormsTest, f'test_{sensor}_and_{pose_source}', test)


if __name__ == '__main__':
    add_tests()
    rospy.init_node('input_forms_test')
    rostest.rosrun('fiimap', 'input_forms_test', InputFormsTest)
