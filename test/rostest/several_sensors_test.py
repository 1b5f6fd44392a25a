#!/usr/bin/python3
"""A depth camera and a LiDAR make one map: that of the offline tool. None holds up the other."""
import rosbag
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo, Image, PointCloud2
from tf2_msgs.msg import TFMessage

from make_bag_variants import cloud_of
from rostest_support import FLIGHT_BAG, PATIENT_QUEUES, MapTest, program, wait_for
from vehicle import Vehicle

SCANS = 24
RESOLUTION = 0.1
SENSORS = {'sensors': ['front', 'lidar'], 'lidar': {'sensor': 'points', 'max_ray_length': 6.0}}
TOPICS = {
    '/front/depth/image': Image, '/front/depth/camera_info': CameraInfo, '/lidar/points': PointCloud2,
    '/odom': Odometry, '/tf_static': TFMessage}
SCAN_TOPICS = ('/front/depth/image', '/lidar/points')


def messages_of_two_sensors():
    """The recorded flight; of its images every second one is what the LiDAR saw."""
    info, images = None, 0
    with rosbag.Bag(str(FLIGHT_BAG)) as bag:
        for topic, message, time in bag.read_messages():
            if message._type == 'sensor_msgs/CameraInfo':
                info = message
                yield '/front/depth/camera_info', message, time
            elif message._type == 'sensor_msgs/Image':
                if images == SCANS:
                    return
                images += 1
                if images % 2 == 1:
                    yield '/front/depth/image', message, time
                else:
                    yield '/lidar/points', cloud_of(message, info), time
            elif message._type == 'nav_msgs/Odometry':
                yield '/odom', message, time
            elif topic == '/tf_static':
                yield topic, message, time


class SeveralSensorsTest(MapTest):
    def per_sensor(self, listener, sensor, key):
        return listener.input_count(f'{sensor}: {key}')

    def assert_conserved_in_diagnostics(self, status):
        super().assert_conserved_in_diagnostics(status)
        values = {value.key: value.value for value in status.values}
        for name in ('received', 'integrated', 'dropped', 'waiting'):
            self.assertEqual(int(values[f'scans {name}']), sum(
                int(values[f'{sensor}: scans {name}']) for sensor in ('front', 'lidar')), status)

    def publish_in_step(self, messages, listener):
        """Publishes messages; each scan only when those before it are in the map.

        Topics have connections of their own: what is sent at once arrives in any order."""
        publishers = {topic: rospy.Publisher(topic, kind, queue_size=1000,
                                             latch=topic == '/tf_static')
                      for topic, kind in TOPICS.items()}
        wait_for(lambda: all(publisher.get_num_connections() for publisher in publishers.values()),
                 'the connections of the sensors')
        scans = 0
        for topic, message, _ in messages:
            if topic in SCAN_TOPICS:
                listener.wait_for_integrated(scans)
                scans += 1
            publishers[topic].publish(message)
        listener.wait_for_integrated(scans)
        for publisher in publishers.values():
            publisher.unregister()

    def test_the_map_is_that_of_the_offline_tool(self):
        messages = list(messages_of_two_sensors())
        bag = self.directory / 'two_sensors.bag'
        with rosbag.Bag(str(bag), 'w') as output:
            for topic, message, time in messages:
                output.write(topic, message, time)
        parameters = {**PATIENT_QUEUES, **SENSORS, 'resolution': RESOLUTION,
                      'front': {'pixel_step': 3, 'max_depth': 5.0}}
        offline = self.evaluate(bag, parameters)
        self.assertEqual(offline['sensors']['front']['integrated'], SCANS // 2, offline)
        self.assertEqual(offline['sensors']['lidar']['integrated'], SCANS // 2, offline)
        again = self.evaluate(bag, parameters)
        for key in ('occupied', 'inflated', 'change_score'):
            self.assertEqual(offline[key], again[key])
        alone = self.evaluate(bag, {**parameters, 'sensors': 'front', 'lidar': {}})
        self.assertNotEqual(alone['occupied'], offline['occupied'])
        self.evaluate(bag, parameters)

        _, listener = self.start_map(parameters)
        self.publish_in_step(messages, listener)
        newest = listener.newest()
        self.assertEqual((newest.received, newest.occupied, newest.inflated),
                         (SCANS, offline['occupied'], offline['inflated']))
        self.assert_clouds_equal_offline(listener, RESOLUTION)
        self.assertEqual([statistics.sensor for statistics in listener.statistics],
                         ['front', 'lidar'] * (SCANS // 2))
        wait_for(lambda: self.per_sensor(listener, 'lidar', 'scans integrated') == SCANS // 2,
                 'the count of the LiDAR')

    def test_a_dead_sensor_holds_up_no_other_and_is_named(self):
        process, listener = self.start_map(
            SENSORS, 'front/depth/image:=/depth/image',
            'front/depth/camera_info:=/depth/camera_info')
        vehicle = Vehicle()
        self.addCleanup(vehicle.close)
        lidar = rospy.Publisher('/lidar/points', PointCloud2, queue_size=10)
        wait_for(lambda: vehicle.is_connected() and lidar.get_num_connections(),
                 'the connections of the vehicle')

        def fly_until_diagnostics(level, text, with_lidar):
            goal = listener.newest().integrated + 3

            def is_told():
                self.assertTrue(process.is_running(), process.output())
                sent = []

                def noted(message):
                    sent.append(message)
                    return message
                vehicle.fly(image=noted, info=noted)
                if with_lidar:
                    info, image = sent
                    lidar.publish(cloud_of(image, info))
                rospy.sleep(0.05)
                status = listener.diagnostics['inputs']
                return (listener.newest().integrated >= goal and status.level == level
                        and status.message == text)
            wait_for(is_told, lambda: f'{text} in diagnostics: {listener.state()}')

        fly_until_diagnostics(
            DiagnosticStatus.ERROR, 'lidar: no scans received on /lidar/points: '
            'check that it is published and remapped', with_lidar=False)
        fly_until_diagnostics(
            DiagnosticStatus.OK, 'scans and poses come in', with_lidar=True)
        fly_until_diagnostics(
            DiagnosticStatus.ERROR, 'lidar: scans stopped on /lidar/points', with_lidar=False)
        self.assertEqual(listener.diagnostics['map'].level, DiagnosticStatus.OK,
                         listener.diagnostics['map'])
        self.assertGreater(self.per_sensor(listener, 'lidar', 'scans integrated'), 0)
        self.assertEqual(process.interrupt(), 0, process.output())

    def test_wrong_parameters_are_named_with_their_sensor(self):
        for parameters, words in (
                ({**SENSORS, 'front': {'max_depth': 2000.0}},
                 ['parameter front/max_depth', '2000', '[0, 1000] m']),
                ({'sensors': ['front', 'front']}, ["'front' stands there twice"]),
                ({'sensors': ['front', '']}, ['sensors', "'' in a list"]),
                ({'sensors': ['front', 'left/up']}, ["'left/up' is no name"])):
            self.set_parameters(parameters)
            process = self.start(program('fiimap', 'mapping_node'), '__name:=map')
            self.assertNotEqual(process.wait(), 0, process.output())
            for word in words:
                self.assertIn(word, process.output())

    def test_unknown_parameters_of_a_sensor_are_warned_of(self):
        process, _ = self.start_map({**SENSORS, 'front': {'max_dpeth': 2.0, 'resolution': 1.0},
                                     'rear': {'max_depth': 2.0}})
        for name in ('front/max_dpeth', 'front/resolution', 'rear'):
            wait_for(lambda: f'parameter {name} is unknown' in process.output(), name)
        self.assertIn('a sensor may have of its own: sensor, extrinsics', process.output())
        self.assertEqual(process.interrupt(), 0, process.output())


if __name__ == '__main__':
    rospy.init_node('several_sensors_test')
    rostest.rosrun('fiimap', 'several_sensors_test', SeveralSensorsTest)
