#!/usr/bin/python3
"""The faults of test/faults/faults.yaml that need running nodes: time, processes, files, parameters."""
import signal
import socket
import threading

import rospy
import rostest
import yaml
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from sensor_msgs.msg import PointCloud2
from xmlrpc.client import Binary

import make_bag_variants
from fiimap.msg import OtherVehicles
from fiimap.srv import (
    CastRays, CastRaysRequest, ClearBox, GetBox, LoadMap, QueryPoints, SaveMap)
from geometry_msgs.msg import Point
from rostest_support import FLIGHT_BAG, PACKAGE, program, topics_between, wait_for
from vehicle_support import VehicleTest

PARAMETERS = {'max_pose_wait': 0.3, 'pixel_step': 1, 'publish_rate': 100.0, 'resolution': 0.05}
MANY = 60  # scans
FILE_LIMIT = 8  # kB, less than the map needs
MEMORY_LIMIT = 60.0  # MB that a node may grow while one of its subscribers does not read
SMALL_RECORDING = 20  # scans


def catalogue():
    text = (PACKAGE / 'test' / 'faults' / 'faults.yaml').read_text()
    return {row['id']: row for section in yaml.safe_load(text)['live'] for row in section['faults']}


def nothing(_):
    return None


class LiveFaultsTest(VehicleTest):
    rows = catalogue()
    done = set()

    @classmethod
    def tearDownClass(cls):
        assert cls.done == set(cls.rows), f'not tested: {set(cls.rows) - cls.done}'

    def row(self, name):
        """Says that a row is tested now."""
        self.done.add(name)
        return self.rows[name]

    def assert_told(self, name, text):
        for words in self.rows[name]['says']:
            self.assertIn(words, text)

    def listen_and_fly(self, listener, scans=3, **changes):
        """Flies until a map has integrated so many more scans."""
        goal = listener.newest().integrated + scans

        def step():
            self.vehicle.fly(**changes)
            return listener.newest().integrated >= goal
        wait_for(step, lambda: f'scans of {listener.name}: {listener.state()}')

    # A node of its own

    def test_node(self):
        """One node for all that a node survives, to save time."""
        maps = self.directory / 'maps'
        maps.mkdir()
        self.set_parameters({**PARAMETERS, 'save_directory': str(maps)})
        self.listener = self.listen()
        # The limit of the size of files stands for a full disk.
        self.node = self.start('bash', '-c', f'trap "" XFSZ; ulimit -f {FILE_LIMIT}; '
                               f'exec {program("fiimap", "mapping_node")} __name:=map')
        self.wait_for_map(self.listener, self.node)
        wait_for(self.vehicle.is_connected, 'the connections of the vehicle')
        self.check_requests_without_a_map()
        self.fly_well()

        self.check_bad_requests(maps)
        self.row('live_clock_stops')
        self.fly_well(10, clock=nothing)
        self.check_saving(maps)
        self.check_tuning()
        self.check_stopped_subscriber()
        self.row('live_terminate_node')
        self.node.send(signal.SIGTERM)
        self.assertEqual(self.node.wait(), 0, self.node.output())

    def assert_refused(self, name, service, kind, *arguments):
        self.row(name)
        response = rospy.ServiceProxy(f'/map/{service}', kind)(*arguments)
        self.assertFalse(response.success, response)
        self.assert_told(name, response.message)

    def rays(self, start, end, count=1):
        return CastRaysRequest(starts=[start] * count, ends=[end] * count,
                               layer=CastRaysRequest.RAW, unknown=CastRaysRequest.FREE,
                               outside=CastRaysRequest.FREE)

    def check_requests_without_a_map(self):
        for service, kind, arguments in (
                ('get_box', GetBox, (Point(), Point())), ('query_points', QueryPoints, ([Point()],)),
                ('cast_rays', CastRays, (self.rays(Point(), Point()),)),
                ('clear_box', ClearBox, (Point(), Point(), 0)), ('save_map', SaveMap, ('room',))):
            self.assert_refused('live_request_no_map', service, kind, *arguments)

    def check_bad_requests(self, maps):
        origin, far, nowhere = Point(), Point(1e6, 1e6, 1e6), Point(float('nan'), 0, 0)
        too_many = 2 ** 20 + 1
        for service, kind, arguments in (
                ('get_box', GetBox, (origin, far)),
                ('query_points', QueryPoints, ([origin] * too_many,)),
                ('cast_rays', CastRays, (self.rays(origin, origin, too_many),)),
                ('cast_rays', CastRays, (self.rays(origin, far),))):
            self.assert_refused('live_request_absurd', service, kind, *arguments)
        for service, kind, arguments in (
                ('get_box', GetBox, (origin, nowhere)), ('clear_box', ClearBox, (nowhere, far, 0)),
                ('cast_rays', CastRays, (self.rays(nowhere, origin),))):
            self.assert_refused('live_request_not_finite', service, kind, *arguments)
        self.assert_refused('live_request_incomplete', 'cast_rays', CastRays,
                            CastRaysRequest(starts=[origin], ends=[origin]))
        damaged = maps / 'damaged.bt'
        damaged.write_bytes(b'# Octomap OcTree binary file\nid OcTree\nsize 9\nres 0.05\ndata\n\xff')
        self.assert_refused('live_request_damaged_map', 'load_map', LoadMap, 'damaged', origin)
        damaged.unlink()

        self.row('live_request_vehicles')
        others = rospy.Publisher('/map/other_vehicles', OtherVehicles, queue_size=1)
        wait_for(others.get_num_connections, 'the subscriber of other vehicles')
        message = OtherVehicles()
        message.header.frame_id = 'elsewhere'
        others.publish(message)
        told = self.rows['live_request_vehicles']['says'][0]
        wait_for(lambda: told in self.node.output(), told)
        self.fly_well()

    def check_saving(self, maps):
        save = rospy.ServiceProxy('/map/save_map', SaveMap)
        for name, file in (('live_save_outside', '../outside'), ('live_save_disk_full', 'room')):
            self.row(name)
            response = save(file)
            self.assertFalse(response.success, response)
            self.assert_told(name, response.message)
            self.assertEqual(list(maps.iterdir()), [])
            self.fly_well()
        self.assertFalse((maps.parent / 'outside.bt').exists())

    def check_tuning(self):
        self.row('live_tuning_refused')
        tune = rospy.ServiceProxy('/map/set_parameters', Reconfigure)
        for name, value in (('inflation_radius', 1000.0), ('p_occ', 0.98), ('resolution', 0.2)):
            asked = Config(doubles=[DoubleParameter('max_depth', 3.0), DoubleParameter(name, value)])
            held = {entry.name: entry.value for entry in tune(asked).config.doubles}
            self.assertEqual((held['inflation_radius'], held['p_occ'], held['max_depth']),
                             (0.2, 0.8, 8.0))
            self.assertFalse(rospy.has_param('/map/max_depth'))
        self.assertEqual(rospy.get_param('/map/resolution'), PARAMETERS['resolution'])
        self.assert_told('live_tuning_refused', self.node.output())
        self.fly_well()

    def check_stopped_subscriber(self):
        self.row('live_stopped_subscriber')
        topics = [f'/map/{topic}' for topic in
                  ('occupied', 'inflated', 'window', 'path', 'vehicle', 'statistics', 'map_handle')]
        reader = self.start(program('rosbag', 'record'), '-O', self.directory / 'record.bag',
                            '__name:=reader', *topics)
        wait_for(lambda: set(topics) <= topics_between('/map', '/reader'), 'the reader')
        self.fly_well()
        reader.send(signal.SIGSTOP)
        self.fly_well()
        before = self.node.memory_mb()
        clouds = []
        subscriber = rospy.Subscriber('/map/occupied', PointCloud2, clouds.append)
        self.addCleanup(subscriber.unregister)
        received = len(self.listener.statistics)
        self.fly_well(MANY)
        self.assertGreaterEqual(len(self.listener.statistics) - received, MANY)
        wait_for(lambda: clouds, 'a cloud while another subscriber does not read')
        self.assertLess(self.node.memory_mb() - before, MEMORY_LIMIT)
        reader.kill()

    # Nodelets of one manager

    def load(self, name):
        """Loads a map, which its loader unloads at its end; returns the loader and a listener.

        Without a bond, see ProcessesTest."""
        self.set_parameters(PARAMETERS, name)
        listener = self.listen(name)
        loader = self.start(program('nodelet', 'nodelet'), 'load', 'fiimap/MappingNodelet',
                            '/manager', '--no-bond', f'__name:={name}')
        self.wait_for_map(listener, self.manager)
        wait_for(self.vehicle.is_connected, 'the connections of the vehicle')
        return loader, listener

    def start_manager(self):
        self.manager = self.start(program('nodelet', 'nodelet'), 'manager', '__name:=manager')
        rospy.wait_for_service('/manager/list')

    def fly_in_background(self):
        """Flies until the returned function is called."""
        ended = threading.Event()

        def fly():
            while not ended.wait(0.01):
                self.vehicle.fly()
        thread = threading.Thread(target=fly)
        thread.start()

        def end():
            ended.set()
            thread.join()
        self.addCleanup(end)
        return end

    def test_two_maps_in_a_manager(self):
        self.row('live_two_maps')
        self.start_manager()
        (loader, one), (_, other) = self.load('one'), self.load('other')
        self.listen_and_fly(one)
        self.listen_and_fly(other)

        self.row('live_unload')
        end = self.fly_in_background()
        self.assertEqual(loader.interrupt(), 0, loader.output())
        integrated = other.newest().integrated
        wait_for(lambda: other.newest().integrated > integrated + 3, other.state)
        _, again = self.load('one')
        wait_for(lambda: again.newest().integrated >= 3, again.state)
        self.assertLess(again.newest().received, other.newest().received)

        self.row('live_interrupt_manager')
        self.assertEqual(self.manager.interrupt(), 0, self.manager.output())
        end()

    def test_terminated_manager(self):
        self.row('live_terminate_manager')
        self.start_manager()
        _, listener = self.load('one')
        self.listen_and_fly(listener)
        end = self.fly_in_background()
        self.manager.send(signal.SIGTERM)
        self.assertEqual(self.manager.wait(), -signal.SIGTERM, self.manager.output())
        end()

    # Parameters, as only the parameter server can hold them

    def test_parameters_of_other_types(self):
        for name, value in (('live_parameter_namespace', {'of': 'others'}),
                            ('live_parameter_type', Binary(b'0.1'))):
            self.row(name)
            self.set_parameters({'resolution': value})
            node = self.start(program('fiimap', 'mapping_node'), '__name:=map')
            self.assertEqual(node.wait(), 1, node.output())
            self.assert_told(name, node.output())
        self.set_parameters({})

    # The master

    def test_master_restart(self):
        self.row('live_master_restart')
        with socket.socket() as free:
            free.bind(('', 0))
            port = free.getsockname()[1]
        environment = {'ROS_MASTER_URI': f'http://localhost:{port}'}
        master = self.start_master(port, environment)
        node = self.start(program('fiimap', 'mapping_node'), '__name:=map', environment=environment)
        form = ('depth', 'odometry')
        bag = make_bag_variants.write_variants(
            FLIGHT_BAG, self.directory, SMALL_RECORDING, [form])[form]
        echo = self.start('rostopic', 'echo', '-p', '/map/statistics/integrated',
                          environment=environment)
        self.start(program('rosbag', 'play'), '--quiet', '--loop', '--wait-for-subscribers', bag,
                   environment=environment)

        def lines():
            return len(echo.output().splitlines())
        wait_for(lambda: lines() > 3, lambda: f'statistics: {node.output()} {echo.output()}')
        master.interrupt()
        self.start_master(port, environment)
        seen = lines()
        wait_for(lambda: lines() > seen + 5, 'statistics after the restart of the master')
        self.assertTrue(node.is_running(), node.output())
        self.assertEqual(node.interrupt(), 0, node.output())

    def start_master(self, port, environment):
        master = self.start('rosmaster', '--core', '-p', port, environment=environment)

        def answers():
            with socket.socket() as client:
                return client.connect_ex(('localhost', port)) == 0
        wait_for(answers, 'the master')
        return master


if __name__ == '__main__':
    rospy.init_node('live_faults_test')
    rostest.rosrun('fiimap', 'live_faults_test', LiveFaultsTest)
