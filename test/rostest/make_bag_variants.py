#!/usr/bin/python3
"""Writes the beginning of a recorded flight in every form that the mapping node reads.

  make_bag_variants.py FLIGHT_BAG OUTPUT_DIRECTORY [--scans N]

FLIGHT_BAG holds depth images with camera_info, nav_msgs/Odometry, /tf and /tf_static. The bags are
named SENSOR_POSESOURCE.bag and use the mapping node's own topic names.
"""
import argparse
import array
import contextlib
import copy
import itertools
import pathlib

import rosbag
from geometry_msgs.msg import PoseStamped, TransformStamped
from sensor_msgs.msg import PointCloud2, PointField

FORMS = tuple(itertools.product(('depth', 'points'), ('odometry', 'pose', 'transform', 'tf')))
TOPICS = {
    'depth': {'/depth/image', '/depth/camera_info'}, 'points': {'/points'},
    'odometry': {'/odom'}, 'pose': {'/pose'}, 'transform': {'/transform'}, 'tf': {'/tf'},
}
# Every n-th pixel of every n-th row becomes a point.
PIXEL_STEP = 4
METRES_PER_UNIT = 0.001
FLOAT_BYTES = 4


def pose_of(odometry):
    return PoseStamped(header=odometry.header, pose=odometry.pose.pose)


def transform_of(odometry):
    transform = TransformStamped(header=odometry.header, child_frame_id=odometry.child_frame_id)
    transform.transform.rotation = odometry.pose.pose.orientation
    for axis in 'xyz':
        setattr(transform.transform.translation, axis, getattr(odometry.pose.pose.position, axis))
    return transform


def points_of(image, info):
    """The points of a depth image one after the other; NaN where there is no depth."""
    fx, _, cx, _, fy, cy = info.K[:6]
    depth = array.array('H', image.data)
    for v in range(0, image.height, PIXEL_STEP):
        for u in range(0, image.width, PIXEL_STEP):
            z = depth[v * image.width + u] * METRES_PER_UNIT or float('nan')
            yield from ((u - cx) / fx * z, (v - cy) / fy * z, z)


def cloud_of(image, info):
    """Back-projects a 16-bit depth image into an unorganised cloud in the camera's frame."""
    data = array.array('f', points_of(image, info))
    cloud = PointCloud2(header=image.header, height=1, width=len(data) // 3, is_dense=False)
    cloud.fields = [PointField(name, i * FLOAT_BYTES, PointField.FLOAT32, 1)
                    for i, name in enumerate('xyz')]
    cloud.point_step = 3 * FLOAT_BYTES
    cloud.row_step = cloud.point_step * cloud.width
    cloud.data = data.tobytes()
    return cloud


def converted(topic, message, info):
    """Topic and message in every form."""
    kind = message._type
    if kind == 'sensor_msgs/CameraInfo':
        yield '/depth/camera_info', message
    elif kind == 'sensor_msgs/Image':
        yield '/depth/image', message
        yield '/points', cloud_of(message, info)
    elif kind == 'nav_msgs/Odometry':
        yield '/odom', message
        yield '/pose', pose_of(message)
        yield '/transform', transform_of(message)
    else:
        yield topic, message


def write_variants(source, directory, scans, forms=FORMS):
    """Writes the first `scans` images of a bag and the poses until the next image.

    Returns the files by form."""
    files = {form: pathlib.Path(directory) / '{}_{}.bag'.format(*form) for form in forms}
    with rosbag.Bag(str(source)) as bag, contextlib.ExitStack() as stack:
        outputs = {form: stack.enter_context(rosbag.Bag(str(file), 'w'))
                   for form, file in files.items()}
        info = None
        for topic, message, time, connection in bag.read_messages(return_connection_header=True):
            if message._type == 'sensor_msgs/CameraInfo':
                info = message
            if message._type == 'sensor_msgs/Image':
                if scans == 0:
                    break
                scans -= 1
            # Transforms keep their header: it says that /tf_static is latched.
            header = connection if topic.startswith('/tf') else None
            for new_topic, new_message in converted(topic, message, info):
                for (sensor, pose_source), output in outputs.items():
                    if new_topic in {'/tf_static'} | TOPICS[sensor] | TOPICS[pose_source]:
                        output.write(new_topic, new_message, time, connection_header=header)
    return files


def write_two_sensors(source, target, scans):
    """Writes the beginning of the flight as of a camera, 'front', and a LiDAR, in one frame further
    up, to which every second image goes as a cloud."""
    info, images = None, 0
    with rosbag.Bag(str(source)) as bag, rosbag.Bag(str(target), 'w') as output:
        for topic, message, time, connection in bag.read_messages(return_connection_header=True):
            kind = message._type
            if kind == 'sensor_msgs/CameraInfo':
                info = message
                output.write('/front/depth/camera_info', message, time)
            elif kind == 'sensor_msgs/Image':
                if images == scans:
                    break
                images += 1
                if images % 2 == 1:
                    output.write('/front/depth/image_raw', message, time)
                    continue
                cloud = cloud_of(message, info)
                cloud.header.frame_id = 'lidar'
                output.write('/lidar/points', cloud, time)
            else:
                header = connection if topic.startswith('/tf') else None
                if topic == '/tf_static':
                    add_lidar(message)
                output.write(topic, message, time, connection_header=header)


def add_lidar(transforms):
    """Half a metre above the camera, and turned like it."""
    camera = transforms.transforms[-1]
    lidar = copy.deepcopy(camera)
    lidar.child_frame_id = 'lidar'
    lidar.transform.translation.z += 0.5
    transforms.transforms.append(lidar)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('source', type=pathlib.Path)
    parser.add_argument('output', type=pathlib.Path)
    parser.add_argument('--scans', type=int, default=30)
    args = parser.parse_args()
    args.output.mkdir(parents=True, exist_ok=True)
    for file in write_variants(args.source, args.output, args.scans).values():
        print(file)


if __name__ == '__main__':
    main()
