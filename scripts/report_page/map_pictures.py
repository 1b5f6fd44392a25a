"""Pictures of a map: from above, from the side, in three dimensions, coloured by error."""
import numpy
from matplotlib import colors, pyplot
from mpl_toolkits.mplot3d import Axes3D  # noqa: F401  old matplotlib learns '3d' from it

from figures import data_uri

SIZE = (6.4, 5.0)      # inches
MAX_POINTS_3D = 40000  # of a layer; more are thinned
ERROR_STEPS = [0, 0.5, 3 ** 0.5 / 2, 1.5, 2, 3]  # voxels; the third: half a diagonal
EDGE_3D = 300          # points: about what the longest edge of the 3-D view takes on paper
BELOW_CEILING = 90     # percentile of the heights that the view from above shows


def read_pcd(path):
    """x y z of a binary PCD file as fiimap writes it: float32 in this order, then nothing."""
    with open(path, 'rb') as stream:
        header = {}
        while 'DATA' not in header:
            words = stream.readline().decode('ascii').split()
            if not words:
                raise ValueError(f'{path} has no PCD header')
            header[words[0]] = words[1:]
        if header['FIELDS'][:3] != ['x', 'y', 'z'] or header['DATA'] != ['binary']:
            raise ValueError(f'{path} holds other fields than x y z')
        size = sum(int(s) * int(c) for s, c in zip(header['SIZE'], header['COUNT']))
        count = int(header['POINTS'][0])
        raw = numpy.frombuffer(stream.read(size * count), numpy.uint8).reshape(count, size)
    return raw[:, :12].copy().view(numpy.float32).astype(float)


def marker_size(points, axes_extent):
    """Square points about as large as a voxel, points squared."""
    return max(0.3, min(20.0, 4e4 / max(1.0, axes_extent) ** 2 * points ** 2))


def plane_view(title, layers, axis_a, axis_b, labels, resolution):
    """layers: [(points, values or colour, colour map)], painted in this order."""
    figure, axes = pyplot.subplots(figsize=SIZE, constrained_layout=True)
    axes.set_title(title)
    axes.set_xlabel(labels[0])
    axes.set_ylabel(labels[1])
    axes.set_aspect('equal')
    extent = max(numpy.ptp(layers[0][0][:, i]) for i in (axis_a, axis_b))
    size = marker_size(resolution, extent) * 15
    for points, values, style in layers:
        drawn = axes.scatter(points[:, axis_a], points[:, axis_b], c=values, s=size, marker='s',
                             linewidths=0, **style)
    if drawn.get_array() is not None:
        figure.colorbar(drawn, ax=axes, label=labels[2], shrink=0.6)
    return title, data_uri(figure)


def thinned(points):
    """Every n-th point, always the same ones."""
    step = max(1, len(points) // MAX_POINTS_3D)
    return points[::step]


def view_3d(occupied, inflated, resolution):
    title = 'Occupied (colour by height) and inflated (grey)'
    figure = pyplot.figure(figsize=(SIZE[0] * 1.3, SIZE[1] * 1.3), constrained_layout=True)
    axes = figure.add_subplot(111, projection='3d')
    axes.set_title(title)
    grey, solid = thinned(inflated), thinned(occupied)
    edge = EDGE_3D * resolution / max(1.0, numpy.ptp(occupied, axis=0).max())
    style = {'s': max(1.0, edge) ** 2, 'marker': 's', 'linewidths': 0}
    axes.scatter(*grey.T, c='0.5', alpha=0.08, **style)
    axes.scatter(*solid.T, c=solid[:, 2], cmap='viridis', alpha=0.8, **style)
    if hasattr(axes, 'set_box_aspect'):  # since matplotlib 3.3
        axes.set_box_aspect(numpy.maximum(numpy.ptp(occupied, axis=0), 1.0))
    axes.view_init(elev=40, azim=-60)
    for name, set_label in zip('xyz', (axes.set_xlabel, axes.set_ylabel, axes.set_zlabel)):
        set_label(f'{name}, m')
    return title, data_uri(figure)


def pictures(folder, resolution):
    """Of the map that `run` saved."""
    occupied = read_pcd(folder / 'map_occupied.pcd')
    inflated = read_pcd(folder / 'map_inflated.pcd')
    if len(occupied) == 0:
        return []
    grey = {'alpha': 1.0}
    height = {'cmap': 'viridis'}
    low = occupied[occupied[:, 2] <= numpy.percentile(occupied[:, 2], BELOW_CEILING)]
    low = low[numpy.argsort(low[:, 2], kind='stable')]
    # The nearer half would hide what is in a room.
    middle = numpy.median(occupied[:, 1])
    side, grey_side = (points[points[:, 1] >= middle] for points in (occupied, inflated))
    side = side[numpy.argsort(-side[:, 1], kind='stable')]
    return [
        plane_view('From above, without the highest tenth',
                   [(inflated, '0.75', grey), (low, low[:, 2], height)], 0, 1,
                   ('x, m', 'y, m', 'height, m'), resolution),
        plane_view('From the side, without the nearer half',
                   [(grey_side, '0.75', grey), (side, side[:, 1], height)], 0, 2,
                   ('x, m', 'z, m', 'y, m'), resolution),
        view_3d(occupied, inflated, resolution),
    ]


def error_picture(csv_file, resolution):
    """Occupied voxels by their distance from the exact surface; csv: x, y, z, distance."""
    voxels = numpy.loadtxt(csv_file, delimiter=',', skiprows=1, ndmin=2)
    if len(voxels) == 0:
        return []
    error = numpy.minimum(numpy.abs(voxels[:, 3]) / resolution, ERROR_STEPS[-1])
    order = numpy.argsort(error, kind='stable')
    scale = colors.BoundaryNorm(ERROR_STEPS, 256)
    style = {'cmap': 'plasma', 'norm': scale}
    layer = [(voxels[order], error[order], style)]
    label = 'distance from the surface, voxels'
    return [plane_view('Occupied voxels from above, by error', layer, 0, 1,
                       ('x, m', 'y, m', label), resolution),
            plane_view('The same from the side', layer, 0, 2, ('x, m', 'z, m', label), resolution)]
