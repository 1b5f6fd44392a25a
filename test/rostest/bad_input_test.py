#!/usr/bin/python3
"""Spoiled input is counted under its reason, diagnostics say what to do, and mapping goes on.

A choice from test/faults/faults.yaml, this time through a node and all of ROS."""
import itertools

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus

from rostest_support import wait_for
from vehicle_support import ENOUGH, VehicleTest

PARAMETERS = {'max_pose_wait': 0.3, 'pixel_step': 1, 'publish_rate': 100.0}


def nothing(_):
    return None


def changed(**values):
    """A change of message fields; names of nested fields are joined by '__'."""
    def change(message):
        for name, value in values.items():
            *path, last = name.split('__')
            part = message
            for field in path:
                part = getattr(part, field)
            setattr(part, last, value)
        return message
    return change


def with_less_data(image):
    image.data = image.data[:-1]
    return image


def with_more_data(image):
    image.data = image.data * 2
    return image


def pose_in_25(pose, number=itertools.count()):
    return pose if next(number) % 25 == 0 else None


SPOILED = (
    # reason, what diagnostics must say, change
    ('bad_camera_info', ['not calibrated', 'calibrate'],
     {'info': changed(K=[0.0] * 9, P=[0.0] * 12)}),
    ('bad_camera_info', ['640 x 480', '64 x 48'], {'info': changed(width=640, height=480)}),
    ('bad_encoding', ['rgb8', '16UC1, mono16 or 32FC1'], {'image': changed(encoding='rgb8')}),
    ('bad_image', ['data'], {'image': with_less_data}),
    ('bad_image', ['data'], {'image': with_more_data}),
    ('bad_image', ['step'], {'image': changed(step=1)}),
    ('zero_stamp', ['header.stamp'], {'image': changed(header__stamp=rospy.Time())}),
    ('no_extrinsics', ["'elsewhere'", 'static transform'],
     {'image': changed(header__frame_id='elsewhere')}),
    ('bad_pose', ['finite'], {'odometry': changed(pose__pose__position__x=float('nan'))}),
    ('bad_pose', ['quaternion'], {'odometry': changed(pose__pose__orientation__w=0.0)}),
    ('bad_pose', [], {'odometry': changed(pose__pose__position__x=1e15)}),
    ('frame_mismatch', ["'map'", "'world'", 'set map_frame'],
     {'odometry': changed(header__frame_id='map')}),
    ('zero_stamp', ['header.stamp'], {'odometry': changed(header__stamp=rospy.Time())}),
    ('pose_timeout', ['pose_source', 'max_pose_wait'], {'odometry': nothing}),
    ('pose_gap', ['max_pose_gap'], {'odometry': pose_in_25}),
)


class BadInputTest(VehicleTest):
    def start_vehicle(self):
        self.start_flying(PARAMETERS)

    def input_status(self):
        return self.listener.diagnostics.get('inputs', DiagnosticStatus())

    def fly_spoiled(self, reason, words, **changes):
        """Flies until scans are dropped for the reason; diagnostics must say the words."""
        key = f'dropped: {reason}'
        goal = self.listener.input_count(key) + ENOUGH

        def is_told():
            status = self.input_status()
            return (self.listener.input_count(key) >= goal and status.level != status.OK
                    and all(word in status.message for word in words))
        self.fly_until(is_told, lambda: f'{reason} in diagnostics, with {words}: '
                                        f'{self.input_status()}', **changes)

    def check_end(self):
        wait_for(lambda: self.listener.input_count('scans received') == self.vehicle.images,
                 'the count of all images')
        counts = {name: self.listener.input_count(f'scans {name}')
                  for name in ('received', 'integrated', 'dropped', 'waiting')}
        self.assertEqual(counts['received'],
                         counts['integrated'] + counts['dropped'] + counts['waiting'])
        self.assertEqual(self.node.interrupt(), 0, self.node.output())

    def test_spoiled_messages(self):
        """In one node, to save time."""
        self.start_vehicle()
        self.fly_well()
        for reason, words, changes in SPOILED:
            with self.subTest(reason=reason, words=words):
                before = self.listener.dropped().get(reason, 0)
                self.fly_spoiled(reason, words, **changes)
                self.fly_well()
                self.assertGreaterEqual(self.listener.dropped()[reason], before + ENOUGH)
                self.assertGreater(self.listener.newest().occupied, 0)
        self.check_end()

    def test_stray_stamps(self):
        self.start_vehicle()
        self.fly_well()
        stamp = rospy.Time(self.vehicle.time)
        self.fly_spoiled('stale_stamp', ['increasing stamps'], image=changed(header__stamp=stamp))
        self.fly_well()
        stale = self.listener.dropped()['stale_stamp']
        self.vehicle.fly(image=changed(header__stamp=rospy.Time(self.vehicle.time + 100.0)))
        self.fly_well()
        self.assertEqual(self.listener.dropped()['stale_stamp'], stale + 1)

        number = itertools.count()
        future = changed(header__stamp=rospy.Time(self.vehicle.time + 100.0))
        self.vehicle.fly(odometry=lambda pose: future(pose) if next(number) == 0 else pose)
        self.fly_well()
        wait_for(lambda: self.listener.input_count('poses refused') == 1, 'the count of poses')
        self.assertNotIn('the map was forgotten', self.node.output())
        self.check_end()

    def test_missing_camera_info(self):
        self.start_vehicle()
        self.fly_spoiled('no_camera_info', ['no camera_info received on /depth/camera_info',
                                            'remapped'], info=nothing)
        self.assertEqual(self.listener.statistics, [])
        self.fly_well()
        self.check_end()

    def test_no_odometry_at_all(self):
        self.start_vehicle()
        self.fly_spoiled('pose_timeout', ['no poses received on /odom', 'remapped'],
                         odometry=nothing)
        self.fly_well()
        self.check_end()


if __name__ == '__main__':
    rospy.init_node('bad_input_test')
    rostest.rosrun('fiimap', 'bad_input_test', BadInputTest)
