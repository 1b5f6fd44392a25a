"""Log-odds, why short cuts of inflation are wrong, and decay."""
import math

import numpy

import drawing
import palette
from maps import as_set, rows_of

EDGE = 0.1  # m
DECAY_S = 2.0
SCANS = (0, 110)
SEQUENCE = 'hhhhmmhhhhhhmmmmmmmmm'  # hits and misses of the scans in turn
STEPS = 127  # of the fixed point, to either side


def log_odds(p):
    return math.log(p / (1 - p))


def parameter(recording, name):
    """A default as fiimap_eval has it."""
    return float(recording.default(name))


def probabilities(recording, path):
    """Log-odds of a voxel under a sequence of observations."""
    levels = {name: log_odds(parameter(recording, name))
              for name in ('p_hit', 'p_miss', 'p_min', 'p_max', 'p_occ')}
    unit = max(abs(level) for name, level in levels.items() if name != 'p_occ') / STEPS
    steps = {name: round(level / unit) for name, level in levels.items()}
    value, values = 0, [0]
    for observation in SEQUENCE:
        value += steps['p_hit'] if observation == 'h' else steps['p_miss']
        value = max(steps['p_min'], min(steps['p_max'], value))
        values.append(value)
    figure, axes = drawing.new_figure(1, (9.5, 3.8))
    for name, text in (('p_max', 'p_max'), ('p_occ', 'p_occ: occupied from here on'),
                       ('p_min', 'p_min')):
        axes.axhline(steps[name], color=drawing.GREY, linewidth=1, linestyle='--')
        axes.text(1.01, steps[name], text, transform=axes.get_yaxis_transform(), va='center',
                  fontsize='small')
    axes.plot(range(len(values)), values, color=palette.BLACK, linewidth=1, zorder=2)
    for kind, colour, marker, text in (('h', palette.VERMILION, 'o', 'after a hit'),
                                       ('m', palette.BLUE, 'v', 'after a miss')):
        at = [i + 1 for i, observation in enumerate(SEQUENCE) if observation == kind]
        axes.plot(at, [values[i] for i in at], marker, color=colour, label=text, zorder=3)
    axes.plot(0, 0, 's', color=drawing.GREY, label='unknown')
    axes.set_xticks(range(0, len(values), 2))
    axes.set_xlabel('scans that observed the voxel')
    axes.set_ylabel('log-odds, steps')
    axes.legend(frameon=False, fontsize='small', loc='lower center', ncol=3)
    axes.set_ylim(steps['p_min'] - 45, steps['p_max'] + 15)
    drawing.save(figure, path)
    return [('steps that a hit adds', steps['p_hit']), ('a miss', steps['p_miss']),
            ('least', steps['p_min']), ('most', steps['p_max']), ('occupied from', steps['p_occ']),
            ('hits until an unknown voxel is occupied', -(-steps['p_occ'] // steps['p_hit'])),
            ('misses until a sure one is not',
             (steps['p_max'] - steps['p_occ']) // -steps['p_miss'] + 1)]


def inflated(obstacles, reach):
    """By the definition, in one dimension."""
    return {u + d for u in obstacles for d in range(-reach, reach + 1)}


def raise_by_shortcut(before, removed, obstacles, reach):
    """Clears within twice the reach, then inflates again the obstacles that lie there."""
    near = range(removed - 2 * reach, removed + 2 * reach + 1)
    return (before - set(near)) | inflated([u for u in obstacles if u in near], reach)


def lower_by_shortcut(before, added, reach):
    """A search from the new obstacle that does not go on from voxels that are inflated already."""
    after, reached = set(before) | {added}, [added]
    while reached:
        voxel = reached.pop(0)
        for beside in (voxel - 1, voxel + 1):
            if abs(beside - added) <= reach and beside not in after:
                after.add(beside)
                reached.append(beside)
    return after


def shortcuts(recording, path):
    """Two cases in one dimension, as few voxels as show the error."""
    reach = 1
    erased_before = inflated([0, 3], reach)
    erased = (('Before', {0, 3}, erased_before),
              ('Cleared within 2 L', {3}, raise_by_shortcut(erased_before, 0, [3], reach)),
              ('By the definition', {3}, inflated([3], reach)))
    reach = 2
    stopped_before = inflated([4], reach)
    stopped = (('Before', {4}, stopped_before),
               ('Search that stops early', {3, 4}, lower_by_shortcut(stopped_before, 3, reach)),
               ('By the definition', {3, 4}, inflated([3, 4], reach)))
    figure, panels = drawing.new_figure(2, (12.0, 2.6))
    titles = ('L = 1: the obstacle at 0 vanishes', 'L = 2: an obstacle appears at 3')
    for axes, rows, title in zip(panels, (erased, stopped), titles):
        draw_line(axes, rows)
        axes.set_title(title)
    drawing.legend(figure, {'occupied': palette.BLACK, 'inflated': palette.ORANGE,
                            'free': 'white', 'should be inflated, and is not': palette.VERMILION})
    drawing.save(figure, path)
    return [('voxels lost by clearing within 2 L', len(erased[2][2] - erased[1][2])),
            ('by stopping early', len(stopped[2][2] - stopped[1][2]))]


def draw_line(axes, rows):
    voxels = range(-3, 8)
    right = rows[-1][2]
    for line, (name, obstacles, area) in enumerate(rows):
        for voxel in voxels:
            colour = palette.ORANGE if voxel in area else 'white'
            if line == 1 and voxel in right - area:
                colour = palette.VERMILION
            if voxel in obstacles:
                colour = palette.BLACK
            axes.add_patch(drawing.patches.Rectangle((voxel - 0.5, -line), 1, 0.8, facecolor=colour,
                                                     edgecolor=drawing.GREY))
        axes.text(voxels[0] - 0.8, 0.4 - line, name, ha='right', va='center', fontsize='small')
    axes.set_xlim(voxels[0] - 0.6, voxels[-1] + 0.6)
    axes.set_ylim(0.9 - len(rows), 0.9)
    axes.set_xticks(voxels)
    axes.set_yticks([])
    axes.tick_params(length=0)
    for side in axes.spines.values():
        side.set_visible(False)


def decay(recording, path):
    kept = recording.map_of(*SCANS)
    forgotten = recording.map_of(*SCANS, decay_time=DECAY_S)
    figure, panels = drawing.new_figure(2, (12.0, 3.4), sharey=True)
    box = tuple(int(v) for a in (0, 1) for v in (
        kept.occupied[:, a].min() - 5, kept.occupied[:, a].max() + 6))
    way = numpy.array([[p.x, p.y] for p in (
        recording.body_at(number).position for number in range(0, SCANS[1], 10))]) / EDGE
    for axes, of, title in zip(panels, (kept, forgotten),
                               ('decay_time 0', f'decay_time {DECAY_S:g} s')):
        drawing.squares(axes, drawing.seen_along(of.free, 2), drawing.FREE_SHADE, box)
        drawing.squares(axes, drawing.seen_along(of.occupied[of.occupied[:, 2] <= 2], 2),
                        drawing.PALE, box)
        drawing.squares(axes, drawing.seen_along(of.occupied[of.occupied[:, 2] > 2], 2),
                        palette.BLACK, box)
        axes.plot(*way.T, color=palette.BLUE, linewidth=1, zorder=3)
        axes.plot(*way[-1], 'o', color=palette.BLUE, zorder=4)
        axes.set_title(f'{title}: {len(of.occupied)} occupied')
        drawing.in_metres(axes, EDGE)
    drawing.legend(figure, {'obstacles': palette.BLACK, 'floor': drawing.PALE,
                            'free, nothing below': drawing.FREE_SHADE,
                            'way of the vehicle': palette.BLUE})
    drawing.save(figure, path)
    added = rows_of(sorted(as_set(forgotten.free) - as_set(kept.free)))
    return [('occupied, decay_time 0', len(kept.occupied)),
            (f'occupied, decay_time {DECAY_S:g} s', len(forgotten.occupied)),
            ('free, decay_time 0', len(kept.free)),
            (f'free, decay_time {DECAY_S:g} s', len(forgotten.free)),
            ('free by decay alone', len(added))]
