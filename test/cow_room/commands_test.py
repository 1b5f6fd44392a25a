#!/usr/bin/python3
"""From the recording to a rendered one by the commands that a user types."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import rosbag

SOURCE = pathlib.Path(__file__).resolve().parents[2]
COW = SOURCE / 'data' / 'cow_and_lady_excerpt.bag'
CLOUDS = '/camera/depth_registered/points'
TRANSFORMS = '/kinect/vrpn_client/estimated_transform'
COW_ROOM = sys.argv.pop(1) if len(sys.argv) > 1 else ''


def run(*command):
    return subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE)


def stamps_and_times(path, topic):
    with rosbag.Bag(str(path)) as bag:
        return [(round(message.header.stamp.to_sec(), 6), round(time.to_sec(), 6))
                for _, message, time in bag.read_messages(topics=[topic])]


class CommandsTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.root = pathlib.Path(temporary.name)
        self.trajectory = self.root / 'trajectory.txt'
        self.bag = self.root / 'room.bag'

    def test_the_rendered_recording_has_the_times_of_the_real_one(self):
        listed = run(SOURCE / 'scripts' / 'cow_trajectory', COW)
        self.assertEqual(listed.returncode, 0, listed.stderr)
        self.trajectory.write_text(listed.stdout)
        made = run(COW_ROOM, self.trajectory, '-o', self.bag, '--pixel-step', 8)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertIn('4 scans', made.stdout)
        clouds = stamps_and_times(COW, CLOUDS)
        self.assertEqual(len(clouds), 4)
        self.assertEqual(stamps_and_times(self.bag, CLOUDS), clouds)
        poses = stamps_and_times(self.bag, TRANSFORMS)
        self.assertLessEqual(poses[0][0], clouds[0][0])
        self.assertGreater(poses[-1][0], clouds[-1][0])

    def test_renders_as_many_scans_as_asked_for(self):
        self.trajectory.write_text(run(SOURCE / 'scripts' / 'cow_trajectory', COW).stdout)
        made = run(COW_ROOM, self.trajectory, '-o', self.bag, '--scans', 2, '--pixel-step', 16)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertEqual(len(stamps_and_times(self.bag, CLOUDS)), 2)

    def test_bad_input_is_refused_in_one_sentence(self):
        self.trajectory.write_text('1.0 0 0\n')
        missing = self.root / 'missing'
        for command, word in (
                ((COW_ROOM, self.trajectory, '-o', self.bag), 'line 1: must be stamp'),
                ((COW_ROOM, missing, '-o', self.bag), 'cannot read'),
                ((COW_ROOM, self.trajectory), '-o BAG is missing'),
                ((COW_ROOM, '-o', self.bag), 'no trajectory'),
                ((SOURCE / 'scripts' / 'cow_trajectory', missing), 'missing'),
                ((SOURCE / 'scripts' / 'cow_trajectory', self.trajectory), 'trajectory.txt')):
            result = run(*command)
            self.assertEqual(result.returncode, 1, command)
            self.assertTrue(result.stderr.startswith('error: '), result.stderr)
            self.assertEqual(result.stderr.count('\n'), 1, result.stderr)
            self.assertIn(word, result.stderr)
        self.assertEqual(list(self.root.iterdir()), [self.trajectory])


if __name__ == '__main__':
    unittest.main()
