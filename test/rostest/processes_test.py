#!/usr/bin/python3
"""Bad configurations end the node with a message; Ctrl-C ends it cleanly at any moment."""
import rospy
import rostest

import make_bag_variants
from rostest_support import FLIGHT_BAG, PATIENT_QUEUES, MapTest, program

BAD_PARAMETERS = (
    # name, value, what the message must mention beside the name
    ('resolution', -1, ('-1', '[0.01, 10]')),
    ('resolution', 0.0, ('0', '[0.01, 10]')),
    ('resolution', 'coarse', ('coarse', 'number')),
    ('resolution', [0.1, 0.2], ('0.1 0.2', 'number')),
    ('pixel_step', 1.5, ('1.5',)),
    ('virtual_walls', 'perhaps', ('perhaps', 'true')),
    ('sensor', 'sonar', ('sonar', 'depth', 'points')),
    ('map_frame', '', ("''",)),
    ('extrinsic_rotation', [0, 0, 0, 2], ('0 0 0 2', 'norm 1')),
)


class ProcessesTest(MapTest):
    def run_node(self, parameters):
        self.set_parameters(parameters)
        return self.start(program('fiimap', 'mapping_node'), '__name:=map')

    def start_manager(self):
        manager = self.start(program('nodelet', 'nodelet'), 'manager', '__name:=manager')
        rospy.wait_for_service('/manager/list')
        return manager

    def load_map(self, parameters, *options):
        self.set_parameters(parameters)
        return self.start(program('nodelet', 'nodelet'), 'load', 'fiimap/MappingNodelet',
                          '/manager', *options, '__name:=map')

    def assert_clean_end(self, process):
        self.assertEqual(process.interrupt(), 0, process.output())
        for trouble in ('terminate called', 'Segmentation', 'exception', 'FATAL'):
            self.assertNotIn(trouble, process.output())

    def test_bad_parameters_end_the_node_with_a_message(self):
        for name, value, words in BAD_PARAMETERS:
            with self.subTest(name=name, value=value):
                node = self.run_node({name: value})
                self.assertNotEqual(node.wait(), 0, node.output())
                for word in (name, *words):
                    self.assertIn(word, node.output())

    def test_unknown_parameters_are_named(self):
        node, _ = self.start_map({'resolutoin': 0.1})
        self.assertIn('resolutoin', node.output())
        self.assert_clean_end(node)

    def test_manager_survives_a_bad_parameter(self):
        manager = self.start_manager()
        loader = self.load_map({'resolution': -1})
        self.assertNotEqual(loader.wait(), 0, loader.output())
        self.assertTrue(manager.is_running())
        for word in ('resolution', '-1', '[0.01, 10]'):
            self.assertIn(word, manager.output())

        loader = self.load_map({'resolution': 0.1})
        listener = self.listen()
        self.wait_for_map(listener, loader)
        self.assert_clean_end(loader)
        self.assertTrue(manager.is_running())

    def test_interrupt_before_any_input(self):
        node, _ = self.start_map({})
        self.assert_clean_end(node)

    def map_while_playing(self, start):
        """Runs until the map has grown; the bag goes on playing."""
        form = ('depth', 'odometry')
        bag = make_bag_variants.write_variants(FLIGHT_BAG, self.directory, 20, [form])[form]
        process, listener = start(PATIENT_QUEUES)
        self.start(program('rosbag', 'play'), '--quiet', '--clock', '--loop',
                   '--wait-for-subscribers', bag)
        listener.wait_for_integrated(3)
        return process

    def test_interrupt_while_mapping(self):
        node = self.map_while_playing(self.start_map)
        self.assert_clean_end(node)

    def test_interrupt_of_the_manager_while_mapping(self):
        manager = self.start_manager()

        # A manager that ends while a loader is bonded to it may crash in the destructor of its own
        # nodelet::Loader, whatever nodelet it holds (ros/nodelet_core #99).
        def load(parameters):
            return self.load_map(parameters, '--no-bond'), self.listen()
        self.map_while_playing(load)
        self.assert_clean_end(manager)


if __name__ == '__main__':
    rospy.init_node('processes_test')
    rostest.rosrun('fiimap', 'processes_test', ProcessesTest)
