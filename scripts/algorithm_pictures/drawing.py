"""What the pictures have in common: voxels as squares, colours, sizes."""
import pathlib
import sys

import matplotlib
matplotlib.use('Agg')
# The backend must be chosen first.
from matplotlib import colors, patches, pyplot, ticker  # noqa: E402
import numpy  # noqa: E402

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'report_page'))
import palette  # noqa: E402  found by the path above

DPI = 100
FREE_SHADE = '#D6EBF7'      # a light tint of palette.SKY
INFLATED_SHADE = '#FFE3B0'  # a light tint of palette.ORANGE
GREY, PALE = '#8C8C8C', '#D9D9D9'


def new_figure(columns, size, rows=1, **more):
    return pyplot.subplots(rows, columns, figsize=size, constrained_layout=True, **more)


def save(figure, path):
    # Without the version of matplotlib, which is all that would differ from machine to machine.
    figure.savefig(str(path), dpi=DPI, bbox_inches='tight', metadata={'Software': None})
    pyplot.close(figure)


def squares(axes, cells, colour, view):
    """Voxels of a plane as squares of their size.

    cells: (a, b), one a row; view: (lowest a, end, lowest b, end) that is shown."""
    low_a, end_a, low_b, end_b = view
    image = numpy.zeros((end_b - low_b, end_a - low_a, 4))
    inside = cells[(cells[:, 0] >= low_a) & (cells[:, 0] < end_a)
                   & (cells[:, 1] >= low_b) & (cells[:, 1] < end_b)]
    image[inside[:, 1] - low_b, inside[:, 0] - low_a] = colors.to_rgba(colour)
    axes.imshow(image, origin='lower', extent=(low_a, end_a, low_b, end_b),
                interpolation='nearest', zorder=1)
    axes.set_aspect('equal')


def layer(voxels, axis, index):
    """Of the voxels with this index on an axis, the indices on the others."""
    return numpy.delete(voxels[voxels[:, axis] == index], axis, axis=1)


def seen_along(voxels, axis):
    """Columns along an axis with at least one of the voxels."""
    if len(voxels) == 0:
        return numpy.empty((0, 2), dtype=int)
    return numpy.unique(numpy.delete(voxels, axis, axis=1), axis=0)


def in_metres(axes, resolution, names=('x', 'y')):
    """Ticks in metres on axes that count voxels."""
    for axis, name in ((axes.xaxis, names[0]), (axes.yaxis, names[1])):
        axis.set_major_formatter(ticker.FuncFormatter(lambda voxel, _: f'{voxel * resolution:g}'))
        axis.set_label_text(f'{name}, m')


def grid(axes, view):
    """Borders of voxels."""
    axes.set_xticks(range(view[0], view[1] + 1), minor=True)
    axes.set_yticks(range(view[2], view[3] + 1), minor=True)
    axes.grid(True, which='minor', color='white', linewidth=0.4)
    axes.tick_params(which='minor', length=0)


def legend(figure, entries, columns=None):
    """Below the panels; entries: {text: colour}."""
    handles = [patches.Patch(facecolor=colour, edgecolor=GREY, linewidth=0.5, label=text)
               for text, colour in entries.items()]
    figure.legend(handles=handles, loc='upper center', bbox_to_anchor=(0.5, 0.0),
                  ncol=columns or len(handles), frameon=False, fontsize='small')

