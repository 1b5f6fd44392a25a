#!/usr/bin/python3
"""The simulator publishes what fits together, flies as commanded, and feeds a map that is true."""
import math

import numpy
import rospy
import rostest
from geometry_msgs.msg import Quaternion, Transform, Twist, Vector3
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs import point_cloud2
from sensor_msgs.msg import CameraInfo, Image, PointCloud2
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import MultiDOFJointTrajectory, MultiDOFJointTrajectoryPoint
from visualization_msgs.msg import MarkerArray

from fiimap.msg import SimulatorTruth
from manager_support import ManagerTest
from rostest_support import PATIENT_QUEUES, wait_for

WIDTH, HEIGHT = 160, 120  # pixels
CORRIDOR = {
    'world': 'corridor', 'length': 20.0, 'publish_clock': True, 'image_width': WIDTH,
    'image_height': HEIGHT, 'max_range': 30.0}
RESOLUTION = 0.1  # m
TOPICS = {
    'clock': ('/clock', Clock), 'odom': ('/odom', Odometry), 'tf': ('/tf', TFMessage),
    'static': ('/tf_static', TFMessage), 'image': ('/camera/depth/image_raw', Image),
    'info': ('/camera/depth/camera_info', CameraInfo), 'points': ('/points', PointCloud2),
    'truth': ('/simulator/truth', SimulatorTruth), 'world': ('/simulator/world', MarkerArray)}


def numbers(vector):
    return numpy.array([vector.x, vector.y, vector.z])


def command_at(position, velocity=(0.0, 0.0, 0.0), yaw=0.0, frame='world', stamp=None):
    command = MultiDOFJointTrajectory()
    command.header.frame_id = frame
    command.header.stamp = stamp or rospy.Time.now()
    rotation = Quaternion(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))
    command.points = [MultiDOFJointTrajectoryPoint(
        transforms=[Transform(Vector3(*position), rotation)],
        velocities=[Twist(linear=Vector3(*velocity))], accelerations=[Twist()])]
    return command


def distances_to_triangles(points, triangles):
    """Distance of each point to the nearest triangle; from the definition, for few triangles."""
    nearest = numpy.full(len(points), numpy.inf)
    for a, b, c in triangles:
        normal = numpy.cross(b - a, c - a)
        normal /= numpy.linalg.norm(normal)
        height = (points - a) @ normal
        foot = points - height[:, None] * normal
        inside = numpy.ones(len(points), dtype=bool)
        for start, end in ((a, b), (b, c), (c, a)):
            inside &= numpy.cross(end - start, foot - start) @ normal >= 0
            share = numpy.clip((points - start) @ (end - start) / ((end - start) @ (end - start)),
                               0.0, 1.0)
            to_side = points - start - share[:, None] * (end - start)
            nearest = numpy.minimum(nearest, numpy.linalg.norm(to_side, axis=1))
        nearest[inside] = numpy.minimum(nearest[inside], numpy.abs(height[inside]))
    return nearest


def triangles_of(markers):
    corners = next(marker for marker in markers.markers if marker.ns == 'world').points
    return numpy.array([numbers(corner) for corner in corners]).reshape(-1, 3, 3)


class SimulatorTest(ManagerTest):
    def setUp(self):
        super().setUp()
        self.messages = {name: [] for name in TOPICS}
        for name, (topic, kind) in TOPICS.items():
            subscriber = rospy.Subscriber(topic, kind, self.messages[name].append,
                                          buff_size=1 << 24)
            self.addCleanup(subscriber.unregister)
        self.commander = rospy.Publisher('/command', MultiDOFJointTrajectory, queue_size=10)
        self.addCleanup(self.commander.unregister)

    def load_simulator(self, parameters, *arguments):
        loader = self.load('fiimap/SimulatorNodelet', 'simulator', parameters, *arguments)
        self.wait_for_messages('truth', 1)
        return loader

    def wait_for_messages(self, name, count):
        wait_for(lambda: len(self.messages[name]) >= count, f'{count} of {name}')
        return self.messages[name]

    def time(self):
        """Newest simulated time, s."""
        return self.messages['truth'][-1].header.stamp.to_sec()

    def position(self):
        return numbers(self.messages['truth'][-1].position)

    def fly(self, velocity, seconds):
        """Commands a flight at constant velocity from here, in simulated time."""
        wait_for(lambda: self.commander.get_num_connections() > 0, 'the simulator to listen')
        start, origin = self.time(), self.position()
        velocity = numpy.array(velocity)

        def send():
            elapsed = min(self.time() - start, seconds)
            self.commander.publish(command_at(origin + velocity * elapsed, velocity))
            return elapsed >= seconds
        wait_for(send, 'the end of the flight')
        return origin + velocity * seconds

    def test_what_it_publishes_fits_together(self):
        self.load_simulator({**CORRIDOR, 'lidar': 'spinning'})
        for name, count in (('image', 10), ('info', 10), ('odom', 30), ('points', 3), ('tf', 30),
                            ('static', 1), ('clock', 30)):
            self.wait_for_messages(name, count)
        images = {image.header.stamp: image for image in list(self.messages['image'])}
        infos = {info.header.stamp: info for info in list(self.messages['info'])}
        both = sorted(images.keys() & infos.keys())
        self.assertGreaterEqual(len(both), 8)
        for last, stamp in zip(both, both[1:]):
            self.assertAlmostEqual((stamp - last).to_sec(), 1 / 30, delta=1e-6)
        for stamp in both:
            image, info = images[stamp], infos[stamp]
            self.assertEqual({image.header.frame_id, info.header.frame_id},
                             {'camera_depth_optical_frame'})
            self.assertEqual((image.encoding, image.width, image.height, image.step),
                             ('16UC1', WIDTH, HEIGHT, 2 * WIDTH))
            self.assertEqual((info.width, info.height), (WIDTH, HEIGHT))
            self.assertGreater(numpy.frombuffer(image.data, '<u2').min(), 200)  # mm, all walls

        truths = {truth.header.stamp: truth for truth in list(self.messages['truth'])}
        transforms = {message.transforms[0].header.stamp: message.transforms[0]
                      for message in list(self.messages['tf'])}
        compared = 0
        for odometry in list(self.messages['odom']):
            stamp = odometry.header.stamp
            self.assertEqual((odometry.header.frame_id, odometry.child_frame_id),
                             ('world', 'base_link'))
            if stamp not in truths or stamp not in transforms:
                continue
            compared += 1
            position = numbers(odometry.pose.pose.position)
            self.assertLess(numpy.abs(position - numbers(truths[stamp].position)).max(), 1e-9)
            transform = transforms[stamp]
            self.assertEqual((transform.header.frame_id, transform.child_frame_id),
                             ('world', 'base_link'))
            self.assertEqual(transform.transform.rotation, odometry.pose.pose.orientation)
        self.assertGreater(compared, 10)
        frames = {(transform.header.frame_id, transform.child_frame_id)
                  for transform in self.messages['static'][0].transforms}
        self.assertEqual(frames, {('base_link', 'camera_depth_optical_frame'),
                                  ('base_link', 'lidar')})

    def test_flies_as_commanded_and_brakes_when_commands_stop(self):
        loader = self.load_simulator({**CORRIDOR, 'image_width': 16, 'image_height': 12})
        end = self.fly((1.0, 0.0, 0.0), 2.0)
        self.assertLess(numpy.linalg.norm(self.position() - end), 0.5)
        truth = self.messages['truth'][-1]
        self.assertAlmostEqual(truth.velocity.x, 1.0, delta=0.1)
        stop = self.time()
        wait_for(lambda: self.time() > stop + 3.0, 'the end of braking')
        truth = self.messages['truth'][-1]
        self.assertLess(abs(truth.velocity.x), 0.02)
        self.assertLess(truth.position.x, end[0] + 1.5)
        self.assertEqual(truth.collisions, 0)
        self.assertGreater(truth.least_clearance, 0.2)
        self.assertAlmostEqual(truth.path_length, truth.position.x, delta=0.1)
        self.unload(loader)

    def test_refuses_commands_of_another_frame(self):
        self.load_simulator({**CORRIDOR, 'image_width': 16, 'image_height': 12})
        wait_for(lambda: self.commander.get_num_connections() > 0, 'the simulator to listen')
        start = self.position()
        self.commander.publish(command_at(start + 1.0, frame='base_link'))
        wait_for(lambda: 'must be \'world\'' in self.manager.output(), 'a refusal')
        now = self.time()
        wait_for(lambda: self.time() > now + 1.0, 'a second')
        self.assertLess(numpy.linalg.norm(self.position() - start), 1e-6)

    def test_bad_parameters_are_named(self):
        loader = self.load('fiimap/SimulatorNodelet', 'simulator', {**CORRIDOR, 'world': 'jungle'})
        self.assertNotEqual(loader.wait(), 0)
        self.assertIn("parameter world = 'jungle'", self.manager.output())

    def test_a_map_fed_by_it_shows_the_true_surfaces(self):
        statistics = 'map_statistics:=/map/statistics'
        self.load('fiimap/MappingNodelet', 'map',
                  {**PATIENT_QUEUES, 'resolution': RESOLUTION, 'pixel_step': 1},
                  'depth/image:=/camera/depth/image_raw',
                  'depth/camera_info:=/camera/depth/camera_info')
        listener = self.listen()
        wait_for(listener.is_connected, 'the map')
        # As fast as the map can follow, so that a slow machine drops nothing.
        self.load_simulator({**CORRIDOR, 'real_time_factor': 0.0, 'max_lead': 0.2}, statistics)
        listener.wait_for_integrated(5)
        self.fly((1.0, 0.0, 0.0), 2.0)
        now = self.time()
        wait_for(lambda: self.time() > now + 2.0, 'the vehicle to hover')
        wait_for(lambda: listener.clouds['occupied'].header.stamp.to_sec() > now + 2.0, 'a cloud')
        newest = listener.newest()
        self.assertEqual(newest.dropped, 0, newest.drops)

        triangles = triangles_of(self.wait_for_messages('world', 1)[0])
        cloud = listener.clouds['occupied']
        voxels = numpy.array(list(point_cloud2.read_points(cloud, ('x', 'y', 'z'))))
        self.assertGreater(len(voxels), 1000)
        # A voxel that was hit contains a point of a surface, apart from rounding to millimetres.
        far = distances_to_triangles(voxels, triangles) > math.sqrt(3) / 2 * RESOLUTION + 0.005
        self.assertEqual(far.sum(), 0, voxels[far][:5])
        self.check_surfaces_are_occupied(voxels)

    def check_surfaces_are_occupied(self, voxels):
        """What the camera sees from where the vehicle hovers is in the map."""
        image = self.messages['image'][-1]
        info = self.messages['info'][-1]
        pose = self.messages['odom'][-1].pose.pose
        self.assertLess(abs(pose.orientation.x) + abs(pose.orientation.y), 0.01)
        depth = numpy.frombuffer(image.data, '<u2').reshape(HEIGHT, WIDTH) / 1000.0
        v, u = numpy.nonzero((depth > 0.5) & (depth < 4.0))
        z = depth[v, u]
        # The camera looks ahead from 0.1 m in front of the body's middle.
        ahead = numpy.stack([z + 0.1, -(u - info.K[2]) / info.K[0] * z,
                             -(v - info.K[5]) / info.K[4] * z], axis=1)
        seen = {tuple(index) for index in
                numpy.floor((ahead + numbers(pose.position)) / RESOLUTION).astype(int)}
        occupied = {tuple(index) for index in numpy.floor(voxels / RESOLUTION).astype(int)}
        near = {(x + i, y + j, z + k) for x, y, z in occupied
                for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)}
        self.assertGreater(len(seen), 200)
        self.assertGreater(len(seen & near) / len(seen), 0.99)


if __name__ == '__main__':
    rospy.init_node('simulator_test')
    rostest.rosrun('fiimap', 'simulator_test', SimulatorTest)
