#!/usr/bin/python3
"""Nodelets of the same manager read the map through its handle, whoever comes or goes first."""
import tempfile
import threading

import rospy
import rostest
from sensor_msgs.msg import Image

import make_bag_variants
from manager_support import ManagerTest
from rostest_support import FLIGHT_BAG, PATIENT_QUEUES, wait_for

FORM = ('depth', 'odometry')
SCANS = 20
PARAMETERS = {**PATIENT_QUEUES, 'resolution': 0.1}
UNLOADS = 10


class HandleTest(ManagerTest):
    @classmethod
    def setUpClass(cls):
        cls.bag_folder = tempfile.TemporaryDirectory()
        cls.bag = make_bag_variants.write_variants(
            FLIGHT_BAG, cls.bag_folder.name, SCANS, [FORM])[FORM]

    @classmethod
    def tearDownClass(cls):
        cls.bag_folder.cleanup()

    def play_all(self, listener):
        self.play(self.bag)
        listener.wait_for_integrated(SCANS)

    def wait_for_report(self, probe, name, count):
        wait_for(lambda: self.report(probe)[name] == count,
                 lambda: f'{count} {name} in {probe}: {self.report(probe)}')

    def test_reader_in_the_same_manager_sees_consistent_snapshots(self):
        self.load_probe('probe')
        _, listener = self.load_map(PARAMETERS)
        self.wait_for_report('probe', 'publishers', 1)
        self.play_all(listener)
        self.wait_for_report('probe', 'messages', SCANS)
        report = self.report('probe')
        self.assertEqual((report['null_handles'], report['strangers']), (0, 0))
        self.assertEqual(report['handles'], 1)
        self.assertEqual(report['sequence'], listener.newest().sequence)
        self.assertGreater(report['snapshots'], 1)
        self.assertGreater(report['clouds'], 0)

    def test_late_readers_get_the_handle(self):
        _, listener = self.load_map(PARAMETERS)
        self.play_all(listener)
        # ROS hands the latched message to the first subscriber of a process in another way than to
        # those after it.
        for name in ('late', 'later'):
            self.load_probe(name)
            self.wait_for_report(name, 'messages', 1)
            wait_for(lambda name=name: self.report(name)['snapshots'] > 0, 'a snapshot')
            report = self.report(name)
            self.assertEqual((report['null_handles'], report['strangers']), (0, 0))
            self.assertEqual(report['handles'], 1)
            self.assertEqual(report['sequence'], listener.newest().sequence)

    def test_handle_outlives_its_nodelet_and_a_new_map_replaces_it(self):
        probe = self.load_probe('probe')
        map_loader, listener = self.load_map(PARAMETERS)
        self.wait_for_report('probe', 'publishers', 1)
        self.play_all(listener)
        self.wait_for_report('probe', 'messages', SCANS)

        self.unload(map_loader)
        self.wait_for_report('probe', 'publishers', 0)
        snapshots = self.report('probe')['snapshots']
        self.assertEqual(self.report('probe')['registered'], 1)

        map_loader, listener = self.load_map(PARAMETERS)
        self.wait_for_report('probe', 'publishers', 1)
        self.play_all(listener)
        self.wait_for_report('probe', 'messages', 2 * SCANS)
        report = self.report('probe')
        self.assertEqual(report['handles'], 2)
        self.assertEqual((report['null_handles'], report['strangers']), (0, 0))
        self.assertGreater(report['snapshots'], snapshots)
        self.assertEqual(report['sequence'], listener.newest().sequence)

        # The last owner of the handle goes after the nodelet that made it.
        self.unload(map_loader)
        self.unload(probe)
        self.load_probe('last')
        self.assertEqual(self.report('last')['registered'], 0)

    def test_unloads_while_callbacks_run(self):
        # A callback reads an image from the wire. Images of 16 MB: one is read most of the time.
        side = 2000
        image = Image(height=side, width=side, encoding='32FC1', step=4 * side,
                      data=bytes(4 * side * side))
        publisher = rospy.Publisher('/depth/image', Image, queue_size=2)
        ended = threading.Event()

        def publish():
            while not ended.wait(0.001):
                publisher.publish(image)
        thread = threading.Thread(target=publish)
        thread.start()
        self.addCleanup(publisher.unregister)
        self.addCleanup(thread.join)
        self.addCleanup(ended.set)
        for _ in range(UNLOADS):
            loader, listener = self.load_map(PARAMETERS)
            wait_for(lambda: listener.input_count('scans received') > 2, 'images')
            listener.close()
            self.unload(loader)
            self.assertTrue(self.manager.is_running(), 'the manager died')


if __name__ == '__main__':
    rospy.init_node('handle_test')
    rostest.rosrun('fiimap', 'handle_test', HandleTest)
