#!/usr/bin/python3
"""The planner flies a vehicle through a scene, on the map of the mapping nodelet beside it."""
import rospy
import rostest
from dynamic_reconfigure.client import Client
from std_srvs.srv import Trigger

from fiimap.msg import PlannerStatus
from flight_support import Box, Vehicle
from manager_support import ManagerTest
from rostest_support import wait_for

RADIUS = 0.3  # m, inflation
RESOLUTION = 0.1  # m
# Half a voxel's diagonal at each end: from the surface to the centre of the voxel it is in, and from
# the vehicle to the centre of its voxel.
ROUNDING = 0.5 * RESOLUTION * 3.0 ** 0.5
BODY_RADIUS = RADIUS - 2.0 * ROUNDING

MAP = {
    'resolution': RESOLUTION, 'inflation_radius': RADIUS, 'sensor': 'points',
    'extrinsics': 'parameter', 'map_size_x': 24.0, 'map_size_y': 24.0, 'map_size_z': 4.0,
    'virtual_walls': True, 'virtual_floor': 0.2, 'virtual_ceiling': 2.5,
    # Few scans a second: one is enough to see an obstacle.
    'p_hit': 0.9, 'p_miss': 0.45, 'pixel_step': 1, 'scan_queue_size': 100, 'max_pose_wait': 5.0,
    'max_pose_gap': 1.0,
}
PLANNER = {'map': '/map', 'max_speed': 1.5, 'map_timeout': 5.0, 'odometry_timeout': 2.0}

START = (0.0, 0.0, 1.2)
GOAL = (14.0, 0.0, 1.2)
HALF_WAY = (8.0, 0.0, 1.2)  # far enough to be disturbed, and to fly on between columns
COLUMNS = [Box((x, y, 0.0), (x + 0.5, y + 0.5, 3.0)) for x, y in
           [(3.0, -0.3), (3.0, 1.6), (3.2, -2.4), (6.0, -1.4), (6.1, 0.7), (9.0, -0.2), (9.3, 1.7),
            (9.1, -2.0), (11.5, 0.8), (11.4, -1.3)]]
MOST_CHANGES = 600  # of the map, in one flight
FAR_WALL = Box((18.0, -6.0, 0.0), (18.5, 6.0, 3.0))


class PlannerFlightTest(ManagerTest):
    def setUp(self):
        super().setUp()
        self.vehicle = None

    def tearDown(self):
        if self.vehicle:
            self.vehicle.close()
        super().tearDown()

    def take_off(self, boxes=None, start=START, **parameters):
        self.vehicle = Vehicle([*(boxes or COLUMNS), FAR_WALL], start)
        self.map_loader, _ = self.load_map(MAP)
        self.planner_loader = self.load('fiimap/PlannerNodelet', 'planner',
                                        {**PLANNER, **parameters})
        wait_for(self.vehicle.has_planner, 'the planner')
        self.wait_for_state(PlannerStatus.HOVERING)

    def wait_for_state(self, state):
        wait_for(lambda: self.vehicle.status().state == state,
                 lambda: f'state {state}, not {self.vehicle.status()} at {self.vehicle.position}')

    def wait_for_flight(self):
        start = self.vehicle.position[0]
        wait_for(lambda: self.vehicle.position[0] > start + 2.0 and self.vehicle.speed() > 0.5,
                 lambda: f'a flight: {self.vehicle.status()}')

    def wait_for_rest(self):
        def rests():
            commands = self.vehicle.commands
            return commands > 0 and self.vehicle.speed() < 1e-3
        wait_for(rests, lambda: f'rest: {self.vehicle.status()}')

    def assert_safe(self):
        self.assertGreater(self.vehicle.least_clearance(), BODY_RADIUS)

    def test_reaches_the_goal_between_columns(self):
        self.take_off()
        self.vehicle.fly_to(*GOAL)
        self.wait_for_state(PlannerStatus.GOAL_REACHED)
        self.assertLess(self.vehicle.distance_to(*GOAL), 0.35)
        self.assertGreater(self.vehicle.status().plans, 1)
        self.assert_safe()

    def test_keeps_flying_while_the_map_is_reset(self):
        self.take_off()
        self.vehicle.fly_to(*HALF_WAY)
        self.wait_for_flight()
        before = len(self.vehicle.statuses)
        self.assertTrue(rospy.ServiceProxy('/map/reset', Trigger)().success)
        self.wait_for_state(PlannerStatus.GOAL_REACHED)
        states = {status.state for status in self.vehicle.statuses[before:]}
        self.assertNotIn(PlannerStatus.BRAKING, states)
        self.assertNotIn(PlannerStatus.WAITING, states)
        self.assert_safe()

    def test_keeps_flying_while_the_map_is_tuned(self):
        self.take_off()
        client = Client('/map', timeout=30.0)
        self.addCleanup(client.close)
        self.vehicle.fly_to(*GOAL)
        self.wait_for_flight()
        changes = 0
        while self.vehicle.status().state != PlannerStatus.GOAL_REACHED:
            changes += 1
            radius = RADIUS + 0.1 * (changes % 2)
            values = client.update_configuration(
                {'inflation_radius': radius, 'p_occ': 0.75, 'max_ray_length': 6.0 + changes % 3})
            self.assertEqual(values['inflation_radius'], radius)
            rospy.sleep(0.2)
            self.assertLess(changes, MOST_CHANGES, self.vehicle.status())
        self.assertGreater(changes, 5)
        self.assertLess(self.vehicle.distance_to(*GOAL), 0.35)
        self.assert_safe()

    def test_brakes_when_the_map_is_unloaded_and_goes_on_with_a_new_one(self):
        # However long a busy machine takes to unload it, it is missed because it is gone.
        self.take_off(map_timeout=60.0)
        self.vehicle.fly_to(*HALF_WAY)
        self.wait_for_flight()
        before = len(self.vehicle.statuses)
        self.unload(self.map_loader)
        self.wait_for_state(PlannerStatus.WAITING)
        self.wait_for_rest()
        braking = [status for status in self.vehicle.statuses[before:]
                   if status.state == PlannerStatus.BRAKING]
        self.assertTrue(braking)
        self.assertIn('/map is gone', braking[0].reason)
        self.assertGreater(self.vehicle.distance_to(*HALF_WAY), 3.0)
        self.assertIn('brakes: the mapping nodelet /map is gone', self.manager.output())
        self.load_map(MAP)
        self.wait_for_state(PlannerStatus.GOAL_REACHED)
        self.assert_safe()

    def test_brakes_without_odometry_and_says_why(self):
        self.take_off()
        self.vehicle.fly_to(*HALF_WAY)
        self.wait_for_flight()
        self.vehicle.sends_odometry = False
        self.wait_for_state(PlannerStatus.WAITING)
        self.assertIn('no odometry', self.vehicle.status().reason)
        self.wait_for_rest()
        position = self.vehicle.position
        self.vehicle.sends_odometry = True
        self.wait_for_state(PlannerStatus.GOAL_REACHED)
        self.assertGreater(self.vehicle.distance_to(*position), 1.0)
        self.assert_safe()

    def test_gets_out_of_inflated_space(self):
        # The map's inflation reaches the vehicle: it starts 0.25 m beside a wall.
        wall = Box((0.25, -3.0, 0.0), (0.6, 3.0, 3.0))
        self.take_off([wall])
        goal = (-3.0, 0.0, 1.2)
        self.vehicle.fly_to(*goal)
        self.wait_for_state(PlannerStatus.GOAL_REACHED)
        self.assertLess(self.vehicle.distance_to(*goal), 0.35)
        self.assertGreater(self.vehicle.least_clearance(), 0.2)

    def test_says_that_a_walled_goal_has_no_path(self):
        # From wall to wall, from floor to ceiling, all around.
        room = [Box((-3.0, -3.0, 0.0), (3.0, -2.7, 3.0)), Box((-3.0, 2.7, 0.0), (3.0, 3.0, 3.0)),
                Box((-3.0, -3.0, 0.0), (-2.7, 3.0, 3.0)), Box((2.7, -3.0, 0.0), (3.0, 3.0, 3.0))]
        self.take_off(room)
        self.vehicle.fly_to(*GOAL)
        self.wait_for_state(PlannerStatus.NO_PATH)
        self.wait_for_rest()
        self.assert_safe()

    def test_flies_to_waypoints_of_its_parameters(self):
        waypoints = [1.5, 0.0, 1.2, 1.5, 2.5, 1.2, 0.0, 2.5, 1.2]
        self.vehicle = Vehicle([*COLUMNS, FAR_WALL], START)
        self.load_map(MAP)
        self.load('fiimap/PlannerNodelet', 'planner', {**PLANNER, 'waypoints': waypoints})
        wait_for(self.vehicle.has_planner, 'the planner')
        self.wait_for_state(PlannerStatus.GOAL_REACHED)
        self.assertLess(self.vehicle.distance_to(0.0, 2.5, 1.2), 0.35)
        self.assert_safe()

    def test_unloads_in_flight(self):
        self.take_off()
        self.vehicle.fly_to(*GOAL)
        self.wait_for_flight()
        self.unload(self.planner_loader)
        self.unload(self.map_loader)
        commands = self.vehicle.commands
        rospy.sleep(0.5)
        self.assertEqual(self.vehicle.commands, commands)

    def test_launch_file(self):
        self.vehicle = Vehicle([FAR_WALL], START)
        launch = self.start('roslaunch', 'fiimap', 'planner.launch', 'manager:=manager',
                            environment=self.environment)
        wait_for(lambda: any('there is no map /fiimap' in status.reason
                             for status in self.vehicle.statuses),
                 lambda: f'what it needs: {self.vehicle.statuses}')
        self.assertEqual(launch.interrupt(), 0, launch.output())

    def test_a_bad_parameter_is_refused_by_name_and_range(self):
        loader = self.load('fiimap/PlannerNodelet', 'planner', {'max_speed': -1.0})
        loader.wait()
        self.assertIn("parameter max_speed = '-1': must be a number in [0.05, 50] m/s",
                      self.manager.output())


if __name__ == '__main__':
    rospy.init_node('planner_flight_test')
    rostest.rosrun('fiimap', 'planner_flight_test', PlannerFlightTest)
