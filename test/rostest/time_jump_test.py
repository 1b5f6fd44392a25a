#!/usr/bin/python3
"""A bag that begins again starts a new map, which is the same as that of a single pass."""
import rospy
import rostest

import make_bag_variants
from rostest_support import FLIGHT_BAG, PATIENT_QUEUES, MapTest, program

SCANS = 20
RESOLUTION = 0.1


class TimeJumpTest(MapTest):
    def play_twice(self, sensor, pose_source):
        form = sensor, pose_source
        bag = make_bag_variants.write_variants(FLIGHT_BAG, self.directory, SCANS, [form])[form]
        parameters = {**PATIENT_QUEUES, 'sensor': sensor, 'pose_source': pose_source,
                      'resolution': RESOLUTION}
        self.evaluate(bag, parameters)
        node, listener = self.start_map(parameters)
        self.play(bag, '--rate=2')
        listener.wait_for_integrated(SCANS)
        self.assertNotIn('the map was forgotten', node.output())

        self.play(bag, '--rate=2')
        newest = listener.wait_for_integrated(2 * SCANS)
        self.assertIn('the map was forgotten', node.output())
        self.assertEqual((newest.received, newest.dropped), (2 * SCANS, 0))
        self.assert_clouds_equal_offline(listener, RESOLUTION)

        sequences = [statistics.sequence for statistics in listener.statistics]
        self.assertEqual(sequences, sorted(set(sequences)))

    def test_clouds_and_odometry(self):
        self.play_twice('points', 'odometry')

    def test_depth_and_tf(self):
        self.play_twice('depth', 'tf')

    def test_endless_loop(self):
        form = ('depth', 'odometry')
        bag = make_bag_variants.write_variants(FLIGHT_BAG, self.directory, SCANS, [form])[form]
        node, listener = self.start_map(PATIENT_QUEUES)
        player = self.start(program('rosbag', 'play'), '--quiet', '--clock', '--loop', '--rate=2',
                            '--wait-for-subscribers', bag)
        listener.wait_for_integrated(3 * SCANS)
        player.interrupt()
        self.assertGreaterEqual(node.output().count('the map was forgotten'), 2)
        self.assertEqual(set(listener.dropped()) - {'time_jump'}, set())


if __name__ == '__main__':
    rospy.init_node('time_jump_test')
    rostest.rosrun('fiimap', 'time_jump_test', TimeJumpTest)
