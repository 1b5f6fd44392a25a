#!/usr/bin/python3
"""Checks the numbers and the quotations of docs/frames.md.

  check_frames.py FIIMAP_EVAL DOCTOR

Of the table of mounts: that the quaternion is what the angles say, and that it turns the sensor's
axes into those that are told. Of the extrinsics of the sample recording: that they make the map
that its TF makes. Of the table of mistakes: that the doctor says what is quoted.
"""
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / 'docs' / 'frames.md'
FLIGHT = ROOT / 'data' / 'synth_flight_excerpt.bag'
FIIMAP_EVAL, DOCTOR = (sys.argv.pop(1), sys.argv.pop(1)) if len(sys.argv) > 2 else ('', '')
MOUNTS = '| Sensor | Turned by: yaw, pitch, roll |'
MISTAKES = '| Mistake | Symptom | The doctor |'
OPTICAL = (-0.5, 0.5, -0.5, 0.5)  # a camera that looks ahead: x y z w
ROUNDING = 2e-4                   # of what follows from the document's numbers
OF_RECORDING = 'camera that looks ahead'
# What makes each mistake on the sample recording, by a word of its row.
MADE_BY = {
    'body frame': ['extrinsics=parameter', 'extrinsic_rotation=0 0 0 1'],
    'inverse': ['extrinsics=parameter', 'extrinsic_rotation=0.5 -0.5 0.5 0.5'],
    'map_frame': ['map_frame=odom'],
    'another body': ['body_frame=imu_link'],
    'stamps': ['time_offset=0.3']}


def table(heading):
    """Rows of the table that begins with a heading: lists of cells."""
    lines = DOCUMENT.read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith(heading))
    rows = []
    for line in lines[start + 2:]:
        if not line.startswith('|'):
            return rows
        rows.append([cell.strip() for cell in line.strip('|').split('|')])
    return rows


def numbers(text):
    return tuple(float(n) for n in re.findall(r'-?\d+(?:\.\d+)?', text))


def product(a, b):
    """Of quaternions x y z w: the rotation b, then a."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def about(axis, degrees):
    half = math.radians(degrees) / 2
    return tuple(math.sin(half) * (i == axis) for i in range(3)) + (math.cos(half),)


def turned(q, vector):
    conjugate = (-q[0], -q[1], -q[2], q[3])
    return product(product(q, (*vector, 0.0)), conjugate)[:3]


class MountsTest(unittest.TestCase):
    def assert_near(self, actual, expected, what):
        self.assertEqual(len(actual), len(expected), what)
        for a, b in zip(actual, expected):
            self.assertAlmostEqual(a, b, delta=ROUNDING, msg=f'{what}: {actual}, {expected}')

    def test_has_the_mounts_that_are_asked_for_most(self):
        names = [row[0] for row in table(MOUNTS)]
        for word in ('ahead', '15 degrees down', 'straight down', 'LiDAR'):
            self.assertTrue(any(word in name for name in names), word)

    def test_the_program_for_other_angles_is_right(self):
        block = re.search(r'^```python\n(.*?)^```', DOCUMENT.read_text(), re.DOTALL | re.MULTILINE)
        program = {'print': lambda *_: None}
        exec(block.group(1), program)
        for angles in ((0, 15, 0), (-45, 20, 5), (180, 0, 90)):
            yaw, pitch, roll = angles
            mount = product(product(about(2, yaw), about(1, pitch)), about(0, roll))
            self.assert_near(program['housing'](*angles), mount, angles)
            self.assert_near(program['product'](mount, OPTICAL), product(mount, OPTICAL), angles)

    def test_quaternions_are_what_the_angles_say(self):
        for name, angles, _, rotation, *_ in table(MOUNTS):
            yaw, pitch, roll = numbers(angles)
            mount = product(product(about(2, yaw), about(1, pitch)), about(0, roll))
            expected = product(mount, OPTICAL) if 'camera' in name.lower() else mount
            actual = numbers(rotation)
            # q and -q are the same rotation.
            if sum(a * b for a, b in zip(actual, expected)) < 0:
                expected = tuple(-e for e in expected)
            self.assert_near(actual, expected, name)

    def test_quaternions_turn_the_axes_as_told(self):
        for name, _, _, rotation, *axes in table(MOUNTS):
            self.assertEqual(len(axes), 3, name)
            for i, axis in enumerate(axes):
                unit = tuple(float(i == k) for k in range(3))
                self.assert_near(turned(numbers(rotation), unit), numbers(axis), name)

    def test_point_of_the_worked_example(self):
        """p_body = R p_sensor + t, as the document computes it."""
        text = DOCUMENT.read_text()
        found = re.search(r'\((.+?)\) in the optical frame is \((.+?)\) in the body', text)
        row = next(row for row in table(MOUNTS) if '15 degrees down' in row[0])
        point = turned(numbers(row[3]), numbers(found.group(1)))
        expected = [p + t for p, t in zip(point, numbers(row[2]))]
        self.assertTrue(all(abs(a - b) < 0.005 for a, b in zip(numbers(found.group(2)), expected)),
                        f'{found.group(2)} should be {expected}')


class ProgramsTest(unittest.TestCase):
    def map_of(self, *settings):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / 'figures.json'
            command = [FIIMAP_EVAL, 'run', str(FLIGHT), '--json', str(file)]
            for setting in settings:
                command += ['--set', setting]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            figures = json.loads(file.read_text())
        return figures['occupied'], figures['inflated']

    def test_extrinsics_of_the_recording_make_the_map_of_its_tf(self):
        row = next(row for row in table(MOUNTS) if OF_RECORDING in row[0])
        translation, rotation = (' '.join(f'{n:g}' for n in numbers(row[i])) for i in (2, 3))
        self.assertEqual(self.map_of(),
                         self.map_of('extrinsics=parameter', f'extrinsic_translation={translation}',
                                     f'extrinsic_rotation={rotation}'))

    def test_the_doctor_says_what_is_quoted(self):
        rows = table(MISTAKES)
        for word, settings in MADE_BY.items():
            row = next((r for r in rows if word in r[0]), None)
            self.assertIsNotNone(row, word)
            quotations = re.findall(r'"(.+?)"', row[2])
            self.assertTrue(quotations, word)
            said = self.said_by_doctor(settings)
            for quotation in quotations:
                for part in quotation.split(' ... '):
                    self.assertIn(part, said)

    def said_by_doctor(self, settings):
        command = [DOCTOR, str(FLIGHT), '--seconds', '3']
        for setting in settings:
            command += ['--set', setting]
        output = subprocess.run(command, stdout=subprocess.PIPE, text=True).stdout
        return ' '.join(output.split())


if __name__ == '__main__':
    unittest.main()
