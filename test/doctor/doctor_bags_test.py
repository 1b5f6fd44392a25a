#!/usr/bin/python3
"""The doctor on the recordings of the package, and on one that is spoiled in many ways: exit status
and sentences.

  doctor_bags_test.py DOCTOR
"""
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest

import rosbag
import rospy
from geometry_msgs.msg import PoseStamped
from rosgraph_msgs.msg import Clock

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / 'test' / 'rostest'))
from make_bag_variants import write_two_sensors  # noqa: E402
FLIGHT = SOURCE / 'data' / 'synth_flight_excerpt.bag'
COW = SOURCE / 'data' / 'cow_and_lady_excerpt.bag'
DOCTOR = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else ''
IMAGE, INFO = '/camera/depth/image_rect_raw', '/camera/depth/camera_info'
SCANS = 12
NOTHING_WRONG, PROBLEMS, CANNOT_LOOK = 0, 1, 2


def without(*topics):
    return lambda topic, message: None if topic in topics else (topic, message)


def of(chosen, change):
    """A change of the messages of one topic, in place."""
    def apply(topic, message):
        if topic == chosen:
            change(message)
        return topic, message
    return apply


def set_field(path, value):
    def change(message):
        *parents, last = path.split('.')
        for name in parents:
            message = getattr(message, name)
        setattr(message, last, value)
    return change


def every_50th(topic, message):
    every_50th.count += topic == '/odom'
    return None if topic == '/odom' and every_50th.count % 50 else (topic, message)


every_50th.count = 0


def as_tenths(image):
    values = struct.unpack(f'<{image.width * image.height}H', image.data)
    image.data = struct.pack(f'<{len(values)}H', *(min(10 * value, 65535) for value in values))


def as_millimetre_floats(image):
    values = struct.unpack(f'<{image.width * image.height}H', image.data)
    image.encoding, image.step = '32FC1', 4 * image.width
    image.data = struct.pack(f'<{len(values)}f', *values)


def as_pose(topic, message):
    if topic != '/odom':
        return topic, message
    return '/pose', PoseStamped(header=message.header, pose=message.pose.pose)


def earlier(seconds):
    def change(message):
        message.header.stamp -= rospy.Duration.from_sec(seconds)
    return change


# Name: change, exit status, what is said, what the launch line holds (None: there is none).
SPOILED = {
    'nothing': (lambda *both: both, NOTHING_WRONG, ['Launch line'], ['map_frame:=world']),
    'no camera_info': (without(INFO), PROBLEMS, [f'{IMAGE} has no camera_info'], None),
    'camera_info of another size': (
        of(INFO, set_field('width', 1280)), PROBLEMS,
        ['describes an image of 1280 x 480, the depth image is 640 x 480'], None),
    'no poses': (without('/odom', '/tf'), PROBLEMS, ['There are no poses'], None),
    'poses on TF only': (without('/odom'), NOTHING_WRONG, ['Poses come from TF'],
                         ['pose_source:=tf', 'map_frame:=world', 'body_frame:=base_link']),
    'a PoseStamped': (as_pose, NOTHING_WRONG, ['do not name their body'],
                      ['pose_source:=pose', 'pose:=/pose', 'body_frame:=base_link']),
    'no TF': (without('/tf', '/tf_static'), PROBLEMS,
              ['there is no TF', 'static_transform_publisher X Y Z -0.5 0.5 -0.5 0.5 base_link'],
              ['extrinsics: parameter']),
    'no body': (of('/odom', set_field('child_frame_id', '')), PROBLEMS,
                ['child_frame_id is empty'], ['body_frame:=base_link']),
    'an unknown body': (of('/odom', set_field('child_frame_id', 'imu')), PROBLEMS,
                        ["body of the poses is 'imu', but TF does not know it"],
                        ['body_frame:=base_link']),
    'a quaternion of zeros': (of('/odom', set_field('pose.pose.orientation.w', float('nan'))),
                              PROBLEMS, ['poses of /odom are none', 'not finite'], None),
    'a body frame for an image': (of(IMAGE, set_field('header.frame_id', 'base_link')), PROBLEMS,
                                  ["'base_link', which is a body frame", 'would look up'],
                                  ['extrinsic_rotation: [-0.5, 0.5, -0.5, 0.5]']),
    'slow poses': (every_50th, PROBLEMS, ['come at 2.0 Hz', 'max_pose_gap'],
                   ['max_pose_gap: 0.75']),
    'late images': (of(IMAGE, earlier(0.2)), NOTHING_WRONG,
                    ['Stamps of scans and poses are 0.2.. s apart', 'time_offset'], ['odom:=/odom']),
    'another clock': (of(IMAGE, earlier(30.0)), PROBLEMS, ['different clocks'],
                      ['time_offset: 30.0']),
    'tenths of millimetres': (of(IMAGE, as_tenths), PROBLEMS, ['probably in another unit'],
                              ['depth_scale: 0.0001']),
    'millimetres as floats': (of(IMAGE, as_millimetre_floats), PROBLEMS,
                              ['wrong unit', 'look like millimetres'], None),
    'no depth': (of(IMAGE, lambda image: setattr(image, 'data', bytes(len(image.data)))), PROBLEMS,
                 ['No pixel of .* has a depth: 100 % are 0'], None),
    'colour for depth': (of(IMAGE, set_field('encoding', 'rgb8')), PROBLEMS,
                         [r'no depth images .* /camera/depth/image_rect_raw \(rgb8\)'], None),
}


class DoctorBagsTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.bag = pathlib.Path(temporary.name) / 'flight.bag'

    def ask(self, *arguments):
        """Exit status, what was said without line breaks, and the launch line or None."""
        result = subprocess.run([DOCTOR, *map(str, arguments)], universal_newlines=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=300)
        said = ' '.join((result.stdout + result.stderr).split())
        line = re.search(r'^roslaunch .*', result.stdout, re.MULTILINE | re.DOTALL)
        return result.returncode, said, line and line.group(0)

    def check(self, answer, status, words, line_words):
        code, said, line = answer
        self.assertEqual(code, status, said)
        for word in words:
            self.assertRegex(said, word)
        if line_words is None:
            self.assertIsNone(line, said)
            self.assertIn('No launch line would lead to a map', said)
            return
        self.assertIsNotNone(line, said)
        for word in line_words:
            self.assertIn(word, line)

    def spoil(self, change):
        """The beginning of the flight, each message changed; None: left out."""
        left = SCANS
        with rosbag.Bag(str(FLIGHT)) as source, rosbag.Bag(str(self.bag), 'w') as target:
            for topic, message, time, header in source.read_messages(return_connection_header=True):
                left -= topic == IMAGE
                if left < 0:
                    return
                changed = change(topic, message)
                if changed:
                    own_header = header if changed[0] == topic else None
                    target.write(*changed, time, connection_header=own_header)

    def test_spoiled_recordings(self):
        for name, (change, *expected) in SPOILED.items():
            with self.subTest(name):
                self.spoil(change)
                self.check(self.ask(self.bag), *expected)

    def test_recordings_of_the_package(self):
        self.check(self.ask(FLIGHT), NOTHING_WRONG, ['110 of the 110 scans'],
                   [f'bag:={FLIGHT}', f'depth_image:={IMAGE}', f'camera_info:={INFO}',
                    'pose_source:=odometry', 'odom:=/odom', 'map_frame:=world'])
        self.check(self.ask(COW), PROBLEMS, ["on the body 'kinect': there is no TF"],
                   ['sensor:=points', 'pose_source:=transform', 'map_frame:=vicon'])
        # Told where the camera is, it has nothing to say.
        self.check(self.ask(COW, '--set', 'extrinsics=parameter', '--set',
                            'extrinsic_rotation=0.0924132 0.0976455 0.0702949 0.9884249'),
                   NOTHING_WRONG, ['4 of the 4 scans'],
                   ['extrinsic_rotation: [0.0924132, 0.0976455, 0.0702949, 0.9884249]'])

    def test_a_part_of_a_recording(self):
        code, said, _ = self.ask(FLIGHT, '--start', 4, '--seconds', 2)
        self.assertEqual(code, NOTHING_WRONG, said)
        self.assertRegex(said, r'flight_excerpt.bag, 2\.0 s')
        self.assertRegex(said, r'(19|20) of the 20 scans')

    def test_wishes(self):
        self.check(self.ask(FLIGHT, '--set', 'map_frame=map'), PROBLEMS,
                   ["in the frame 'world', but map_frame is 'map'"], ['map_frame:=world'])
        self.check(self.ask(FLIGHT, '--set', 'resolution=0.2'), NOTHING_WRONG, [],
                   ["parameters:='{resolution: 0.2}'"])

    def test_a_recording_with_its_clock(self):
        self.spoil(lambda *both: both)
        with rosbag.Bag(str(self.bag), 'a') as bag:
            begin = rospy.Time.from_sec(bag.get_start_time())
            bag.write('/clock', Clock(begin), begin)
        self.check(self.ask(self.bag), NOTHING_WRONG, ['holds /clock'],
                   [f"bag_topics:='{IMAGE} {INFO} /odom /tf /tf_static'"])

    def test_a_camera_and_a_lidar(self):
        write_two_sensors(FLIGHT, self.bag, SCANS)
        self.check(self.ask(self.bag), NOTHING_WRONG,
                   ["One map is made of 2 sensors: 'front' .*, 'lidar' .*on /lidar/points",
                    'map: front 6 of 6, lidar 6 of 6'],
                   ["topics:='front/depth/image=/front/depth/image_raw "
                    'front/depth/camera_info=/front/depth/camera_info lidar/points=/lidar/points\'',
                    'sensors: [front, lidar], lidar: {', 'sensor: points'])
        self.check(self.ask(self.bag, '--points', '/lidar/points'), NOTHING_WRONG, ['6 of the 6'],
                   ['sensor:=points', 'points:=/lidar/points'])
        self.check(self.ask(self.bag, '--points', '/lidar/points', '--depth-image',
                            '/front/depth/image_raw', '--set', 'resolution=0.2'), NOTHING_WRONG,
                   ['12 of the 12'], ['resolution: 0.2, sensors: [front, lidar]'])

    def test_what_cannot_be_looked_at(self):
        empty = self.bag.parent / 'empty.bag'
        empty.write_text('This is no bag.')
        for arguments, word in (
                (['nowhere.bag'], 'nowhere.bag'), ([empty], 'cannot read the bag'),
                ([FLIGHT, '--odom', '/vio'], 'there is no such topic.*: /odom'),
                ([FLIGHT, '--points', IMAGE], 'its type is sensor_msgs/Image'),
                ([FLIGHT, '--points', '/odom', '--points', '/tf'], 'its type is nav_msgs/Odometry'),
                ([FLIGHT, '--camera-info', INFO, '--camera-info', INFO], 'more often'),
                ([FLIGHT, '--set', 'resolutoin=1'], 'unknown parameter resolutoin'),
                ([FLIGHT, '--set', 'resolution=-1'], 'resolution.*-1'),
                ([FLIGHT, '--set', 'resolution'], 'name=value'),
                ([FLIGHT, '--seconds', '0'], '--seconds must be above 0'),
                ([FLIGHT, '--start', '1000'], 'ends 11'),
                ([FLIGHT, '--odom', '/odom', '--pose', '/pose'], 'exclude each other'),
                ([FLIGHT, '--colour'], 'colour')):
            with self.subTest(arguments=arguments):
                code, said, line = self.ask(*arguments)
                self.assertEqual(code, CANNOT_LOOK, said)
                self.assertRegex(said, 'error: .*' + word)
                self.assertIsNone(line)

    def test_no_master(self):
        nobody = {'ROS_MASTER_URI': 'http://localhost:1', 'PATH': '/usr/bin:/bin'}
        result = subprocess.run([DOCTOR], universal_newlines=True, env=nobody, timeout=60,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertEqual(result.returncode, CANNOT_LOOK, result.stderr)
        self.assertIn('error: no ROS master answers at http://localhost:1', result.stderr)


if __name__ == '__main__':
    unittest.main()
