#!/usr/bin/python3
"""The launch files for common vehicles make a map of what such vehicles publish."""
import rosbag
import rosnode
import rospy
import rostest

from rostest_support import FLIGHT_BAG, MapTest, program, topics_between, wait_for

SCANS = 5
DEPTH_IMAGE = '/camera/depth/image_rect_raw'
CAMERA_INFO = '/camera/depth/camera_info'
CAMERA = (DEPTH_IMAGE, CAMERA_INFO)


def is_heard(node):
    """Whether a node sends its static transforms to the map."""
    return (node in rosnode.get_node_names()
            and '/tf_static' in topics_between(node, '/fiimap'))


class VehiclesTest(MapTest):
    def tearDown(self):
        # Not killed: its nodes would live on, and spoil the registration of the next ones.
        self.assertEqual(self.launched.interrupt(), 0, self.launched.output())
        super().tearDown()

    def write_bag(self, topics):
        """The first scans of the flight. topics: the new name by the old; others are left out."""
        path = self.directory / 'vehicle.bag'
        scans = 0
        with rosbag.Bag(str(FLIGHT_BAG)) as bag, rosbag.Bag(str(path), 'w') as output:
            for topic, message, stamp in bag.read_messages(list(topics)):
                scans += topic == DEPTH_IMAGE
                if scans > SCANS:
                    break
                output.write(topics[topic], message, stamp)
        return path

    def launch(self, file, *arguments):
        self.launched = self.start('roslaunch', 'fiimap', file, *arguments)
        listener = self.listen('fiimap')
        self.wait_for_map(listener, self.launched)
        return listener

    def start_driver_transforms(self, other):
        """What the camera's driver says of its frames, and what another node says of them, have
        reached the map on return."""
        driver = f'{other}_driver'  # of one test alone: the master remembers nodes that were killed
        self.start(program('tf2_ros', 'static_transform_publisher'), '0', '0', '0', '-0.5', '0.5',
                   '-0.5', '0.5', 'camera_link', 'camera_depth_optical_frame', f'__name:={driver}')
        for node in (f'/{driver}', f'/{other}'):
            wait_for(lambda: is_heard(node), f'transforms of {node}')

    def assert_mapped(self, listener, occupied):
        newest = listener.wait_for_received(SCANS)
        self.assertEqual((newest.integrated, newest.dropped), (SCANS, 0), listener.state())
        self.assertGreater(newest.occupied, occupied)
        return newest

    def test_realsense_on_a_desk(self):
        listener = self.launch('realsense.launch')
        self.start_driver_transforms('desk')
        self.play(self.write_bag({topic: topic for topic in CAMERA}))
        self.assertEqual(self.assert_mapped(listener, 100).header.frame_id, 'world')

    def test_realsense_with_odometry(self):
        listener = self.launch('realsense.launch', 'odom:=/vio/odometry',
                               'mount:=0.1 0 0.05 0 0.2 0')
        self.start_driver_transforms('camera_mount')
        self.play(self.write_bag({**{topic: topic for topic in CAMERA}, '/odom': '/vio/odometry'}))
        self.assert_mapped(listener, 100)

    def test_px4(self):
        # Local positions of the recording are in the frame world.
        listener = self.launch('px4.launch', 'map_frame:=world')
        self.play(self.write_bag({DEPTH_IMAGE: '/camera/depth/image_raw', CAMERA_INFO: CAMERA_INFO,
                                  '/odom': '/mavros/local_position/odom'}))
        self.assert_mapped(listener, 100)

    def test_px4_by_its_own_frame(self):
        listener = self.launch('px4.launch')
        self.play(self.write_bag({DEPTH_IMAGE: '/camera/depth/image_raw', CAMERA_INFO: CAMERA_INFO,
                                  '/odom': '/mavros/local_position/odom'}))
        # The configuration expects MAVROS's frame, and says so.
        wait_for(lambda: 'frame_mismatch' in str(listener.diagnostics.get('inputs')),
                 'diagnostics that name the frame')


if __name__ == '__main__':
    rospy.init_node('vehicles_test')
    rostest.rosrun('fiimap', 'vehicles_test', VehiclesTest)
