#!/usr/bin/python3
"""demo.launch flies, and tells how the flight ended."""
import json

import rospy
import rostest

from rostest_support import MapTest


class DemoTest(MapTest):
    def fly(self, *arguments):
        """The result of a flight, and what was printed."""
        report = self.directory / 'flight.json'
        launch = self.start('roslaunch', 'fiimap', 'demo.launch', 'rviz:=false',
                            f'report:={report}', *arguments)
        launch.wait()
        output = launch.output()
        self.assertNotIn('FATAL', output)
        self.assertIn('flight: end', output)
        return json.loads(report.read_text())

    def test_reaches_its_goal_in_simulated_time(self):
        result = self.fly('simulated_time:=true', 'world:=shelf_room')
        self.assertTrue(result['reached'], result)
        self.assertEqual(result['collisions'], 0, result)
        self.assertEqual(result['scans_dropped'], 0, result)

    def test_flies_in_real_time_and_ends_when_time_is_up(self):
        rospy.set_param('/use_sim_time', False)
        result = self.fly('time_limit:=3')
        self.assertEqual(result['end'], 'time is up')
        self.assertGreater(result['scans'], 0)


if __name__ == '__main__':
    rospy.init_node('demo_test')
    rostest.rosrun('fiimap', 'demo_test', DemoTest)
