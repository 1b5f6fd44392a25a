"""A nodelet manager with the mapping nodelet and readers of its handle."""
import os
import pathlib

import rospy
from std_srvs.srv import Trigger

import rostest_support
from rostest_support import program

PROBE_PACKAGE = pathlib.Path(__file__).resolve().parent / 'handle_probe'


class ManagerTest(rostest_support.MapTest):
    """A test with nodelets in one manager, which must be alive at the end."""

    def setUp(self):
        path = f'{PROBE_PACKAGE}:{os.environ["ROS_PACKAGE_PATH"]}'
        self.environment = {'ROS_PACKAGE_PATH': path}
        self.manager = self.start(program('nodelet', 'nodelet'), 'manager', '__name:=manager',
                                  environment=self.environment)
        rospy.wait_for_service('/manager/list')

    def tearDown(self):
        super().tearDown()
        self.assertTrue(self.manager.is_running(), 'the manager died')

    def load(self, nodelet, name, parameters, *remappings):
        """Loads a nodelet. It is unloaded when the returned process is interrupted."""
        self.set_parameters(parameters, name)
        return self.start(program('nodelet', 'nodelet'), 'load', nodelet, '/manager',
                          f'__name:={name}', *remappings, environment=self.environment)

    def load_map(self, parameters):
        loader = self.load('fiimap/MappingNodelet', 'map', parameters)
        listener = self.listen()
        self.wait_for_map(listener, loader)
        return loader, listener

    def load_probe(self, name):
        loader = self.load('fiimap/HandleProbe', name, {'map': '/map'})
        rospy.wait_for_service(f'/{name}/report')
        return loader

    def unload(self, loader):
        self.assertEqual(loader.interrupt(), 0, loader.output())

    def report(self, name):
        """What a probe saw, as numbers by name; nothing of it may have been wrong."""
        response = rospy.ServiceProxy(f'/{name}/report', Trigger)()
        self.assertTrue(response.success, response.message)
        return {key: int(value) for key, value in
                (word.split('=') for word in response.message.split())}
