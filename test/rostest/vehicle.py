"""A vehicle with a depth camera in front of a wall, whose messages can be spoiled one by one."""
import array
import copy

import rospy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, Image
from tf2_msgs.msg import TFMessage

WIDTH, HEIGHT = 64, 48  # pixels
FOCAL_LENGTH = 50.0  # pixels
WALL_DISTANCE = 2000  # mm
CAMERA_FRAME = 'camera'
BODY_FRAME = 'base_link'
IMAGE_PERIOD = 0.1  # s
POSES_PER_IMAGE = 10
SPEED = 0.1  # m/s


def keep(message):
    """Spoils nothing."""
    return message


class Vehicle:
    def __init__(self):
        self.time = 1000.0  # s
        self.images = 0
        self._clock = rospy.Publisher('/clock', Clock, queue_size=10)
        self._image = rospy.Publisher('/depth/image', Image, queue_size=100)
        self._info = rospy.Publisher('/depth/camera_info', CameraInfo, queue_size=100)
        self._odometry = rospy.Publisher('/odom', Odometry, queue_size=1000)
        self._static_tf = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        self._static_tf.publish(TFMessage([self._camera_on_body()]))

    def is_connected(self):
        return all(publisher.get_num_connections() > 0 for publisher in (
            self._image, self._info, self._odometry, self._static_tf))

    def close(self):
        for publisher in (self._clock, self._image, self._info, self._odometry, self._static_tf):
            publisher.unregister()

    def fly(self, image=keep, info=keep, odometry=keep, clock=keep):
        """Sends an image, its camera_info and the poses around it.

        Each argument changes a message before it is sent, or returns None to hold it back."""
        for i in range(1, POSES_PER_IMAGE + 1):
            self._send(self._odometry, self._pose(self.time + i * IMAGE_PERIOD / POSES_PER_IMAGE),
                       odometry)
        self.time += IMAGE_PERIOD
        self._send(self._clock, Clock(rospy.Time(self.time)), clock)
        # The stamp lies between two poses.
        stamp = rospy.Time(self.time - 0.45 * IMAGE_PERIOD / POSES_PER_IMAGE)
        self._send(self._info, self._camera_info(stamp), info)
        self.images += self._send(self._image, self._depth_image(stamp), image)

    @staticmethod
    def _send(publisher, message, change):
        changed = change(copy.deepcopy(message))
        if changed is not None:
            publisher.publish(changed)
        return changed is not None

    @staticmethod
    def _camera_on_body():
        transform = TransformStamped(child_frame_id=CAMERA_FRAME)
        transform.header.frame_id = BODY_FRAME
        rotation = transform.transform.rotation
        rotation.x, rotation.y, rotation.z, rotation.w = -0.5, 0.5, -0.5, 0.5
        return transform

    @staticmethod
    def _pose(time):
        odometry = Odometry(child_frame_id=BODY_FRAME)
        odometry.header.stamp = rospy.Time(time)
        odometry.header.frame_id = 'world'
        odometry.pose.pose.position.y = SPEED * (time % 100.0)
        odometry.pose.pose.orientation.w = 1.0
        return odometry

    @staticmethod
    def _camera_info(stamp):
        info = CameraInfo(width=WIDTH, height=HEIGHT)
        info.header.stamp = stamp
        info.header.frame_id = CAMERA_FRAME
        info.K = [FOCAL_LENGTH, 0, WIDTH / 2, 0, FOCAL_LENGTH, HEIGHT / 2, 0, 0, 1]
        info.P = [FOCAL_LENGTH, 0, WIDTH / 2, 0, 0, FOCAL_LENGTH, HEIGHT / 2, 0, 0, 0, 1, 0]
        return info

    @staticmethod
    def _depth_image(stamp):
        image = Image(width=WIDTH, height=HEIGHT, encoding='16UC1', step=2 * WIDTH)
        image.header.stamp = stamp
        image.header.frame_id = CAMERA_FRAME
        image.data = array.array('H', [WALL_DISTANCE] * (WIDTH * HEIGHT)).tobytes()
        return image
