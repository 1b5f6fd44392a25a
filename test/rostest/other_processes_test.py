#!/usr/bin/python3
"""Subscribers in other processes take nothing from the readers in the nodelet manager."""
import rosbag
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import Marker

import make_bag_variants
from fiimap.msg import MapInfo, Statistics
from manager_support import ManagerTest
from rostest_support import FLIGHT_BAG, PATIENT_QUEUES, program, wait_for

TOPICS = {
    '/map/occupied': PointCloud2, '/map/inflated': PointCloud2, '/map/statistics': Statistics,
    '/map/map_handle': MapInfo, '/map/window': Marker, '/diagnostics': DiagnosticArray,
}
SCANS = 20


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
        """Starts recording every topic, and waits until the recorder is connected to all."""
        file = self.directory / 'record.bag'
        recorder = self.start(program('rosbag', 'record'), '-O', file, '__name:=recorder', *TOPICS)
        master = rospy.get_master()

        def is_subscribed():
            _, subscribers, _ = master.getSystemState()[2]
            return all('/recorder' in nodes for topic, nodes in subscribers if topic in TOPICS)
        wait_for(is_subscribed, 'the recorder')
        return recorder, file

    def test_handle_reaches_nodelets_while_others_listen_and_record(self):
        form = ('depth', 'odometry')
        bag = make_bag_variants.write_variants(FLIGHT_BAG, self.directory, SCANS, [form])[form]
        self.load_probe('probe')
        messages, subscribers = self.subscribe()
        _, listener = self.load_map({**PATIENT_QUEUES, 'resolution': 0.1})
        wait_for(lambda: all(s.get_num_connections() > 0 for s in subscribers), 'connections')
        wait_for(lambda: self.report('probe')['publishers'] == 1, 'the connection of the probe')
        recorder, recorded_file = self.record()
        self.play(bag)
        listener.wait_for_integrated(SCANS)
        for topic, received in messages.items():
            wait_for(lambda received=received: received, topic)
        wait_for(lambda: len(messages['/map/map_handle']) == SCANS, 'map infos')
        wait_for(lambda: len(messages['/map/statistics']) == SCANS, 'statistics')

        wait_for(lambda: self.report('probe')['messages'] == SCANS, 'handles')
        report = self.report('probe')
        self.assertEqual((report['messages'], report['null_handles']), (SCANS, 0))
        self.check_infos(messages['/map/map_handle'], messages['/map/statistics'])
        self.assertEqual(recorder.interrupt(), 0, recorder.output())
        self.check_record(recorded_file)

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
