#!/usr/bin/python3
"""Parameters change while the node maps, by the clients of dynamic_reconfigure."""
import itertools
import tempfile

import numpy
import rospy
import rostest
from dynamic_reconfigure import find_reconfigure_services
from dynamic_reconfigure.client import Client, DynamicReconfigureParameterException
from geometry_msgs.msg import Point
from rosgraph_msgs.msg import Log

import make_bag_variants
from fiimap.msg import MapInfo
from fiimap.srv import GetBox, GetBoxResponse
from rostest_support import (
    FLIGHT_BAG, PATIENT_QUEUES, MapTest, cut, program, topics_between, wait_for)
from voxels import voxels_of_pcd

FORM = ('points', 'odometry')
RESOLUTION = 0.1
RADIUS = 0.2
PARAMETERS = {
    **PATIENT_QUEUES, 'sensor': FORM[0], 'resolution': RESOLUTION, 'inflation_radius': RADIUS,
    'map_size_x': 12.0, 'map_size_y': 12.0, 'map_size_z': 4.0, 'slide_distance': 0.4,
}
SCANS = 20  # of each half of the flight


def is_inside(shape, radius, offset):
    """Whether a voxel is inflated by an obstacle at an offset, by the definition."""
    voxels = -int(-radius / RESOLUTION // 1)
    distances = [abs(axis) for axis in offset]
    if shape == 'ball':
        # In hundredths of a voxel: the radii of these tests are whole.
        return sum((100 * d) ** 2 for d in distances) <= round(100 * radius / RESOLUTION) ** 2
    return (max(distances) if shape == 'cube' else sum(distances)) <= voxels


def dilated(occupied, shape, radius):
    """Every obstacle of a box inflated, one offset of the element after the other."""
    reach = range(-int(radius / RESOLUTION) - 1, int(radius / RESOLUTION) + 2)
    inflated = numpy.zeros_like(occupied)
    for offset in itertools.product(reach, repeat=3):
        if not is_inside(shape, radius, offset):
            continue
        to, source = [], []
        for axis, size in zip(offset, occupied.shape):
            to.append(slice(max(axis, 0), size + min(axis, 0)))
            source.append(slice(max(-axis, 0), size + min(-axis, 0)))
        inflated[tuple(to)] |= occupied[tuple(source)]
    return inflated


class TuningTest(MapTest):
    @classmethod
    def setUpClass(cls):
        cls.bag_folder = tempfile.TemporaryDirectory()
        cls.whole_bag = make_bag_variants.write_variants(
            FLIGHT_BAG, cls.bag_folder.name, 2 * SCANS, [FORM])[FORM]

    @classmethod
    def tearDownClass(cls):
        cls.bag_folder.cleanup()

    def start_mapping(self, parameters=None):
        self.node, self.listener = self.start_map(parameters or PARAMETERS)
        infos = []
        subscriber = rospy.Subscriber('/map/map_handle', MapInfo, infos.append)
        self.addCleanup(subscriber.unregister)
        self.infos = infos
        self.map = self.client('/map')

    def client(self, name):
        client = Client(name, timeout=30.0)
        self.addCleanup(client.close)
        wait_for(lambda: client.get_configuration(timeout=1.0), f'the configuration of {name}')
        return client

    def fly(self, half):
        bag = cut(self.whole_bag, self.directory / f'half_{half}.bag', '/points', SCANS,
                  first=half * SCANS)
        self.play(bag, '--rate=2')
        newest = self.listener.wait_for_integrated((half + 1) * SCANS)
        self.assertEqual(newest.dropped, 0, newest)

    def planes(self):
        """Occupied and inflated voxels of the whole window, of one snapshot."""
        wait_for(lambda: self.infos[-1].header.stamp == self.listener.newest().header.stamp,
                 'the window of the newest scan')
        info = self.infos[-1]
        low, high = (Point(*(RESOLUTION * (voxel + half) for voxel in corner))
                     for corner, half in ((info.window_min, 0.5), (info.window_max, -0.5)))
        box = rospy.ServiceProxy('/map/get_box', GetBox)(low, high)
        self.assertTrue(box.success, box.message)
        voxels = numpy.frombuffer(box.voxels, numpy.uint8).reshape(
            box.size_x, box.size_y, box.size_z)
        self.assertFalse((voxels % 4 == GetBoxResponse.OUTSIDE).any())
        return voxels % 4 == GetBoxResponse.OCCUPIED, voxels // 4 == GetBoxResponse.OCCUPIED

    def assert_exact(self, shape, radius):
        occupied, inflated = self.planes()
        self.assertGreater(occupied.sum(), 100)
        self.assertTrue((inflated == dilated(occupied, shape, radius)).all())
        return int(inflated.sum())

    def assert_same_map_as_offline(self, **parameters):
        """As if the parameters had been so from the beginning."""
        offline = self.evaluate(self.whole_bag, {**PARAMETERS, **parameters})
        self.assertEqual(self.listener.newest().integrated, offline['integrated'])
        for plane, layer in zip(self.planes(), ('occupied', 'inflated')):
            voxels = numpy.argwhere(plane) + self.infos[-1].window_min
            self.assertEqual({tuple(voxel) for voxel in voxels.tolist()},
                             voxels_of_pcd(self.directory / f'offline_{layer}.pcd', RESOLUTION))

    # Granted

    def test_radius_and_shape_change_in_flight(self):
        self.start_mapping()
        self.fly(0)
        before = self.assert_exact('ball', RADIUS)
        sizes = {}
        for shape, radius in (('cube', 0.4), ('diamond', 0.3), ('ball', 0.35), ('ball', 0.0)):
            sequence = self.infos[-1].sequence
            values = self.map.update_configuration(
                {'inflation_radius': radius, 'inflation_shape': shape})
            self.assertEqual((values.inflation_radius, values.inflation_shape), (radius, shape))
            sizes[shape, radius] = self.assert_exact(shape, radius)
            # Planners hear of it before the next scan.
            wait_for(lambda: self.infos[-1].sequence > sequence, 'the handle')
            self.assertEqual(self.infos[-1].inflation_radius, radius)
        self.assertGreater(sizes['cube', 0.4], before)
        self.assertLess(sizes['ball', 0.0], before)
        self.map.update_configuration({'inflation_radius': 0.4, 'inflation_shape': 'cube'})
        self.fly(1)
        self.assert_exact('cube', 0.4)
        self.assert_same_map_as_offline(inflation_radius=0.4, inflation_shape='cube')

    def test_tuning_goes_on_while_scans_come(self):
        self.start_mapping()
        radii = itertools.cycle((0.1, 0.4, 0.3))
        player = self.start(program('rosbag', 'play'), '--quiet', '--clock',
                            '--wait-for-subscribers', '--rate=2', self.whole_bag)
        changes = 0
        while player.is_running():
            radius = next(radii)
            values = self.map.update_configuration({'inflation_radius': radius, 'p_occ': 0.7})
            self.assertEqual(values.inflation_radius, radius)
            changes += 1
        self.assertEqual(player.wait(), 0, player.output())
        self.assertGreater(changes, 5)
        self.map.update_configuration({'inflation_radius': RADIUS, 'p_occ': 0.8})
        self.listener.wait_for_integrated(2 * SCANS)
        self.assert_exact('ball', RADIUS)
        self.assert_same_map_as_offline()

    def test_the_threshold_holds_for_what_is_in_the_map(self):
        self.start_mapping()
        self.fly(0)
        occupied = int(self.planes()[0].sum())
        self.map.update_configuration({'p_occ': 0.95})
        self.assertLess(int(self.planes()[0].sum()), occupied)
        self.assert_exact('ball', RADIUS)
        self.map.update_configuration({'p_occ': 0.6})
        self.assertGreater(int(self.planes()[0].sum()), occupied)
        self.assert_exact('ball', RADIUS)
        self.fly(1)
        self.assert_same_map_as_offline(p_occ=0.6)

    def test_readings_change_from_the_next_scan_on(self):
        self.start_mapping()
        self.fly(0)
        farthest = max(s.too_far for s in self.listener.statistics)
        self.map.update_configuration({'max_ray_length': 2.0, 'publish_rate': 100.0})
        self.fly(1)
        for statistics in self.listener.statistics[SCANS:]:
            self.assertGreater(statistics.too_far, farthest)
        self.assert_exact('ball', RADIUS)

    def test_dynparam_and_the_parameter_server(self):
        self.start_mapping()
        logged = []
        console = rospy.Subscriber('/rosout', Log, lambda message: logged.append(message.msg))
        self.addCleanup(console.unregister)
        wait_for(lambda: topics_between('/map', rospy.get_name()) >= {'/rosout'}, 'the console')
        set_by_user = self.start(program('dynamic_reconfigure', 'dynparam'), 'set', '/map',
                                 'inflation_radius', '0.4')
        self.assertEqual(set_by_user.wait(), 0, set_by_user.output())
        self.assertEqual(rospy.get_param('/map/inflation_radius'), 0.4)
        wait_for(lambda: "parameter inflation_radius = '0.4', was '0.2'" in logged,
                 lambda: f'what was changed: {logged}')
        several = self.start(
            program('dynamic_reconfigure', 'dynparam'), 'set', '/map',
            "{'pixel_step': 3, 'round_rays': False, 'infinite_depth': 'ignore', "
            "'bfs_connectivity': 18, 'time_offset': 0.01}")
        self.assertEqual(several.wait(), 0, several.output())
        for name, value in (('pixel_step', 3), ('round_rays', False), ('infinite_depth', 'ignore'),
                            ('bfs_connectivity', 18), ('time_offset', 0.01)):
            found = rospy.get_param(f'/map/{name}')
            self.assertEqual((type(found), found), (type(value), value), name)
        got = self.start(program('dynamic_reconfigure', 'dynparam'), 'get', '/map')
        self.assertEqual(got.wait(), 0, got.output())
        self.assertIn("'pixel_step': 3", got.output())
        tuned = self.directory / 'tuned.yaml'
        self.assertEqual(
            self.start(program('dynamic_reconfigure', 'dynparam'), 'dump', '/map', tuned).wait(), 0)
        self.map.update_configuration({'pixel_step': 1, 'inflation_radius': 0.1})
        loading = self.start(program('dynamic_reconfigure', 'dynparam'), 'load', '/map', tuned)
        self.assertEqual(loading.wait(), 0, loading.output())
        self.assertEqual((rospy.get_param('/map/pixel_step'),
                          rospy.get_param('/map/inflation_radius')), (3, 0.4))
        # A node that starts with what is there has what was tuned.
        self.assertEqual(self.node.interrupt(), 0, self.node.output())
        parameters = rospy.get_param('/map')
        self.listener.diagnostics.clear()
        self.start_mapping(parameters)
        self.assertEqual(self.map.get_configuration()['inflation_radius'], 0.4)

    def test_every_parameter_is_described_as_a_form_needs_it(self):
        self.start_mapping()
        descriptions = {d['name']: d for d in self.map.get_parameter_descriptions()}
        self.assertEqual(set(descriptions) | {'groups'}, set(self.map.get_configuration()))
        self.assertEqual(descriptions['inflation_radius']['max'], 100.0)
        self.assertEqual(descriptions['inflation_radius']['default'], RADIUS)
        self.assertIn('[0, 100] m', descriptions['inflation_radius']['description'])
        self.assertEqual(descriptions['pixel_step']['type'], 'int')
        choices = eval(descriptions['inflation_shape']['edit_method'])['enum']
        self.assertEqual([choice['value'] for choice in choices], ['ball', 'cube', 'diamond'])
        self.assertNotIn('resolution', descriptions)

    def test_each_of_several_sensors_has_its_own(self):
        sensors = {**PARAMETERS, 'sensors': ['front', 'lidar'], 'sensor': 'depth',
                   'lidar': {'sensor': 'points'}}
        self.start_mapping(sensors)
        self.assertEqual({name for name in find_reconfigure_services() if '/map' in name},
                         {'/map', '/map/front', '/map/lidar'})
        front, lidar = self.client('/map/front'), self.client('/map/lidar')
        self.assertNotIn('max_depth', self.map.get_configuration())
        self.assertNotIn('inflation_radius', front.get_configuration())
        self.assertEqual(front.update_configuration({'max_depth': 3.0})['max_depth'], 3.0)
        self.assertEqual(lidar.get_configuration()['max_depth'], 8.0)
        self.assertEqual(rospy.get_param('/map/front/max_depth'), 3.0)
        self.assertFalse(rospy.has_param('/map/lidar/max_depth'))
        refused = front.update_configuration({'max_depth': 0.1})
        self.assertEqual(refused['max_depth'], 3.0)
        self.assertIn('parameter front/min_depth = 0.300000: must be less than front/max_depth',
                      self.node.output())

    # Refused

    def test_a_name_that_a_client_does_not_know(self):
        self.start_mapping()
        with self.assertRaises(DynamicReconfigureParameterException):
            self.map.update_configuration({'resolution': 0.2})


if __name__ == '__main__':
    rospy.init_node('tuning_test')
    rostest.rosrun('fiimap', 'tuning_test', TuningTest)
