#!/usr/bin/python3
"""rebuild_clouds has the clouds of the mapping node from ~changes, in a process of its own."""
import tempfile
import zlib

import rospy
import rostest
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger

import make_bag_variants
from fiimap.msg import MapChanges
from rostest_support import (
    FLIGHT_BAG, PATIENT_QUEUES, MapTest, cut, program, topics_between, wait_for)

FORM = ('points', 'odometry')
SCANS = 15
# Every scan is published, so that both nodes publish the same ones.
PARAMETERS = {**PATIENT_QUEUES, 'sensor': FORM[0], 'publish_rate': 1000.0, 'keyframe_period': 3600.0}
LAYERS = ('occupied', 'inflated')


class Clouds:
    """Hears the clouds of a node, and keeps them by layer and stamp."""

    def __init__(self, node):
        self.received = {layer: {} for layer in LAYERS}
        self.newest = {}
        self._subscribers = [
            rospy.Subscriber(f'/{node}/{layer}', PointCloud2, self._on_cloud, layer,
                             buff_size=1 << 24) for layer in LAYERS]

    def _on_cloud(self, cloud, layer):
        self.received[layer][cloud.header.stamp] = cloud
        self.newest[layer] = cloud

    def widths(self):
        return [self.newest[layer].width if layer in self.newest else None for layer in LAYERS]

    def close(self):
        for subscriber in self._subscribers:
            subscriber.unregister()


class GroundStationTest(MapTest):
    @classmethod
    def setUpClass(cls):
        cls.bag_folder = tempfile.TemporaryDirectory()
        cls.whole_bag = make_bag_variants.write_variants(
            FLIGHT_BAG, cls.bag_folder.name, 2 * SCANS, [FORM])[FORM]

    @classmethod
    def tearDownClass(cls):
        cls.bag_folder.cleanup()

    def setUp(self):
        self.bag = cut(self.whole_bag, self.directory / 'flight.bag', '/points', SCANS)
        self.rest = cut(self.whole_bag, self.directory / 'rest.bag', '/points', SCANS, first=SCANS)

    def listen_to_clouds(self, node):
        clouds = Clouds(node)
        self.addCleanup(clouds.close)
        return clouds

    def start_ground_station(self, changes='/map/changes'):
        """The node in a process of its own, and its clouds; the link to the map is up."""
        node = self.start(program('fiimap', 'rebuild_clouds'), '__name:=ground',
                          f'changes:={changes}')
        clouds = self.listen_to_clouds('ground')
        if changes == '/map/changes':
            wait_for(lambda: changes in self.topics_to_ground(), 'the link to the ground station')
        return node, clouds

    def topics_to_ground(self):
        return topics_between('/map', '/ground')

    def wait_for_same_clouds(self, clouds, listener):
        """Waits for the clouds of the newest scan; they must be those of the map."""
        stamp = listener.newest().header.stamp
        wait_for(lambda: all(stamp in received for received in clouds.received.values()),
                 'rebuilt clouds of the newest scan')
        for layer, cloud in zip(LAYERS, listener.wait_for_clouds()):
            self.assert_same(clouds.received[layer][stamp], cloud)
            self.assertGreater(cloud.width, 0)

    def assert_same(self, rebuilt, cloud):
        self.assertEqual(rebuilt.header.frame_id, cloud.header.frame_id)
        self.assertEqual((rebuilt.width, rebuilt.height, rebuilt.fields, rebuilt.point_step),
                         (cloud.width, cloud.height, cloud.fields, cloud.point_step))
        self.assertTrue(rebuilt.data == cloud.data, f'other points at {cloud.header.stamp}')

    def test_every_cloud_is_that_of_the_map(self):
        _, listener = self.start_map(PARAMETERS)
        of_map = self.listen_to_clouds('map')
        node, rebuilt = self.start_ground_station()
        self.assertEqual(self.topics_to_ground(), {'/map/changes'})
        self.play(self.bag)
        listener.wait_for_integrated(SCANS)
        self.wait_for_same_clouds(rebuilt, listener)
        for layer in LAYERS:
            common = set(of_map.received[layer]) & set(rebuilt.received[layer])
            self.assertGreater(len(common), SCANS // 2, layer)
            for stamp in common:
                self.assert_same(rebuilt.received[layer][stamp], of_map.received[layer][stamp])
        self.assertNotIn('WARN', node.output())

    def test_joins_late_and_survives_a_reset(self):
        _, listener = self.start_map(PARAMETERS)
        self.play(self.bag, '--rate=2')
        listener.wait_for_integrated(SCANS)
        launch = self.start('roslaunch', 'fiimap', 'ground_station.launch', 'map:=/map',
                            'name:=ground', 'rviz:=false')
        rebuilt = self.listen_to_clouds('ground')
        self.wait_for_same_clouds(rebuilt, listener)

        self.assertTrue(rospy.ServiceProxy('/map/reset', Trigger)().success)
        wait_for(lambda: rebuilt.widths() == [0, 0], 'empty clouds after the reset')
        self.play(self.rest, '--rate=2')
        listener.wait_for_integrated(2 * SCANS)
        self.wait_for_same_clouds(rebuilt, listener)
        self.assertEqual(launch.interrupt(), 0, launch.output())

    def test_is_told_of_an_empty_map_and_of_one_that_is_not_there(self):
        self.start_map(PARAMETERS)
        _, rebuilt = self.start_ground_station()
        wait_for(lambda: rebuilt.widths() == [0, 0], 'empty clouds before the first scan')

    def test_asks_for_nothing_while_nobody_listens(self):
        _, listener = self.start_map(PARAMETERS)
        node, rebuilt = self.start_ground_station()
        rebuilt.close()
        wait_for(lambda: not self.topics_to_ground(), 'the end of the link')
        self.play(self.bag, '--rate=2')
        listener.wait_for_integrated(SCANS)
        self.assertEqual(self.topics_to_ground(), set())
        again = self.listen_to_clouds('ground')
        self.wait_for_same_clouds(again, listener)
        self.assertEqual(node.interrupt(), 0, node.output())

    def test_a_lost_message_is_told_and_the_next_keyframe_helps(self):
        """Between the map and the ground station the test loses what it likes."""
        _, listener = self.start_map({**PARAMETERS, 'keyframe_period': 1.0})
        link = rospy.Publisher('/link', MapChanges, queue_size=100)
        node, rebuilt = self.start_ground_station('/link')
        wait_for(link.get_num_connections, 'the ground station')
        held, lost = [], []

        def carry(message):
            # Of two changes that follow each other, the first one is lost.
            if held and message.previous != 0:
                lost.append(held.pop())
            for late in held:
                link.publish(late)
            held.clear()
            if message.previous != 0 and not lost:
                held.append(message)
            else:
                link.publish(message)
        changes = rospy.Subscriber('/map/changes', MapChanges, carry)
        self.addCleanup(changes.unregister)
        wait_for(changes.get_num_connections, 'the link')
        self.play(self.bag)
        listener.wait_for_integrated(SCANS)
        wait_for(lambda: 'were lost before update' in node.output(), 'the warning of a loss')
        self.assertEqual(len(lost), 1)
        self.wait_for_same_clouds(rebuilt, listener)

    def test_refuses_what_is_no_map(self):
        link = rospy.Publisher('/link', MapChanges, queue_size=100)
        node, rebuilt = self.start_ground_station('/link')
        wait_for(link.get_num_connections, 'the ground station')
        message = MapChanges(sequence=1, resolution=0.5, window_max=[4, 4, 4], occupied=2,
                             inflated=2, changes=zlib.compress(b'\x05\x02'))
        link.publish(MapChanges(**{**values(message), 'window_max': [0, 4, 4]}))
        link.publish(MapChanges(**{**values(message), 'changes': b'\x05\x02'}))
        link.publish(message)
        wait_for(lambda: rebuilt.widths() == [2, 2], 'the clouds of a good message')
        self.assertIn('window_min[0] = 0', node.output())
        self.assertIn('changes: no zlib stream', node.output())


def values(message):
    return {name: getattr(message, name) for name in message.__slots__}


if __name__ == '__main__':
    rospy.init_node('ground_station_test')
    rostest.rosrun('fiimap', 'ground_station_test', GroundStationTest)
