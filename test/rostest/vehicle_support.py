"""Tests in which a vehicle flies whose messages can be spoiled."""
import time

from rostest_support import MapTest, wait_for
from vehicle import Vehicle

ENOUGH = 3  # scans
PAUSE = 0.02  # s between scans


class VehicleTest(MapTest):
    def setUp(self):
        self.vehicle = Vehicle()
        self.addCleanup(self.vehicle.close)

    def start_flying(self, parameters):
        """Starts a mapping node; the vehicle's messages reach it when this returns."""
        self.node, self.listener = self.start_map(parameters)
        wait_for(self.vehicle.is_connected, 'the connections of the vehicle')

    def fly_until(self, condition, what, **changes):
        def step():
            self.assertTrue(self.node.is_running(), self.node.output())
            self.vehicle.fly(**changes)
            time.sleep(PAUSE)
            return condition()
        return wait_for(step, what)

    def fly_well(self, scans=ENOUGH, **changes):
        """Flies until so many more scans are integrated."""
        goal = self.listener.newest().integrated + scans
        self.fly_until(lambda: self.listener.newest().integrated >= goal,
                       lambda: f'integrated scans: {self.listener.state()}', **changes)
