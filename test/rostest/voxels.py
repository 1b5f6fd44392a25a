"""Voxels as sets of indices, from clouds and files that hold their centres."""
import math
import pathlib
import struct

from sensor_msgs import point_cloud2


def voxels_at(centres, resolution):
    """Indices of the voxels around centres, which must be one per voxel."""
    centres = list(centres)
    voxels = {tuple(math.floor(c / resolution) for c in centre) for centre in centres}
    assert len(voxels) == len(centres), f'{len(centres)} centres of {len(voxels)} voxels'
    return voxels


def voxels_of_cloud(cloud, resolution):
    return voxels_at(point_cloud2.read_points(cloud, ('x', 'y', 'z')), resolution)


def voxels_of_pcd(file, resolution):
    """Of a binary PCD file with the fields x, y and z of type float."""
    header, data = pathlib.Path(file).read_bytes().split(b'DATA binary\n', 1)
    entries = dict(line.split(' ', 1) for line in header.decode().splitlines() if line[0] != '#')
    assert (entries['FIELDS'], entries['SIZE'], entries['TYPE']) == ('x y z', '4 4 4', 'F F F')
    assert len(data) == int(entries['POINTS']) * 12
    return voxels_at(struct.iter_unpack('<fff', data), resolution)
