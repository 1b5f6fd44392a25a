#!/usr/bin/python3
"""fiimap_flights: its file of flights, and how an interrupted run goes on.

  flights_program_test.py FIIMAP_FLIGHTS
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1)
SMALL = ['simulator.image_width=40', 'simulator.image_height=30', 'simulator.length=10',
         'map.pixel_step=1', 'map.map_size_x=20', 'map.map_size_y=20']
MARK = 123.0  # s, a duration that no flight has that ends after a second


class FlightsProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / 'flights.json'

    def fly(self, *options):
        settings = [part for setting in SMALL for part in ('--set', setting)]
        return subprocess.run(
            [PROGRAM, *settings, '--vary', 'planner.max_speed=1,2', '--time-limit', '1',
             '--json', self.file, *options], capture_output=True, text=True, check=False)

    def flights(self):
        return json.loads(self.file.read_text())

    def test_flights_that_end_early_say_why(self):
        self.assertEqual(self.fly().returncode, 0)
        flights = self.flights()
        self.assertEqual([flight['settings'] for flight in flights],
                         [['planner.max_speed=1'], ['planner.max_speed=2']])
        for flight in flights:
            self.assertFalse(flight['reached'])
            self.assertIn('time', flight['reason'])

    def test_a_run_that_resumes_keeps_what_was_flown(self):
        self.fly()
        first, second = self.flights()
        self.file.write_text(json.dumps([{**first, 'seconds': MARK}]))
        self.assertEqual(self.fly('--resume').returncode, 0)
        kept, flown = self.flights()
        self.assertEqual(kept['seconds'], MARK)
        self.assertEqual((flown['settings'], flown['seconds'], flown['path_length_m']),
                         (second['settings'], second['seconds'], second['path_length_m']))
        self.assertEqual(self.fly('--resume', '--seeds', '2').returncode, 0)
        self.assertEqual([flight['seed'] for flight in self.flights()], [1, 1, 2, 2])
        self.fly()
        self.assertEqual([flight['seconds'] for flight in self.flights()],
                         [first['seconds'], second['seconds']])

    def test_a_file_that_holds_no_flights_is_not_resumed(self):
        self.file.write_text('no JSON')
        result = self.fly('--resume')
        self.assertNotEqual(result.returncode, 0)
        self.assertIn('holds no flights', result.stderr)
        self.assertEqual(self.file.read_text(), 'no JSON')


if __name__ == '__main__':
    unittest.main()
