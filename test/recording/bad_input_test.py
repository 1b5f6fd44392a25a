#!/usr/bin/python3
"""Every command of fiimap_eval with bad input: one sentence, a failure, nothing left behind."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import rosbag
import rospy

SOURCE = pathlib.Path(__file__).resolve().parents[2]
COW = SOURCE / 'data' / 'cow_and_lady_excerpt.bag'
COW_CONFIG = ['--config', SOURCE / 'config' / 'cow_and_lady.yaml']
SCENE = SOURCE / 'data' / 'synth_flight_scene.json'
OUTPUTS = {  # the options with which a command leaves files
    'run': ['--save', 'map'], 'health': [], 'accuracy': ['--octomap'], 'sweep': [],
    'compare': ['--csv'], 'truth': ['--scene', SCENE, '--voxels', 'voxels.csv'],
}
EVAL = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else ''


class BadInputTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.root = pathlib.Path(temporary.name)
        self.work = self.root / 'work'  # where commands run
        self.work.mkdir()
        self.bag = self.root / 'recording.bag'

    def fails(self, arguments, words):
        """One sentence with these words on standard error, a failure, and no file."""
        result = subprocess.run([EVAL, *map(str, arguments)], cwd=self.work, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=300)
        self.assertEqual(result.returncode, 1, arguments)
        errors = [line for line in result.stderr.splitlines() if line.startswith('error: ')]
        self.assertEqual(len(errors), 1, result.stderr)
        self.assertNotIn('Traceback', result.stderr)
        for word in words:
            self.assertIsNotNone(re.search(word, errors[0]), f'{word}: {errors[0]}')
        self.assertEqual(list(self.work.iterdir()), [], arguments)

    def refused(self, *words, settings=COW_CONFIG):
        """By every command."""
        for command, outputs in OUTPUTS.items():
            with self.subTest(command):
                self.fails([command, self.bag, *outputs, *settings, '--json', 'figures.json'],
                           words)
        with self.subTest('report'):
            self.fails(['report', self.bag, '-o', 'pages', *settings], words)

    def copy_of_cow(self, keep, shift=0.0):
        """Messages whose topic is kept; stamps of poses shifted, s."""
        with rosbag.Bag(str(COW)) as source, rosbag.Bag(str(self.bag), 'w') as target:
            for topic, message, time in source.read_messages():
                if not keep(topic):
                    continue
                if shift and 'transform' in topic:
                    message.header.stamp += rospy.Duration(shift)
                target.write(topic, message, time)

    def test_truncated(self):
        whole = COW.read_bytes()
        for size in (len(whole) // 2, len(whole) - 100):
            self.bag.write_bytes(whole[:size])
            self.refused('the bag .*recording.bag is damaged', 'longer than the file')

    def test_no_bag(self):
        self.bag.write_text('This is no bag.')
        self.refused('cannot read the bag')

    def test_missing(self):
        self.refused('recording.bag', 'missing|not a file')

    def test_no_pose_topic(self):
        self.copy_of_cow(lambda topic: 'transform' not in topic)
        self.refused('no geometry_msgs/TransformStamped')
        self.refused('no poses', settings=[])

    def test_no_depth_topic(self):
        self.copy_of_cow(lambda topic: 'transform' in topic)
        self.refused('no sensor_msgs/PointCloud2')

    def test_unknown_configuration_key(self):
        self.bag = COW
        config = self.root / 'config.yaml'
        config.write_text('resolutoin: 0.1\n')
        self.refused('unknown parameter resolutoin', settings=['--config', config])

    def test_no_scan_has_a_pose(self):
        self.copy_of_cow(lambda topic: True, shift=1000.0)
        self.refused('no scan could be integrated: pose_')

    def test_no_scan_has_a_pose_and_the_camera_is_nowhere(self):
        self.bag = COW
        self.refused('no scan could be integrated: no_extrinsics', settings=[])

    def test_nowhere_to_write(self):
        self.bag = COW
        for command, outputs in OUTPUTS.items():
            with self.subTest(command):
                self.fails([command, COW, *COW_CONFIG, *outputs, '--json', 'nowhere/figures.json'],
                           ['cannot write nowhere/figures.json: No such file'])
        self.fails(['run', COW, *COW_CONFIG, '--json', 'figures.json', '--save', 'nowhere/map'],
                   ['cannot write nowhere/map'])
        self.fails(['truth', COW, *COW_CONFIG, '--json', 'figures.json', '--scene', SCENE,
                    '--voxels', 'nowhere/voxels.csv'], ['cannot write nowhere/voxels.csv'])

    def test_files_of_another_kind(self):
        other = self.root / 'other.yaml'
        other.write_text('no: scene, no split')
        json = ['--json', 'figures.json']
        self.fails(['truth', COW, *COW_CONFIG, *json, '--scene', other], ['other.yaml is no scene'])
        self.fails(['accuracy', COW, *COW_CONFIG, *json, '--split', other], ['other.yaml'])
        self.fails(['accuracy', COW, *COW_CONFIG, *json], ['no scan was held out of 4'])


if __name__ == '__main__':
    unittest.main()
