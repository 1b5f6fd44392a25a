"""What the tests of the mapping node share: processes, recordings, and what the node publishes."""
import json
import os
import pathlib
import tempfile
import time
import unittest
import xmlrpc.client

import roslib.packages
import rosbag
import rospkg
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import PointCloud2

from fiimap.msg import Statistics
from process import PATIENCE, Process
from voxels import voxels_of_cloud, voxels_of_pcd

PACKAGE = pathlib.Path(rospkg.RosPack().get_path('fiimap'))
DATA = PACKAGE / 'data'
FLIGHT_BAG = DATA / 'synth_flight_excerpt.bag'

POLL = 0.02  # s

# Recordings must arrive whole, however slow the machine: no scan may be too late.
PATIENT_QUEUES = {
    'scan_queue_size': 1000, 'ready_queue_size': 1000, 'max_pose_wait': 100.0,
    'pose_history': 100.0,
}


def recording(name):
    """A recording that does not come with the package, or None when there is none."""
    folders = [PACKAGE.parent / 'shared' / 'data']
    if 'FIIMAP_DATA' in os.environ:
        folders.insert(0, pathlib.Path(os.environ['FIIMAP_DATA']))
    found = [folder / name for folder in folders if (folder / name).is_file()]
    return found[0] if found else None


def cut(source, target, scan_topic, scans, first=0):
    """Copies a number of scans of a bag from the given one on, and the messages between them."""
    passed = 0
    transforms = []
    with rosbag.Bag(str(source)) as bag, rosbag.Bag(str(target), 'w') as output:
        for topic, message, stamp, connection in bag.read_messages(return_connection_header=True):
            if passed < first:
                if topic == '/tf_static':
                    transforms.append((topic, message, connection))
                passed += topic == scan_topic
                continue
            # Not at their own time: the excerpt begins here.
            for static_topic, transform, header in transforms:
                output.write(static_topic, transform, stamp, connection_header=header)
            transforms.clear()
            if topic == scan_topic:
                passed += 1
                if passed > first + scans:
                    break
            output.write(topic, message, stamp, connection_header=connection)
    return target


def program(package, name):
    return roslib.packages.find_node(package, name)[0]


def flat(parameters):
    """Names and values; those of a sensor as 'front/max_depth'."""
    for name, value in parameters.items():
        if isinstance(value, dict):
            yield from ((f'{name}/{key}', own) for key, own in value.items())
        else:
            yield name, value


def wait_for(condition, what):
    """Waits until the condition holds and returns its value.

    What is waited for is a text, or a function that tells more when the waiting was in vain."""
    end = time.monotonic() + PATIENCE
    while not rospy.is_shutdown() and time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(POLL)
    raise AssertionError(f'waited in vain for {what() if callable(what) else what}')


def topics_between(publisher, subscriber):
    """Topics on which one node sends to another, both by name."""
    node = xmlrpc.client.ServerProxy(rospy.get_master().lookupNode(publisher)[2])
    _, _, connections = node.getBusInfo(rospy.get_name())
    return {topic for _, destination, direction, _, topic, *_ in connections
            if (destination, direction) == (subscriber, 'o')}


class Map:
    """Hears all that a mapping node of a name publishes."""

    def __init__(self, name):
        self.name = name
        self.statistics = []
        self.diagnostics = {}  # newest status by name of the task
        self.input_statuses = []  # all of the task `inputs`
        self.clouds = {}  # newest by topic
        self._subscribers = [
            rospy.Subscriber(f'/{name}/statistics', Statistics, self.statistics.append),
            rospy.Subscriber('/diagnostics', DiagnosticArray, self._on_diagnostics)]
        for topic in ('occupied', 'inflated'):
            self._subscribers.append(rospy.Subscriber(
                f'/{name}/{topic}', PointCloud2, self._on_cloud, topic, buff_size=1 << 24))

    def is_connected(self):
        return all(subscriber.get_num_connections() > 0 for subscriber in self._subscribers)

    def close(self):
        for subscriber in self._subscribers:
            subscriber.unregister()

    def _on_cloud(self, cloud, topic):
        self.clouds[topic] = cloud

    def _on_diagnostics(self, message):
        for status in message.status:
            node, task = status.name.split(': ')
            if node == self.name:
                self.diagnostics[task] = status
                if task == 'inputs' and status.values:  # the first one says "starting up" alone
                    self.input_statuses.append(status)

    def newest(self):
        return self.statistics[-1] if self.statistics else Statistics()

    def dropped(self):
        """Dropped scans by reason at the newest scan."""
        return {drop.reason: drop.count for drop in self.newest().drops}

    def input_count(self, key):
        """A number of the task `inputs` of /diagnostics, which also changes without scans."""
        status = self.diagnostics.get('inputs')
        values = {value.key: value.value for value in status.values} if status else {}
        return int(values.get(key, 0))

    def state(self):
        return f'{self.newest().integrated}, {self.dropped()}, {self.diagnostics.get("inputs")}'

    def wait_for_integrated(self, scans):
        """Waits until so many scans were integrated, and returns the newest statistics."""
        wait_for(lambda: self.newest().integrated >= scans,
                 lambda: f'{scans} integrated scans: {self.state()}')
        return self.newest()

    def wait_for_received(self, scans):
        """Waits until so many scans came and none of them is on its way into the map or out of it.

        Returns the newest statistics."""
        def are_done():
            waiting = self.input_count('scans waiting')
            integrated = self.input_count('scans integrated')
            return (self.input_count('scans received') == scans and waiting == 0
                    and self.newest().integrated == integrated > 0)
        wait_for(are_done, lambda: f'{scans} received scans: {self.state()}')
        return self.newest()

    def wait_for_clouds(self):
        """Both clouds of the newest scan, as (occupied, inflated)."""
        def are_new():
            stamp = self.newest().header.stamp
            return len(self.clouds) == 2 and all(
                cloud.header.stamp == stamp for cloud in self.clouds.values())
        wait_for(are_new, 'clouds of the newest scan')
        return self.clouds['occupied'], self.clouds['inflated']


class MapTest(unittest.TestCase):
    """A test with a directory of its own and with processes that end with it.

    After every test the statistics of all maps must add up, and what failed shows all output."""

    def run(self, result=None):
        troubles = len(result.failures) + len(result.errors)
        self.processes = []
        self.maps = []
        with tempfile.TemporaryDirectory() as directory:
            self.directory = pathlib.Path(directory)
            super().run(result)
            for process in reversed(self.processes):
                if process.is_running():
                    process.kill()
            if len(result.failures) + len(result.errors) > troubles:
                for process in self.processes:
                    print(f'--- {process.name}\n{process.output()}')
        for listener in self.maps:
            listener.close()
        return result

    def tearDown(self):
        for listener in self.maps:
            for statistics in listener.statistics:
                self.assert_conserved(statistics)
            for status in listener.input_statuses:
                self.assert_conserved_in_diagnostics(status)

    def assert_conserved(self, statistics):
        s = statistics
        self.assertEqual(s.received, s.integrated + s.dropped + s.waiting, s)
        self.assertEqual(s.dropped, sum(drop.count for drop in s.drops), s)

    def assert_conserved_in_diagnostics(self, status):
        values = {value.key: value.value for value in status.values}
        received, integrated, waiting, dropped = (
            int(values[f'scans {name}']) for name in ('received', 'integrated', 'waiting', 'dropped'))
        self.assertEqual(received, integrated + waiting + dropped, status)
        self.assertEqual(dropped, sum(int(value) for key, value in values.items()
                                      if key.startswith('dropped: ')), status)

    def start(self, *command, environment=None):
        log = self.directory / f'process_{len(self.processes)}.log'
        self.processes.append(Process(command, log, environment))
        return self.processes[-1]

    def listen(self, name='map'):
        self.maps.append(Map(name))
        return self.maps[-1]

    def set_parameters(self, parameters, name='map'):
        if rospy.has_param(f'/{name}'):
            rospy.delete_param(f'/{name}')
        if parameters:
            rospy.set_param(f'/{name}', parameters)

    def start_map(self, parameters, *arguments, name='map'):
        """A mapping node in a process of its own, and a listener that is connected to it."""
        self.set_parameters(parameters, name)
        listener = self.listen(name)
        process = self.start(program('fiimap', 'mapping_node'), f'__name:={name}', *arguments)
        self.wait_for_map(listener, process)
        return process, listener

    def wait_for_map(self, listener, process):
        """Waits until a map is ready for input and its listener hears all."""
        def is_ready():
            self.assertTrue(process.is_running(), process.output())
            return listener.is_connected() and listener.diagnostics
        wait_for(is_ready, f'the map {listener.name}')

    def play(self, bag, *arguments):
        """Plays a bag to its end; every topic of it must have a subscriber."""
        player = self.start(program('rosbag', 'play'), '--quiet', '--clock',
                            '--wait-for-subscribers', *arguments, bag)
        self.assertEqual(player.wait(), 0, player.output())

    def evaluate(self, bag, parameters, config=None):
        """Figures of the offline tool; the map is in self.directory, offline_occupied.pcd, ..."""
        prefix = self.directory / 'offline'
        report = self.directory / 'offline.json'
        command = [program('fiimap', 'fiimap_eval'), 'run', bag, '--save', prefix, '--json', report]
        if config:
            command += ['--config', config]
        for name, value in flat(parameters):
            words = value if isinstance(value, list) else [value]
            command += ['--set', f'{name}=' + ' '.join(str(word) for word in words)]
        evaluation = self.start(*command)
        self.assertEqual(evaluation.wait(), 0, evaluation.output())
        figures = json.loads(report.read_text())
        self.assertEqual(figures['scans'], figures['integrated'] + sum(figures['dropped'].values()))
        return figures

    def assert_clouds_equal_offline(self, listener, resolution):
        """The node's newest clouds show the voxels of the offline tool's map, no more, no less."""
        for cloud, layer in zip(listener.wait_for_clouds(), ('occupied', 'inflated')):
            offline = voxels_of_pcd(self.directory / f'offline_{layer}.pcd', resolution)
            live = voxels_of_cloud(cloud, resolution)
            self.assertEqual(len(live - offline), 0, f'{layer} in the node only')
            self.assertEqual(len(offline - live), 0, f'{layer} in the offline tool only')
            self.assertGreater(len(live), 0)

    def assert_same_map_offline(self, bag, parameters, *remappings):
        """Plays a bag to a mapping node, and compares its map with that of the offline tool."""
        offline = self.evaluate(bag, parameters)
        self.assertEqual(offline['integrated'], offline['scans'], offline['warnings'])
        _, listener = self.start_map(parameters, *remappings)
        self.play(bag, '--rate=2')
        newest = listener.wait_for_integrated(offline['integrated'])
        self.assertEqual(newest.received, offline['scans'])
        self.assertEqual((newest.occupied, newest.inflated),
                         (offline['occupied'], offline['inflated']))
        self.assert_clouds_equal_offline(listener, parameters['resolution'])
