"""What one scan changes: the window's tiles, dirty columns, tiles that snapshots keep."""
import math

import numpy
from matplotlib import patches

import drawing
import palette
from maps import as_set, rows_of

SCAN = 40      # the change is that from the map of the scans before it to the map with it
TILE = 32      # voxels a side
EDGE = 0.1     # m
RADIUS = 2     # voxels: the default inflation_radius
WINDOW = 96    # voxels: a small one, so that its ring is small
SLIDE = 4      # voxels: the default slide_distance
WINDOW_AT = (20, 60)  # scans after which the window is drawn
WINDOW_SIZE = {'map_size_x': WINDOW * EDGE, 'map_size_y': WINDOW * EDGE}


def before_and_after(recording):
    return recording.map_of(0, SCAN), recording.map_of(0, SCAN + 1)


def ball(radius):
    steps = range(-radius, radius + 1)
    return [(x, y, z) for x in steps for y in steps for z in steps
            if x * x + y * y + z * z <= radius * radius]


def dirty_columns(changed):
    """The columns within the ball's footprint around changed voxels."""
    footprint = {(x, y) for x, y, _ in ball(RADIUS)}
    return {(x + dx, y + dy) for x, y, _ in changed.tolist() for dx, dy in footprint}


def difference(first, second):
    return rows_of(sorted(as_set(first) - as_set(second)))


def update(recording, path):
    before, after = before_and_after(recording)
    lower = difference(after.occupied, before.occupied)
    raised = difference(before.occupied, after.occupied)
    grown = difference(after.inflated, before.inflated)
    shrunk = difference(before.inflated, after.inflated)
    dirty = dirty_columns(numpy.concatenate([lower, raised]))
    outside = {(x, y) for x, y, _ in numpy.concatenate([grown, shrunk]).tolist()} - dirty
    if outside:
        raise SystemExit(f'{len(outside)} columns changed that are not dirty')

    figure, (left, right) = drawing.new_figure(
        2, (12.0, 5.0), gridspec_kw={'width_ratios': [1.25, 1]})
    columns = numpy.array(sorted(dirty))
    box = (columns[:, 0].min() - 6, columns[:, 0].max() + 7,
           columns[:, 1].min() - 6, columns[:, 1].max() + 7)
    drawing.squares(left, drawing.seen_along(before.occupied, 2), drawing.PALE, box)
    drawing.squares(left, columns, palette.SKY, box)
    drawing.squares(left, drawing.seen_along(raised, 2), palette.VERMILION, box)
    drawing.squares(left, drawing.seen_along(lower, 2), palette.BLACK, box)
    left.set_title(f'{len(lower) + len(raised)} voxels changed, {len(dirty)} columns are dirty',
                   fontsize='medium')
    drawing.in_metres(left, EDGE)
    draw_section(left, right, after, lower, raised, grown, shrunk)
    drawing.legend(figure, {
        'occupied': drawing.PALE, 'became occupied': palette.BLACK,
        'ceased to be occupied': palette.VERMILION, 'dirty column': palette.SKY,
        'inflated': drawing.INFLATED_SHADE, 'became inflated': palette.ORANGE,
        'ceased to be inflated': palette.PURPLE}, 7)
    drawing.save(figure, path)
    return [('voxels that became occupied', len(lower)), ('ceased to be', len(raised)),
            ('dirty columns', len(dirty)), ('columns of the window', 1000 * 1000),
            ('became inflated', len(grown)), ('ceased to be inflated', len(shrunk)),
            ('occupied after it', len(after.occupied)), ('inflated after it', len(after.inflated))]


def draw_section(plan, axes, after, lower, raised, grown, shrunk):
    """Through the plane y = const that has most changes."""
    rows, counts = numpy.unique(numpy.concatenate([lower, raised])[:, 1], return_counts=True)
    y = rows[counts.argmax()]
    low, high = (drawing.layer(v, 1, y) for v in (lower, raised))
    changed = numpy.concatenate([low, high])
    middle = int(numpy.median(changed[:, 0]))
    box = (middle - 20, middle + 20, -5, 40)
    plan.axhline(y + 0.5, color=drawing.GREY, linewidth=1, linestyle='--', zorder=4)
    for voxels, colour in ((after.inflated, drawing.INFLATED_SHADE), (grown, palette.ORANGE),
                           (shrunk, palette.PURPLE), (after.occupied, drawing.GREY)):
        drawing.squares(axes, drawing.layer(voxels, 1, y), colour, box)
    drawing.squares(axes, high, palette.VERMILION, box)
    drawing.squares(axes, low, palette.BLACK, box)
    drawing.grid(axes, box)
    axes.set_title(f'Section along the dashed line, y = {y * EDGE:.1f} m', fontsize='medium')
    drawing.in_metres(axes, EDGE, ('x', 'z'))


def tiles_of(voxels):
    return {(x, y) for x, y in numpy.unique(voxels[:, :2] // TILE, axis=0).tolist()}


def draw_tile(axes, tile, colour, text='', edge='white'):
    axes.add_patch(patches.Rectangle((tile[0] * TILE, tile[1] * TILE), TILE, TILE, zorder=1,
                                     facecolor=colour, edgecolor=edge, linewidth=1.0))
    if text:
        axes.text((tile[0] + 0.06) * TILE, (tile[1] + 0.06) * TILE, text, fontsize='small',
                  zorder=5)


def snapshots(recording, path):
    """Tiles of which a bit differs between two snapshots in a row."""
    before, after = before_and_after(recording)
    known = [rows_of(numpy.concatenate([m.free, m.occupied])) for m in (before, after)]
    pairs = ((known[0], known[1]), (before.occupied, after.occupied),
             (before.inflated, after.inflated))
    changed = {tuple(v // TILE for v in voxel[:2])
               for one, other in pairs for voxel in as_set(one) ^ as_set(other)}
    live = tiles_of(numpy.concatenate([known[1], after.inflated]))
    new = live - tiles_of(numpy.concatenate([known[0], before.inflated]))
    figure, axes = drawing.new_figure(1, (8.5, 5.2))
    for tile in sorted(live):
        colour = drawing.PALE
        if tile in changed:
            colour = palette.SKY if tile in new else palette.ORANGE
        draw_tile(axes, tile, colour)
    columns = drawing.seen_along(after.occupied[after.occupied[:, 2] > 2], 2)
    axes.plot(*(columns.T + 0.5), 's', markersize=1.2, color=palette.BLACK, zorder=3)
    axes.plot(*(recording.view(SCAN).position[:2] / EDGE), 'o', color=palette.BLUE, zorder=4)
    axes.set_aspect('equal')
    axes.autoscale_view()
    drawing.in_metres(axes, EDGE)
    axes.set_title('Tiles of 32 x 32 columns of two snapshots, one scan apart')
    drawing.legend(figure, {'the same memory in both': drawing.PALE,
                            'copied for the second': palette.ORANGE,
                            **({'new in the second': palette.SKY} if new else {}),
                            'obstacles': palette.BLACK, 'camera': palette.BLUE})
    drawing.save(figure, path)
    return [('tiles in use', len(live)), ('copied for one scan', len(changed - new)),
            ('new', len(new))]


def window_after(recording, scan):
    """Lowest column of the small window: it follows on each axis when the vehicle is SLIDE voxels
    from its middle."""
    middle = None
    for number in range(scan):
        position = recording.body_at(number).position
        vehicle = [math.floor(position.x / EDGE), math.floor(position.y / EDGE)]
        middle = middle or vehicle
        middle = [v if abs(v - m) >= SLIDE else m for v, m in zip(vehicle, middle)]
    return [m - WINDOW // 2 for m in middle]


def window(recording, path):
    """The small window after two scans, with the slots of the tiles' ring."""
    lows = [window_after(recording, scan) for scan in WINDOW_AT]
    slots = 1
    while slots < (WINDOW + TILE - 2) // TILE + 1:
        slots *= 2
    figure, panels = drawing.new_figure(2, (12.0, 4.4), sharex=True, sharey=True)
    all_tiles = [range((min(low[a] for low in lows)) // TILE - 1,
                       (max(low[a] for low in lows) + WINDOW - 1) // TILE + 2) for a in (0, 1)]
    seen = []
    for axes, low, scan in zip(panels, lows, WINDOW_AT):
        occupied = recording.map_of(0, scan, **WINDOW_SIZE).occupied
        inside = ((occupied[:, :2] >= low) & (occupied[:, :2] < numpy.add(low, WINDOW))).all()
        if not inside:
            raise SystemExit(f'after scan {scan} there are voxels outside of the window')
        used = {}
        for x in all_tiles[0]:
            for y in all_tiles[1]:
                touches = all(low[a] < (t + 1) * TILE and t * TILE < low[a] + WINDOW
                              for a, t in ((0, x), (1, y)))
                slot = (x % slots) * slots + y % slots
                if touches:
                    used[slot] = (x, y)
                draw_tile(axes, (x, y), SLOT_COLOURS[x % slots] if touches else 'white', str(slot),
                          drawing.GREY)
        seen.append(used)
        axes.add_patch(patches.Rectangle(low, WINDOW, WINDOW, fill=False, linewidth=2, zorder=4,
                                         edgecolor=palette.BLUE))
        columns = drawing.seen_along(occupied[occupied[:, 2] > 2], 2)
        axes.plot(*(columns.T + 0.5), 's', markersize=1.2, color=palette.BLACK, zorder=3)
        axes.set_aspect('equal')
        axes.autoscale_view()
        axes.set_title(f'After scan {scan}')
        drawing.in_metres(axes, EDGE)
    drawing.legend(figure, {'window': palette.BLUE, 'obstacles': palette.BLACK,
                            'tile that the window touches, with its slot in the ring':
                            SLOT_COLOURS[0]})
    drawing.save(figure, path)
    kept = [slot for slot in seen[0] if seen[1].get(slot) == seen[0][slot]]
    return [('slots of the ring', slots * slots), ('tiles that both windows touch', len(kept))]


# Tints of the colours that are told apart, a colour for each column of the ring.
SLOT_COLOURS = ('#CFE8F6', '#FBE6B8', '#C8E9DE', '#F1D9E6')
