"""How a depth image becomes rays, and rays become what a scan says of voxels."""
import math

import numpy
import drawing
import palette
from maps import as_set, rows_of

IMAGE = 20           # of the recording: pillars, a wall, the floor
AT_ONCE = {'p_hit': 0.9, 'p_occ': 0.8}  # one hit occupies: the map is what one scan hit
COARSE = {'resolution': 0.4, 'max_ray_length': 6.4, 'max_depth': 6.4, 'min_hit_cover': 0}
COARSE_EDGE = 0.4    # m
EDGE = 0.1           # m
STEP, MARGIN = 2, 2  # pixels, the defaults
NEAREST, FARTHEST = 0.3, 8.0  # m, the defaults
FLOOR_IMAGES = (0, 40)
FLOOR_BOX = (185, 330, -45, 75)  # voxels
PILLARS_END = 45     # voxels ahead of the camera
WALL_IMAGE = 35      # a wall with an opening all across the image
RAY_STEP = 12        # pixels between rays that are drawn


def rays_of(view, step, margin=MARGIN, rows=None):
    """End points of the readings of an image, relative to the camera, in world axes, m."""
    height, width = view.depth.shape
    fx, fy, cx, cy = view.intrinsics
    v, u = numpy.meshgrid(rows if rows is not None else range(margin, height - margin, step),
                          range(margin, width - margin, step), indexing='ij')
    z = view.depth[v, u]
    good = z > 0
    in_camera = numpy.stack([(u - cx) / fx * z, (v - cy) / fy * z, z], axis=-1)[good]
    return in_camera @ view.rotation.T


def middle_row(view):
    """The row through the optical axis."""
    return [round(view.intrinsics[3])]


def draw_rays(axes, view, edge, farthest):
    """Those of the middle row, in voxels, from above."""
    origin = view.position / edge
    rays = rays_of(view, RAY_STEP, rows=middle_row(view))
    for ray in rays:
        ray = ray * min(1.0, farthest / numpy.linalg.norm(ray)) / edge
        axes.plot([origin[0], origin[0] + ray[0]], [origin[1], origin[1] + ray[1]],
                  color=palette.BLUE, linewidth=0.5, zorder=3)
    axes.plot(origin[0], origin[1], 'o', color=palette.BLUE, markersize=5, zorder=4)


def scan(recording, path):
    view = recording.view(IMAGE)
    after = recording.map_of(IMAGE, IMAGE + 1, **AT_ONCE)
    figure, (left, right) = drawing.new_figure(
        2, (12.5, 5.6), gridspec_kw={'width_ratios': [1.05, 1]})
    shown = numpy.ma.masked_equal(view.depth, 0)
    left.set_facecolor(drawing.PALE)
    drawn = left.imshow(shown, cmap='viridis_r', vmin=0, vmax=8.5)
    left.axhline(middle_row(view)[0], color=palette.BLUE, linewidth=1)
    left.set_title('The depth image; grey: no depth')
    left.set_xlabel('u, pixels')
    left.set_ylabel('v, pixels')
    figure.colorbar(drawn, ax=left, label='depth, m', orientation='horizontal', shrink=0.6)

    x, y = (int(c) for c in view.position[:2] / EDGE)
    box = (x - 5, x + 85, y - 20, y + 70)
    height = math.floor(view.position[2] / EDGE)
    drawing.squares(right, drawing.layer(after.free, 2, height), drawing.FREE_SHADE, box)
    drawing.squares(right, drawing.layer(after.occupied, 2, height), palette.VERMILION, box)
    draw_rays(right, view, EDGE, FARTHEST)
    right.set_title("Voxels at the camera's height, from above")
    drawing.in_metres(right, EDGE)
    drawing.legend(figure, {'free': drawing.FREE_SHADE, 'hit': palette.VERMILION,
                            "rays of the marked row, some of them": palette.BLUE})
    drawing.save(figure, path)
    return scan_figures(view, after)


def cells_of(rays, edge):
    """(face, cell across, cell up) of the rays that are not steeper than 45 degrees, in the cube of
    RayCaster's definition."""
    in_voxels = rays / edge
    along = numpy.abs(in_voxels[:, :2]).max(axis=1)
    half = math.floor(along.max() + 0.25) + 1
    flat = in_voxels[numpy.abs(in_voxels[:, 2]) <= along]
    face_axis = (numpy.abs(flat[:, 1]) > numpy.abs(flat[:, 0])).astype(int)
    ahead = flat[numpy.arange(len(flat)), face_axis]
    across = flat[numpy.arange(len(flat)), 1 - face_axis]
    scale = half / numpy.abs(ahead)
    return half, numpy.stack([2 * face_axis + (ahead < 0), numpy.round(across * scale),
                              numpy.round(flat[:, 2] * scale)], axis=1)


def scan_figures(view, after):
    every = rays_of(view, STEP)
    length = numpy.linalg.norm(every, axis=1)
    returns = every[(length >= NEAREST) & (length <= FARTHEST)]
    ends = numpy.floor((returns + view.position) / EDGE)
    voxels, counts = numpy.unique(ends, axis=0, return_counts=True)
    cells = cells_of((voxels + 0.5) * EDGE - view.position, EDGE)[1]
    height, width = view.depth.shape
    pixels = len(range(MARGIN, height - MARGIN, STEP)) * len(range(MARGIN, width - MARGIN, STEP))
    return [('pixels that are looked at', pixels), ('returns', len(returns)),
            ('voxels with a return', len(voxels)), ('most returns in one voxel', counts.max()),
            ('beams of these returns', len(numpy.unique(cells, axis=0))),
            ('slices of these beams', len(numpy.unique(cells[:, :2], axis=0))),
            ('voxels that the scan hit', len(after.occupied)),
            ('voxels that it saw free', len(after.free))]


def rays(recording, path):
    view = recording.view(WALL_IMAGE)
    maps = [recording.map_of(WALL_IMAGE, WALL_IMAGE + 1, round_rays=rounded, **AT_ONCE, **COARSE)
            for rounded in ('false', 'true')]
    height = math.floor(view.position[2] / COARSE_EDGE)
    layers = [drawing.layer(m.free, 2, height) for m in maps]
    x, y = (math.floor(c) for c in view.position[:2] / COARSE_EDGE)
    box = (x - 2, x + 18, y - 11, y + 11)
    figure, panels = drawing.new_figure(2, (10.5, 5.6), sharey=True)
    for axes, mine, other, name in zip(panels, layers, layers[::-1], ('Straight', 'Rounded')):
        only = rows_of_plane(mine, other)
        drawing.squares(axes, mine, drawing.FREE_SHADE, box)
        drawing.squares(axes, only, palette.ORANGE, box)
        drawing.squares(axes, drawing.layer(maps[0].occupied, 2, height), palette.VERMILION, box)
        drawing.grid(axes, box)
        drawing.in_metres(axes, COARSE_EDGE)
        axes.set_title(f'{name}: {len(mine)} voxels of the layer are free')
    draw_rays(panels[0], view, COARSE_EDGE, COARSE['max_ray_length'])
    slices = draw_slices(panels[1], view, box)
    for axes in panels:
        axes.set_xlim(box[:2])
        axes.set_ylim(box[2:])
    drawing.legend(figure, {'free': drawing.FREE_SHADE, 'free in this picture only': palette.ORANGE,
                            'hit': palette.VERMILION,
                            'rays of one row of pixels; slices of all its rays': palette.BLUE,
                            'face of the cube, with its cells': drawing.GREY})
    drawing.save(figure, path)
    sets = [as_set(m.free) for m in maps]
    return [('coarse voxels free, straight rays', len(sets[0])),
            ('coarse voxels free, rounded rays', len(sets[1])),
            ('of either', len(sets[0] | sets[1])),
            ('of one of them only', len(sets[0] ^ sets[1])), ('slices of the row', slices)]


def rows_of_plane(cells, without):
    left = sorted(as_set(cells) - as_set(without))
    return numpy.array(left, dtype=int).reshape(-1, 2)


def draw_slices(axes, view, box):
    """Rays of the middle row after rounding, from above, and the face that they cross.

    Returns the number of slices."""
    origin = view.position[:2] / COARSE_EDGE
    of_row = rays_of(view, 1, rows=middle_row(view))
    of_row *= numpy.minimum(1, COARSE['max_ray_length']
                            / numpy.linalg.norm(of_row, axis=1))[:, None]
    half, cells = cells_of(of_row, COARSE_EDGE)
    axes.plot([origin[0] + half] * 2, box[2:], color=drawing.GREY, linewidth=1, zorder=3)
    for border in numpy.arange(-half - 0.5, half + 1):
        axes.plot(*(origin + (half, border)), marker='_', markersize=6, color=drawing.GREY,
                  zorder=3)
    reach = {}
    for ray, (face, across, _) in zip(of_row / COARSE_EDGE, cells):
        if face == 0:  # ahead, along x: the only one in the picture
            reach[across] = max(reach.get(across, 0), ray[0])
    for across, length in reach.items():
        end = origin + length * numpy.array([1, across / half])
        axes.plot(*numpy.stack([origin, end]).T, color=palette.BLUE, linewidth=0.5, zorder=3)
    axes.plot(*origin, 'o', color=palette.BLUE, markersize=5, zorder=4)
    return len(reach)


def ends(recording, path):
    """ray_end_cut on the floor, min_hit_cover at outlines."""
    floors = [recording.map_of(*FLOOR_IMAGES, ray_end_cut=cut) for cut in (0, 2.25)]
    every_hit = recording.map_of(IMAGE, IMAGE + 1, min_hit_cover=0, **AT_ONCE)
    kept = recording.map_of(IMAGE, IMAGE + 1, **AT_ONCE)
    view = recording.view(IMAGE)
    floors = [drawing.seen_along(m.occupied[m.occupied[:, 2] <= 0], 2) for m in floors]
    figure, (left, right) = drawing.new_figure(
        2, (11.5, 4.6), gridspec_kw={'width_ratios': [1.1, 1]})
    x, y = (int(c) for c in view.position[:2] / EDGE)
    drawing.squares(left, floors[1], drawing.GREY, FLOOR_BOX)
    drawing.squares(left, rows_of_plane(*floors[::-1]), palette.VERMILION, FLOOR_BOX)
    left.set_title(f'Floor after {FLOOR_IMAGES[1]} scans, from above')
    drawing.in_metres(left, EDGE)
    figures = [(f'columns with floor, ray_end_cut {cut}', len(floor))
               for cut, floor in zip(('0', '2.25'), floors)]

    box = (y - 5, y + 45, 0, 30)
    dropped = rows_of(sorted(as_set(every_hit.occupied) - as_set(kept.occupied)))
    near = [v[(v[:, 0] < x + PILLARS_END) & (v[:, 2] > 0)] for v in (kept.occupied, dropped)]
    drawing.squares(right, drawing.seen_along(near[0], 0), drawing.GREY, box)
    drawing.squares(right, drawing.seen_along(near[1], 0), palette.BLUE, box)
    drawing.grid(right, box)
    right.set_xlim(box[1], box[0])  # as the camera sees it: y grows to the left
    right.set_title('Hits of one scan on pillars, as the camera sees them')
    drawing.in_metres(right, EDGE, ('y', 'z'))
    drawing.legend(figure, {'occupied in any case': drawing.GREY,
                            'freed where rays are not cut': palette.VERMILION,
                            'slivers: rays pass, and returns cover too little': palette.BLUE})
    drawing.save(figure, path)
    return figures + [('voxels with returns', len(every_hit.occupied)),
                      ('slivers among them', len(dropped))]
