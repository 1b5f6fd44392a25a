#!/usr/bin/python3
"""ego_planner/plan_env answers a caller that does what ego-planner does, from its topics alone."""
import array
import math
import threading

import numpy
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Image, PointCloud2, PointField
from std_srvs.srv import Trigger

import rostest_support
from rostest_support import program, wait_for
from voxels import voxels_of_cloud

WALL_X = 3.05  # m, in the map frame
RESOLUTION = 0.1  # m
WIDTH, HEIGHT, FOCAL_LENGTH = 64, 48, 50.0  # pixels
VEHICLE_X = 0.5  # m
VEHICLE_Z = 1.0  # m
SEND_PERIOD = 0.05  # s
STRAIGHT_POINTS = 41  # of the fake planner's search, 4 m in steps of 0.1 m

# As ego-planner's launch file sets them.
GRID_MAP = {
    'resolution': RESOLUTION, 'map_size_x': 40.0, 'map_size_y': 40.0, 'map_size_z': 3.0,
    'local_update_range_x': 5.5, 'local_update_range_y': 5.5, 'local_update_range_z': 4.5,
    'obstacles_inflation': 0.099, 'local_map_margin': 10, 'ground_height': -0.01,
    'cx': WIDTH / 2.0, 'cy': HEIGHT / 2.0, 'fx': FOCAL_LENGTH, 'fy': FOCAL_LENGTH,
    'use_depth_filter': True, 'depth_filter_tolerance': 0.15, 'depth_filter_maxdist': 5.0,
    'depth_filter_mindist': 0.2, 'depth_filter_margin': 1, 'k_depth_scaling_factor': 1000.0,
    'skip_pixel': 2, 'p_hit': 0.65, 'p_miss': 0.35, 'p_min': 0.12, 'p_max': 0.90, 'p_occ': 0.80,
    'min_ray_length': 0.1, 'max_ray_length': 4.5, 'virtual_ceil_height': 2.5,
    'visualization_truncate_height': 2.4, 'show_occ_time': False, 'pose_type': 2,
    'frame_id': 'world',
}


# What EGO-Planner-v2's launch file sets in the place of some of these.
GRID_MAP_2 = {
    **{name: value for name, value in GRID_MAP.items() if not name.startswith(
        ('map_size', 'local_map', 'ground', 'virtual', 'visualization', 'max_ray'))},
    'enable_virtual_wall': True, 'virtual_ceil': 2.5, 'virtual_ground': -0.1, 'fading_time': 1000.0,
    'odom_depth_timeout': 1.0,
}


class Sensor:
    """A vehicle at rest that looks along x at a wall, as ego-planner's topics tell it."""

    def __init__(self, sends_clouds, sends_camera_poses, topics='/grid_map'):
        self.sends_clouds = sends_clouds
        self.sends_camera_poses = sends_camera_poses
        self._odometry = rospy.Publisher(topics + '/odom', Odometry, queue_size=10)
        self._poses = rospy.Publisher(topics + '/pose', PoseStamped, queue_size=10)
        self._depth = rospy.Publisher(topics + '/depth', Image, queue_size=10)
        self._clouds = rospy.Publisher(topics + '/cloud', PointCloud2, queue_size=10)
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._send_all)
        self._thread.start()

    def stop(self):
        self._stopping.set()
        self._thread.join()

    def close(self):
        self.stop()
        for publisher in (self._odometry, self._poses, self._depth, self._clouds):
            publisher.unregister()

    def _send_all(self):
        while not self._stopping.wait(SEND_PERIOD):
            stamp = rospy.Time.now()
            self._send_pose(stamp)
            scan_stamp = stamp - rospy.Duration(SEND_PERIOD / 2.0)
            if self.sends_clouds:
                self._clouds.publish(self._cloud(scan_stamp))
            else:
                self._depth.publish(self._image(scan_stamp))

    def _send_pose(self, stamp):
        if self.sends_camera_poses:
            pose = PoseStamped()
            pose.header.stamp, pose.header.frame_id = stamp, 'world'
            pose.pose.position.x, pose.pose.position.z = VEHICLE_X, VEHICLE_Z
            q = pose.pose.orientation
            q.x, q.y, q.z, q.w = -0.5, 0.5, -0.5, 0.5  # the camera looks along x
            self._poses.publish(pose)
            return
        odometry = Odometry(child_frame_id='body')
        odometry.header.stamp, odometry.header.frame_id = stamp, 'world'
        odometry.pose.pose.position.x = VEHICLE_X
        odometry.pose.pose.position.z = VEHICLE_Z
        odometry.pose.pose.orientation.w = 1.0
        self._odometry.publish(odometry)

    @staticmethod
    def _image(stamp):
        image = Image(height=HEIGHT, width=WIDTH, encoding='16UC1', step=2 * WIDTH)
        image.header.stamp, image.header.frame_id = stamp, 'camera'
        depth = round(1000 * (WALL_X - VEHICLE_X))
        image.data = array.array('H', [depth] * (WIDTH * HEIGHT)).tobytes()
        return image

    @staticmethod
    def _cloud(stamp):
        """The wall itself, in the map frame."""
        y, z = numpy.meshgrid(numpy.arange(-1.0, 1.0, 0.05), numpy.arange(0.0, 2.0, 0.05))
        points = numpy.stack([numpy.full(y.size, WALL_X), y.ravel(), z.ravel()], axis=1)
        cloud = PointCloud2(height=1, width=len(points), point_step=12, is_dense=True,
                            row_step=12 * len(points), data=points.astype('f4').tobytes())
        cloud.header.stamp, cloud.header.frame_id = stamp, 'world'
        cloud.fields = [PointField(name, 4 * i, PointField.FLOAT32, 1)
                        for i, name in enumerate('xyz')]
        return cloud


class EgoPlannerTest(rostest_support.MapTest):
    def setUp(self):
        self.sensor = None

    def tearDown(self):
        if self.sensor:
            self.sensor.close()
        super().tearDown()

    def start_planner(self, **parameters):
        self.set_parameters({'grid_map': {**GRID_MAP, **parameters}}, 'ego_planner_node')
        return self.start(program('fiimap', 'fake_ego_planner'))

    def report(self):
        def ask():
            # The planner of the test before has the same name, and may still be known to the master.
            try:
                return rospy.ServiceProxy('/ego_planner_node/report', Trigger)().message
            except rospy.ServiceException:
                return None
        message = wait_for(ask, 'a report')
        return {key: float(value) for key, value in
                (word.split('=') for word in message.split())}

    def check_wall(self, sends_clouds=False, sends_camera_poses=False, **parameters):
        planner = self.start_planner(**parameters)
        report = self.report()
        self.assertEqual((report['inflated'], report['outside']), (5.0, -1.0), 'before the first scan')
        self.assertEqual((report['straight_free'], report['detour_points']), (1.0, STRAIGHT_POINTS))
        self.sensor = Sensor(sends_clouds, sends_camera_poses)
        wait_for(lambda: self.report()['occupied'] < 5.0, self.report)
        report = self.report()
        # The wall's voxel, and one voxel before it.
        wall = math.floor(WALL_X / RESOLUTION) * RESOLUTION
        self.assertAlmostEqual(report['occupied'], wall, delta=0.01)
        self.assertAlmostEqual(report['inflated'], wall - RESOLUTION, delta=0.01)
        self.assertEqual(report['resolution'], RESOLUTION)
        self.assertEqual((report['outside'], report['not_finite']), (-1.0, -1.0))
        self.assertEqual(report['ceiling'], 1.0)
        self.assertEqual(report['timeout'], 0.0)
        self.assertGreater(report['plans'], 0)
        # Not through the wall but around it.
        self.assertEqual(report['straight_free'], 0.0)
        self.assertGreater(report['detour_points'], STRAIGHT_POINTS + 10)
        self.assertEqual(report['detour_free'], 1.0)
        self.assertEqual(report['changes'], 0, 'the map changed within a plan')
        print('ns per query:', report['ns'])
        return planner

    def test_depth_and_odometry(self):
        planner = self.check_wall()
        occupied = rospy.wait_for_message('/grid_map/occupancy', PointCloud2,
                                          rostest_support.PATIENCE)
        inflated = rospy.wait_for_message('/grid_map/occupancy_inflate', PointCloud2,
                                          rostest_support.PATIENCE)
        self.assertEqual(occupied.header.frame_id, 'world')
        occupied = voxels_of_cloud(occupied, RESOLUTION)
        inflated = voxels_of_cloud(inflated, RESOLUTION)
        self.assertGreater(len(occupied), 10)
        self.assertGreater(len(inflated), 2 * len(occupied))
        self.sensor.stop()
        wait_for(lambda: self.report()['timeout'] == 1.0, self.report)
        self.assertEqual(planner.interrupt(), 0, planner.output())
        self.assertIn('grid_map/show_occ_time has no effect', planner.output())

    def test_depth_and_camera_poses(self):
        self.check_wall(sends_camera_poses=True, pose_type=1)

    def test_clouds_in_the_map_frame(self):
        self.check_wall(sends_clouds=True, sensor='cloud')

    def test_version_2_has_topics_of_its_own_and_is_free_outside(self):
        self.set_parameters({'grid_map': GRID_MAP_2}, 'ego_planner_node')
        planner = self.start(program('fiimap', 'fake_ego_planner'))
        self.assertEqual(self.report()['outside'], 0.0)
        self.sensor = Sensor(False, False, topics='/ego_planner_node/grid_map')
        wait_for(lambda: self.report()['occupied'] < 5.0, self.report)
        report = self.report()
        self.assertAlmostEqual(report['occupied'], math.floor(WALL_X / RESOLUTION) * RESOLUTION,
                               delta=0.01)
        self.assertEqual((report['outside'], report['not_finite'], report['ceiling']), (0., -1., 1.))
        self.assertEqual(report['detour_free'], 1.0)
        rospy.wait_for_message('/ego_planner_node/grid_map/occupancy_inflate', PointCloud2,
                               rostest_support.PATIENCE)
        self.assertEqual(planner.interrupt(), 0, planner.output())

    def test_launch_file(self):
        launch = self.start('roslaunch', 'fiimap', 'ego_planner.launch', 'pkg:=fiimap',
                            'type:=fake_ego_planner', 'odom:=/grid_map/odom',
                            'depth:=/grid_map/depth')
        self.sensor = Sensor(sends_clouds=False, sends_camera_poses=False)
        self.assertEqual(self.report()['resolution'], RESOLUTION)
        wait_for(lambda: rospy.get_param('/ego_planner_node/fiimap/max_ray_length', '') == '4.5',
                 'the parameters')
        self.assertEqual(launch.interrupt(), 0, launch.output())

    def test_parameters_of_the_map_win(self):
        self.start_planner(fiimap={'resolution': 0.2})
        self.assertEqual(self.report()['resolution'], 0.2)

    def test_a_bad_parameter_is_named(self):
        planner = self.start_planner(resolution=-1.0)
        self.assertNotEqual(planner.wait(), 0)
        self.assertIn("parameter resolution = '-1': must be a number in [0.01, 10] m",
                      planner.output())


if __name__ == '__main__':
    rospy.init_node('ego_planner_test')
    rostest.rosrun('fiimap', 'ego_planner_test', EgoPlannerTest)
