#!/usr/bin/python3
"""Mapping, planner and simulated vehicle fly together, and the vehicle is safe because of the map."""
import rospy
import rostest
from std_srvs.srv import Trigger

from fiimap.msg import PlannerStatus, SimulatorTruth
from manager_support import ManagerTest
from rostest_support import PATIENT_QUEUES, wait_for

LENGTH = 20.0  # m
VEHICLE_RADIUS = 0.2  # m
SEEDS = (1, 2, 3)

# Time waits for map and planner, so that a slow machine flies the same.
SIMULATOR = {
    'world': 'forest', 'length': LENGTH, 'tree_density': 0.12, 'depth_noise': True,
    'image_width': 320, 'image_height': 240, 'max_range': 10.0, 'vehicle_radius': VEHICLE_RADIUS,
    'publish_clock': True, 'real_time_factor': 0.0, 'max_lead': 0.15}
MAP = {
    **PATIENT_QUEUES, 'pixel_step': 1, 'inflation_radius': 0.4, 'map_size_x': 40.0,
    'map_size_y': 40.0, 'virtual_walls': True, 'virtual_floor': 0.3, 'virtual_ceiling': 3.5}
PLANNER = {
    'map': '/map', 'waypoints': [LENGTH, 0.0, 1.5], 'goal_tolerance': 0.5, 'braking_margin': 0.4}
# A map that is broken on purpose: nothing is near enough to be seen.
BLIND = {'max_depth': 0.31, 'max_ray_length': 0.31}


class SimulatedFlightTest(ManagerTest):
    def setUp(self):
        super().setUp()
        self.loaders = []
        self.subscribers = []
        self.addCleanup(self.stop_listening)

    def listen_to_flight(self):
        """What comes late from the flight before does not get into what is heard of this one."""
        self.heard = heard = {}
        for topic, kind in (('/simulator/truth', SimulatorTruth),
                            ('/planner/status', PlannerStatus)):
            self.subscribers.append(rospy.Subscriber(
                topic, kind, lambda message, topic=topic: heard.update({topic: message})))

    def stop_listening(self):
        while self.subscribers:
            self.subscribers.pop().unregister()

    @property
    def truth(self):
        return self.heard.get('/simulator/truth')

    def state(self):
        status = self.heard.get('/planner/status')
        return status.state if status else None

    def take_off(self, seed, map_changes=None):
        """Loads the three; the vehicle sets out as soon as there is a map."""
        self.listen_to_flight()
        self.loaders.clear()
        self.map_loader = self.load('fiimap/MappingNodelet', 'map', {**MAP, **(map_changes or {})},
                                    'depth/image:=/camera/depth/image_raw',
                                    'depth/camera_info:=/camera/depth/camera_info')
        listener = self.listen()
        self.loaders.append(self.map_loader)
        wait_for(listener.is_connected, 'the map')
        planner = self.load('fiimap/PlannerNodelet', 'planner', PLANNER)
        simulator = self.load('fiimap/SimulatorNodelet', 'simulator', {**SIMULATOR, 'seed': seed},
                              'map_statistics:=/map/statistics',
                              'planner_status:=/planner/status')
        self.loaders += [planner, simulator]
        wait_for(lambda: self.truth and self.state() == PlannerStatus.FLYING, self.describe)

    def land(self):
        self.stop_listening()
        for loader in reversed(self.loaders):
            self.unload(loader)

    def describe(self):
        return f'the flight: {self.heard}'

    def fly(self, seed, map_changes=None):
        """The truth at the end of a flight to the goal."""
        try:
            self.take_off(seed, map_changes)
            wait_for(lambda: self.state() == PlannerStatus.GOAL_REACHED, self.describe)
            return self.truth
        finally:
            self.land()

    def assert_safe(self, truth):
        self.assertEqual(truth.collisions, 0, truth)
        self.assertGreaterEqual(truth.least_clearance, VEHICLE_RADIUS, truth)
        self.assertGreater(truth.path_length, LENGTH - 1.0, truth)

    def test_reaches_the_goal_without_collision(self):
        for seed in SEEDS:
            with self.subTest(seed=seed):
                self.assert_safe(self.fly(seed))

    def test_fails_on_a_map_that_is_always_free(self):
        truths = [self.fly(seed, BLIND) for seed in SEEDS]
        with self.assertRaises(AssertionError, msg='the flights show nothing'):
            for truth in truths:
                self.assert_safe(truth)

    def test_keeps_flying_while_the_map_is_reset(self):
        self.take_off(SEEDS[0])
        for distance in (6.0, 12.0):
            wait_for(lambda: self.truth.position.x > distance, self.describe)
            self.assertTrue(rospy.ServiceProxy('/map/reset', Trigger)().success)
        wait_for(lambda: self.state() == PlannerStatus.GOAL_REACHED, self.describe)
        self.assert_safe(self.truth)

    def test_brakes_when_the_map_is_unloaded(self):
        self.take_off(SEEDS[0])
        wait_for(lambda: self.truth.position.x > 6.0, self.describe)
        self.unload(self.map_loader)
        wait_for(lambda: self.state() == PlannerStatus.WAITING, self.describe)
        velocity = self.truth.velocity
        self.assertLess(max(abs(velocity.x), abs(velocity.y), abs(velocity.z)), 0.3)
        self.assertLess(self.truth.position.x, LENGTH - 2.0)
        self.assertEqual(self.truth.collisions, 0)
        self.assertIn('brakes: the mapping nodelet /map is gone', self.manager.output())


if __name__ == '__main__':
    rospy.init_node('simulated_flight_test')
    rostest.rosrun('fiimap', 'simulated_flight_test', SimulatedFlightTest)
