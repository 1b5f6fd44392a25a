#!/usr/bin/python3
"""Subscribers in other processes take nothing from the readers in the nodelet manager."""
import rosbag
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Path
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import Marker

import make_bag_variants
from fiimap.msg import MapInfo, Statistics
from manager_support import ManagerTest
from rostest_support import FLIGHT_BAG, PATIENT_QUEUES, program, topics_between, wait_for

TOPICS = {
    '/map/occupied': PointCloud2, '/map/inflated': PointCloud2, '/map/statistics': Statistics,
    '/map/map_handle': MapInfo, '/map/window': Marker, '/map/path': Path,
    '/map/vehicle': Marker, '/diagnostics': DiagnosticArray,
}
SCANS = 20
PARAMETERS = {**PATIENT_QUEUES, 'resolution': 0.1}


class OtherProcessesTest(ManagerTest):
    def subscribe(self):
        """Messages by topic, as they come in, and the subscribers."""
        messages = {topic: [] for topic in TOPICS}
        subscribers = [
            rospy.Subscriber(topic, kind, messages[topic].append, buff_size=1 << 24)
            for topic, kind in TOPICS.items()]
        for subscriber in subscribers:
            self.addCleanup(subscriber.unregister)
        return messages, subscribers

    def record(self):
        """Starts recording every topic, and waits until the manager is connected to the recorder
        on all."""
        file = self.directory / 'record.bag'
        recorder = self.start(program('rosbag', 'record'), '-O', file, '__name:=recorder', *TOPICS)
        wait_for(lambda: set(TOPICS) <= topics_between('/manager', '/recorder'),
                 lambda: f'the recorder, which has {topics_between("/manager", "/recorder")}')
        return recorder, file

    def write_bag(self):
        form = ('depth', 'odometry')
        return make_bag_variants.write_variants(FLIGHT_BAG, self.directory, SCANS, [form])[form]

    def test_handle_reaches_nodelets_while_others_listen_and_record(self):
        self.load_probe('probe')
        messages, subscribers = self.subscribe()
        _, listener = self.load_map(PARAMETERS)
        wait_for(lambda: all(s.get_num_connections() > 0 for s in subscribers), 'connections')
        wait_for(lambda: self.report('probe')['publishers'] == 1, 'the connection of the probe')
        recorder, recorded_file = self.record()
        diagnostics = len(messages['/diagnostics'])
        self.play(self.write_bag())
        listener.wait_for_integrated(SCANS)
        for topic, received in messages.items():
            wait_for(lambda received=received: received, topic)
        # They come without scans, and the recorder must have had time for one of them.
        wait_for(lambda: len(messages['/diagnostics']) > diagnostics + 1, 'diagnostics')
        wait_for(lambda: len(messages['/map/map_handle']) == SCANS, 'map infos')
        wait_for(lambda: len(messages['/map/statistics']) == SCANS, 'statistics')

        wait_for(lambda: self.report('probe')['messages'] == SCANS, 'handles')
        report = self.report('probe')
        self.assertEqual((report['messages'], report['null_handles']), (SCANS, 0))
        self.check_infos(messages['/map/map_handle'], messages['/map/statistics'])
        self.assertEqual(recorder.interrupt(), 0, recorder.output())
        self.check_record(recorded_file)

    def test_late_subscribers_get_the_newest(self):
        _, listener = self.load_map(PARAMETERS)
        self.play(self.write_bag())
        newest = listener.wait_for_integrated(SCANS)
        messages, _ = self.subscribe()
        for topic, received in messages.items():
            wait_for(lambda received=received: received, f'{topic} after the recording')
        self.assertEqual(messages['/map/statistics'], [newest])
        self.assertEqual([info.sequence for info in messages['/map/map_handle']],
                         [newest.sequence])
        for topic in ('/map/occupied', '/map/inflated', '/map/window', '/map/path', '/map/vehicle'):
            for message in messages[topic]:
                self.assertEqual(message.header.stamp, newest.header.stamp, topic)

    def check_infos(self, infos, statistics):
        self.assertEqual([info.sequence for info in infos], [s.sequence for s in statistics])
        self.assertEqual([info.header.stamp for info in infos],
                         [s.header.stamp for s in statistics])
        for info in infos:
            self.assertEqual((info.id, info.header.frame_id), ('/map', 'world'))
            self.assertEqual((info.resolution, info.inflation_radius), (0.1, 0.2))
            size = [high - low for low, high in zip(info.window_min, info.window_max)]
            self.assertEqual(size, [1000, 1000, 60])

    def check_record(self, file):
        with rosbag.Bag(str(file)) as bag:
            topics = bag.get_type_and_topic_info().topics
        self.assertEqual(set(topics), set(TOPICS))
        for topic, kind in TOPICS.items():
            self.assertEqual((topics[topic].msg_type, topics[topic].message_count > 0),
                             (kind._type, True), topic)


if __name__ == '__main__':
    rospy.init_node('other_processes_test')
    rostest.rosrun('fiimap', 'other_processes_test', OtherProcessesTest)
