#!/usr/bin/python3
"""The doctor on a live graph, and the launch lines that it prints, typed as they are."""
import re
import shlex
import subprocess

import rospy
import rostest

from make_bag_variants import write_two_sensors
from rostest_support import FLIGHT_BAG, MapTest, program, wait_for

NOTHING_WRONG, PROBLEMS, CANNOT_LOOK = 0, 1, 2
IMAGE, INFO = '/camera/depth/image_rect_raw', '/camera/depth/camera_info'
ENOUGH = 5  # scans


class DoctorTest(MapTest):
    def setUp(self):
        rospy.set_param('/use_sim_time', True)
        for name in ('/fiimap', '/map', '/drone1'):
            if rospy.has_param(name):
                rospy.delete_param(name)

    def loop(self, *topics, options=('--clock',), bag=FLIGHT_BAG):
        """Plays a bag again and again: all of it, or some topics."""
        choice = ['--topics', *topics] if topics else []
        player = self.start(program('rosbag', 'play'), '--quiet', '--loop', *options, bag, *choice)
        wait_for(lambda: '/odom' in dict(rospy.get_published_topics()), 'the player')
        return player

    def ask(self, *arguments):
        """Exit status, what was said without line breaks, and the commands to be typed."""
        result = subprocess.run(['rosrun', 'fiimap', 'doctor', *map(str, arguments)],
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=90,
                                universal_newlines=True)
        line = re.search(r'^roslaunch (.*\\\n)*.*', result.stdout, re.MULTILINE)
        said = ' '.join(result.stdout.split())
        return result.returncode, said, shlex.split(line.group(0).replace('\\\n', '')) if line else []

    def assert_says(self, answer, status, *sentences):
        self.assertEqual(answer[0], status, answer[1])
        for sentence in sentences:
            self.assertRegex(answer[1], sentence)

    def assert_leads_to_a_map(self, words, name='fiimap', sensors=('',)):
        listener = self.listen(name)
        launch = self.start(*words)
        listener.wait_for_integrated(ENOUGH)
        wait_for(lambda: {each.sensor for each in listener.statistics} == set(sensors),
                 f'scans of {sensors}')
        # Waited for: a bag that starts again clears the map.
        wait_for(lambda: listener.newest().occupied > 100, 'occupied voxels')
        self.assertEqual(launch.interrupt(), 0, launch.output())

    def test_line_for_the_sample(self):
        answer = self.ask(FLIGHT_BAG)
        self.assert_says(answer, NOTHING_WRONG, '110 of the 110 scans')
        self.assertIn('replay.launch', answer[2])
        self.assert_leads_to_a_map(answer[2])

    def test_line_for_a_live_graph(self):
        self.loop()
        answer = self.ask('--seconds', 4)
        self.assert_says(answer, NOTHING_WRONG, 'Launch line')
        self.assertIn('mapping.launch', answer[2])
        self.assert_leads_to_a_map(answer[2])

    def test_line_that_stands_in_for_tf(self):
        self.loop(IMAGE, INFO, '/odom')
        answer = self.ask()
        self.assert_says(answer, PROBLEMS, 'there is no TF', 'static_transform_publisher')
        self.assert_leads_to_a_map(answer[2])

    def test_no_camera_info(self):
        self.loop(IMAGE, '/odom', '/tf', '/tf_static')
        answer = self.ask('--seconds', 3)
        self.assert_says(answer, PROBLEMS, f'{IMAGE} has no camera_info', 'No launch line')
        self.assertEqual(answer[2], [])

    def test_simulated_time_that_was_forgotten(self):
        rospy.set_param('/use_sim_time', False)
        self.loop()
        answer = self.ask('--seconds', 3)
        self.assert_says(answer, PROBLEMS, '/use_sim_time is not set',
                         'rosparam set /use_sim_time true roslaunch fiimap')

    def test_simulated_time_that_stands_still(self):
        self.loop(options=())
        answer = self.ask('--seconds', 3)
        self.assert_says(answer, PROBLEMS, '/use_sim_time is true, but no time comes on /clock')

    def test_an_empty_graph(self):
        rospy.set_param('/use_sim_time', False)
        answer = self.ask('--seconds', 1)
        self.assert_says(answer, PROBLEMS, 'no depth images', 'There are no poses')

    def test_a_map_that_runs(self):
        self.loop()
        _, listener = self.start_map({'sensor': 'depth'}, f'depth/image:={IMAGE}',
                                     f'depth/camera_info:={INFO}')
        listener.wait_for_integrated(ENOUGH)
        answer = self.ask('--map', 'map')
        self.assert_says(answer, NOTHING_WRONG, 'A map runs: /map', 'has what it needs')
        self.assert_says(self.ask('--map', 'other', '--seconds', 1), CANNOT_LOOK,
                         'error: --map other: no such map runs; there are: /map')

    def test_a_map_that_listens_to_nothing(self):
        self.loop()
        self.start_map({'sensor': 'depth', 'map_frame': 'map'}, f'depth/camera_info:={INFO}')
        answer = self.ask()
        self.assert_says(answer, PROBLEMS,
                         'listens to /depth/image for depth images, which nobody publishes',
                         "in the frame 'world', but map_frame is 'map'",
                         '/map says: no scans received on /depth/image')
        self.assertIn(f'depth_image:={IMAGE}', answer[2])
        self.assertIn('map_frame:=world', answer[2])

    def two_sensors(self):
        bag = self.directory / 'two_sensors.bag'
        write_two_sensors(FLIGHT_BAG, bag, 40)
        return bag

    def test_line_for_a_recording_of_two_sensors(self):
        answer = self.ask(self.two_sensors())
        self.assert_says(answer, NOTHING_WRONG, 'One map is made of 2 sensors')
        self.assertIn('replay.launch', answer[2])
        self.assert_leads_to_a_map(answer[2], sensors=('front', 'lidar'))

    def test_a_map_of_two_sensors_that_hears_one(self):
        self.loop(bag=self.two_sensors())
        process, listener = self.start_map(
            {'sensors': ['eye', 'lidar'], 'lidar': {'sensor': 'points', 'max_ray_length': 6.5}},
            'eye/depth/image:=/front/depth/image_raw',
            'eye/depth/camera_info:=/front/depth/camera_info', 'lidar/points:=/nowhere')
        listener.wait_for_integrated(ENOUGH)
        answer = self.ask()
        self.assert_says(answer, PROBLEMS, "'eye' .*on /front/depth/image_raw",
                         "listens to /nowhere, which nobody publishes, for its sensor 'lidar'; "
                         'found: /lidar/points', 'The line keeps what /map has set: .*max_ray_length')
        self.assertEqual(process.interrupt(), 0, process.output())
        rospy.delete_param('/map')
        self.assert_leads_to_a_map(answer[2], 'map', ('eye', 'lidar'))
        self.assertEqual(rospy.get_param('/map/lidar/max_ray_length'), 6.5)

    def test_a_map_in_a_namespace_and_a_manager(self):
        self.loop()
        self.start(program('nodelet', 'nodelet'), 'manager', '__name:=manager', '__ns:=/drone1')
        rospy.wait_for_service('/drone1/manager/list')
        self.set_parameters({'sensor': 'depth', 'max_depth': 5.5}, 'drone1/map')
        listener = self.listen('drone1/map')
        loader = self.start(program('nodelet', 'nodelet'), 'load', 'fiimap/MappingNodelet',
                            '/drone1/manager', '__name:=map', '__ns:=/drone1',
                            f'depth/camera_info:={INFO}', 'odom:=/odom')
        self.wait_for_map(listener, loader)
        answer = self.ask()
        self.assert_says(answer, PROBLEMS, 'A map runs: /drone1/map',
                         'listens to /drone1/depth/image .*which nobody publishes',
                         'End the map that runs first: rosnode kill /drone1/map')
        for word in ('__ns:=/drone1', 'name:=map', 'manager:=/drone1/manager'):
            self.assertIn(word, answer[2])
        self.assertEqual(loader.interrupt(), 0, loader.output())
        rospy.delete_param('/drone1/map')
        self.assert_leads_to_a_map(answer[2], 'drone1/map')
        self.assertEqual(rospy.get_param('/drone1/map/max_depth'), 5.5)


if __name__ == '__main__':
    rospy.init_node('doctor_test')
    rostest.rosrun('fiimap', 'doctor_test', DoctorTest)
