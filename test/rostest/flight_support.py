"""A vehicle that follows commands exactly, in a scene of boxes that it sees as point clouds."""
import math
import threading

import numpy
import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2, PointField
from trajectory_msgs.msg import MultiDOFJointTrajectory

from fiimap.msg import PlannerStatus

FRAME = 'world'
BODY = 'base_link'
ODOMETRY_RATE = 100.0  # Hz
SCANS_PER_SECOND = 10
SENSOR_RANGE = 6.0  # m
POINT_SPACING = 0.08  # m


class Box:
    """An axis-parallel obstacle, metres."""

    def __init__(self, low, high):
        self.low = numpy.array(low, dtype=float)
        self.high = numpy.array(high, dtype=float)

    def distance(self, point):
        """From its surface; 0 inside."""
        outside = numpy.maximum(self.low - point, point - self.high)
        return float(numpy.linalg.norm(numpy.maximum(outside, 0.0)))

    def surface(self):
        """Points all over it."""
        axes = [numpy.arange(low + POINT_SPACING / 2, high, POINT_SPACING)
                for low, high in zip(self.low, self.high)]
        faces = []
        for axis in range(3):
            for value in (self.low[axis] + 0.01, self.high[axis] - 0.01):
                coordinates = [numpy.array([value]) if i == axis else axes[i] for i in range(3)]
                grid = numpy.meshgrid(*coordinates, indexing='ij')
                faces.append(numpy.stack([g.ravel() for g in grid], axis=1))
        return numpy.concatenate(faces)


class Vehicle:
    """Odometry of the last command, and scans of what is near; in real time, in threads."""

    def __init__(self, boxes, position):
        self.boxes = boxes
        self.position = numpy.array(position, dtype=float)
        self.velocity = numpy.zeros(3)
        self.rotation = (0.0, 0.0, 0.0, 1.0)
        self.commands = 0
        self.last_command = None  # stamp
        self.way = [self.position]
        self.sends_odometry = True
        self.statuses = []
        self._points = numpy.concatenate([box.surface() for box in boxes])
        self._odometry = rospy.Publisher('/odom', Odometry, queue_size=10)
        self._scans = rospy.Publisher('/points', PointCloud2, queue_size=10)
        self._goals = rospy.Publisher('/goal', PoseStamped, queue_size=10)
        self._subscribers = [
            rospy.Subscriber('/command', MultiDOFJointTrajectory, self._on_command,
                             tcp_nodelay=True),
            rospy.Subscriber('/planner/status', PlannerStatus, self._on_status)]
        self._lock = threading.Lock()
        self._ticks = 0
        self._timer = rospy.Timer(rospy.Duration(1.0 / ODOMETRY_RATE), self._on_timer)

    def close(self):
        self._timer.shutdown()
        self._timer.join()
        for user in [*self._subscribers, self._odometry, self._scans, self._goals]:
            user.unregister()

    def fly_to(self, x, y, z):
        goal = PoseStamped()
        goal.header.frame_id = FRAME
        goal.pose.position.x, goal.pose.position.y, goal.pose.position.z = x, y, z
        goal.pose.orientation.w = 1.0
        self._goals.publish(goal)

    def has_planner(self):
        return self._goals.get_num_connections() > 0 and self.statuses

    def status(self):
        return self.statuses[-1]

    def speed(self):
        return float(numpy.linalg.norm(self.velocity))

    def distance_to(self, *point):
        return float(numpy.linalg.norm(self.position - numpy.array(point)))

    def least_clearance(self):
        """Of its whole way, from the true surfaces."""
        return min(box.distance(point) for point in self.way for box in self.boxes)

    def _on_status(self, status):
        self.statuses.append(status)

    def _on_command(self, command):
        assert len(command.points) == 1 and command.header.frame_id == FRAME
        point = command.points[0]
        p, q, v = (point.transforms[0].translation, point.transforms[0].rotation,
                   point.velocities[0].linear)
        with self._lock:
            self.position = numpy.array([p.x, p.y, p.z])
            self.velocity = numpy.array([v.x, v.y, v.z])
            self.rotation = (q.x, q.y, q.z, q.w)
            self.way.append(self.position)
            self.commands += 1
            self.last_command = command.header.stamp

    def _on_timer(self, _event):
        stamp = rospy.Time.now()
        if self.sends_odometry:
            self._odometry.publish(self._odometry_message(stamp))
        self._ticks += 1
        if self._ticks % (ODOMETRY_RATE // SCANS_PER_SECOND) == 0:
            self._scans.publish(self._scan(stamp))

    def _odometry_message(self, stamp):
        message = Odometry(child_frame_id=BODY)
        message.header.stamp = stamp
        message.header.frame_id = FRAME
        with self._lock:
            position, velocity = self.position, self.velocity
            x, y, z, w = self.rotation
        pose, twist = message.pose.pose, message.twist.twist
        pose.position.x, pose.position.y, pose.position.z = position
        pose.orientation.x, pose.orientation.y = x, y
        pose.orientation.z, pose.orientation.w = z, w
        ahead, left, up = self._to_body(velocity)
        twist.linear.x, twist.linear.y, twist.linear.z = ahead, left, up
        return message

    def _to_body(self, vector):
        """Of a vehicle that only yaws."""
        yaw = 2.0 * math.atan2(self.rotation[2], self.rotation[3])
        c, s = math.cos(yaw), math.sin(yaw)
        return c * vector[0] + s * vector[1], -s * vector[0] + c * vector[1], vector[2]

    def _scan(self, stamp):
        """What is near, all around, in the body's frame."""
        offsets = self._points - self.position
        near = offsets[numpy.linalg.norm(offsets, axis=1) < SENSOR_RANGE]
        x, y, z = self._to_body(near.T)
        xyz = numpy.stack([x, y, z], axis=1).astype(numpy.float32)
        cloud = PointCloud2(height=1, width=len(xyz), is_dense=True, point_step=12,
                            row_step=12 * len(xyz), data=xyz.tobytes())
        cloud.header.stamp = stamp
        cloud.header.frame_id = BODY
        cloud.fields = [PointField(name, 4 * i, PointField.FLOAT32, 1)
                        for i, name in enumerate('xyz')]
        return cloud
