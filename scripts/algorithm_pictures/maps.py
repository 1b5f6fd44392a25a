"""Maps that fiimap_eval makes of parts of a recording, as sets of voxels."""
import hashlib
import json
import pathlib
import subprocess
import sys
import typing

import numpy
import rosbag

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'report_page'))
from map_pictures import read_pcd  # noqa: E402  found by the path above

IMAGE, INFO = '/camera/depth/image_rect_raw', '/camera/depth/camera_info'
ODOMETRY, TF_STATIC = '/odom', '/tf_static'
TREE_DEPTH = 16  # of an OctoMap
FREE, OCCUPIED, INNER = 1, 2, 3  # states of a node's child


class Map(typing.NamedTuple):
    """Voxel indices, one a row, sorted."""
    occupied: numpy.ndarray
    inflated: numpy.ndarray
    free: numpy.ndarray
    figures: dict  # what fiimap_eval run --json wrote


class View(typing.NamedTuple):
    """A depth image, and where it was taken."""
    depth: numpy.ndarray    # m, 0: none
    intrinsics: tuple       # fx, fy, cx, cy
    position: numpy.ndarray  # of the camera, m
    rotation: numpy.ndarray  # camera to world


def rows_of(voxels):
    """An array of voxels without repetitions, sorted by x, y, z."""
    rows = numpy.asarray(voxels, dtype=numpy.int64).reshape(-1, 3)
    return numpy.unique(rows, axis=0) if len(rows) else rows  # older versions take no empty one


def as_set(voxels):
    return set(map(tuple, voxels.tolist()))


def voxels_of(points, resolution):
    return rows_of(numpy.floor(points / resolution))


def free_boxes(data):
    """(lowest voxel, edge) of the free leaves of an OctoMap .bt file: of each inner node two bytes,
    two bits for each of its children, then those that are inner nodes, depth first."""
    stream = data[data.index(b'\ndata\n') + len(b'\ndata\n'):]
    place = 0
    boxes = []

    def read(x, y, z, edge):
        nonlocal place
        bits = stream[place] | stream[place + 1] << 8
        place += 2
        half = edge // 2
        inner = []
        for child in range(8):
            corner = (x + half * (child & 1), y + half * (child >> 1 & 1), z + half * (child >> 2))
            state = bits >> 2 * child & 3
            if state == FREE:
                boxes.append((corner, half))
            elif state == INNER:
                inner.append(corner)
        for corner in inner:
            read(*corner, half)

    lowest = -(1 << (TREE_DEPTH - 1))
    read(lowest, lowest, lowest, 1 << TREE_DEPTH)
    return boxes


def read_free(path):
    parts = [numpy.empty((0, 3))]
    for corner, edge in free_boxes(path.read_bytes()):
        inside = numpy.stack(numpy.meshgrid(*[numpy.arange(edge)] * 3, indexing='ij'), axis=-1)
        parts.append(inside.reshape(-1, 3) + corner)
    return rows_of(numpy.concatenate(parts))


def rotation_of(q):
    """Matrix of a quaternion message."""
    x, y, z, w = q.x, q.y, q.z, q.w
    return numpy.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


class Recording:
    """The sample recording, and maps of its parts, which are kept in a folder."""

    def __init__(self, program, bag, folder):
        self.program = program
        self.folder = folder
        self.last_cut = None  # first and end
        self.maps = {}        # that were read, by their key
        with rosbag.Bag(str(bag)) as opened:
            self.messages = list(opened.read_messages())

    def default(self, name):
        """Of a parameter, as text."""
        lines = subprocess.run([str(self.program), 'parameters'], check=True, text=True,
                               stdout=subprocess.PIPE).stdout.splitlines()
        return next(line.split('\t')[1] for line in lines if line.split('\t')[0] == name)

    def on(self, topic):
        return [message for of, message, _ in self.messages if of == topic]

    def cut(self, first, end):
        """A bag with the images first to end - 1 and everything else."""
        path = self.folder / 'cut.bag'
        if self.last_cut == (first, end):
            return path
        self.last_cut = (first, end)
        number = -1
        with rosbag.Bag(str(path), 'w') as part:
            for topic, message, time in self.messages:
                number += topic == IMAGE
                if topic != IMAGE or first <= number < end:
                    part.write(topic, message, time)
        return path

    def map_of(self, first, end, **parameters):
        """The map after these images. Its inflated layer is compared with brute force."""
        key = json.dumps([first, end, parameters], sort_keys=True)
        if key not in self.maps:
            self.maps[key] = self._make_map(key, first, end, parameters)
        return self.maps[key]

    def _make_map(self, key, first, end, parameters):
        prefix = self.folder / hashlib.sha256(key.encode()).hexdigest()[:12]
        figures_file = pathlib.Path(f'{prefix}.json')
        if not figures_file.exists():
            command = [str(self.program), 'run', str(self.cut(first, end)), '--save', str(prefix),
                       '--json', str(figures_file), '--verify', str(end - first)]
            for name, value in parameters.items():
                command += ['--set', f'{name}={value}']
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                  text=True)
            if done.returncode != 0:
                sys.exit(f'{" ".join(command)} failed:\n{done.stdout}')
        figures = json.loads(figures_file.read_text())
        if figures['integrated'] != end - first:
            sys.exit(f'only {figures["integrated"]} of {end - first} scans are in the map')
        resolution = float(figures['parameters']['resolution'])
        layers = [voxels_of(read_pcd(f'{prefix}_{layer}.pcd'), resolution)
                  for layer in ('occupied', 'inflated')]
        return Map(*layers, read_free(pathlib.Path(f'{prefix}.bt')), figures)

    def body_at(self, number):
        """Pose of the vehicle at image `number`: that of the nearest odometry."""
        stamp = self.on(IMAGE)[number].header.stamp
        return min(self.on(ODOMETRY),
                   key=lambda message: abs((message.header.stamp - stamp).to_sec())).pose.pose

    def view(self, number):
        """Image `number` and the camera's place at its stamp."""
        image = self.on(IMAGE)[number]
        info = self.on(INFO)[0]
        mount = next(t for message in self.on(TF_STATIC) for t in message.transforms
                     if t.child_frame_id == image.header.frame_id).transform
        body = self.body_at(number)
        R_W_B = rotation_of(body.orientation)
        position = numpy.array([body.position.x, body.position.y, body.position.z]) + R_W_B @ [
            mount.translation.x, mount.translation.y, mount.translation.z]
        depth = numpy.frombuffer(image.data, '<u2').reshape(image.height, image.width) / 1000.0
        return View(depth, (info.K[0], info.K[4], info.K[2], info.K[5]), position,
                    R_W_B @ rotation_of(mount.rotation))
