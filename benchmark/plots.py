"""Plots of what fiimap_compare measured, for docs/performance.md."""
import math
import pathlib
import sys

import matplotlib
matplotlib.use('Agg')
from matplotlib import pyplot  # noqa: E402  the backend must be chosen first

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'scripts' / 'report_page'))
import palette  # noqa: E402  found by the path above

palette.use()

MILLISECONDS = 1e-3  # per microsecond
SIZE = (6, 4)        # inches
DPI = 100
DASHES = ('-', '--', ':', '-.')


def figure(title, x_label, y_label):
    fig, axes = pyplot.subplots(figsize=SIZE)
    axes.set_title(title)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.grid(True, which='both', alpha=0.3)
    return fig, axes


def save(fig, path):
    fig.axes[0].legend(loc='upper left', bbox_to_anchor=(1.0, 1.0), frameon=False)
    fig.savefig(path, dpi=DPI, bbox_inches='tight')
    pyplot.close(fig)


def lines(axes, points):
    """points: {label: [(x, y)]}; a line each, or nothing where there are none. Of a label
    'recording what', each recording has its dashes and each what its colour."""
    recordings, colours = [], []
    for label, pairs in points.items():
        recording, _, what = label.rpartition(' ')
        for seen, name in ((recordings, recording), (colours, what)):
            if name not in seen:
                seen.append(name)
        pairs = sorted(pairs)
        axes.plot([x for x, _ in pairs], [y for _, y in pairs], marker='o', label=label,
                  color=f'C{colours.index(what)}', linestyle=DASHES[recordings.index(recording)])


def resolution_ticks(axes, points):
    """Writes the resolutions that were measured at a logarithmic axis."""
    ticks = sorted({x for pairs in points.values() for x, _ in pairs})
    axes.set_xticks(ticks)
    axes.set_xticklabels([f'{tick:g}' for tick in ticks])
    axes.minorticks_off()


def draw_growth(samples, folder, key, x_label):
    points = {}
    for s in samples.of(f'growth_{key}'):
        for name in ('median', 'p95'):
            points.setdefault(f'{s.recording} {name}', []).append(
                (s.setting[key], getattr(s, name) * MILLISECONDS))
    if not points:
        return
    fig, axes = figure(f'Whole pipeline by {key}', x_label, 'ms per frame')
    lines(axes, points)
    axes.set_ylim(bottom=0)
    save(fig, folder / f'growth_{key}.png')


def draw_window(samples, folder):
    points = {}
    for s in samples.of('growth_window'):
        volume = math.prod(s.setting['window'])
        points.setdefault(s.recording, []).append((volume, s.median * MILLISECONDS))
    if not points:
        return
    fig, axes = figure('Whole pipeline by size of the window', 'cubic metres', 'ms per frame')
    lines(axes, points)
    axes.set_xscale('log')
    axes.set_ylim(bottom=0)
    save(fig, folder / 'growth_window.png')


def draw_pipelines(samples, folder):
    points = {}
    for s in samples.of('pipeline'):
        points.setdefault(f'{s.recording} {s.method}', []).append(
            (s.setting['resolution'], s.median * MILLISECONDS))
    if not points:
        return
    fig, axes = figure('Whole pipelines, L = 2', 'resolution, m', 'ms per frame, median')
    lines(axes, points)
    axes.set_xscale('log')
    axes.set_yscale('log')
    resolution_ticks(axes, points)
    save(fig, folder / 'pipelines.png')


def draw_inflation(samples, folder):
    points = {}
    for s in samples.of('inflation'):
        if s.setting['shape'] == 'ball':
            points.setdefault(f'{s.recording} {s.method}', []).append(
                (s.setting['reach'], s.median))
    if not points:
        return
    fig, axes = figure('Inflation alone by ball, 0.1 m', 'L, voxels', 'us per frame, median')
    lines(axes, points)
    axes.set_yscale('log')
    save(fig, folder / 'inflation.png')


def draw_scores(samples, score_bins, folder):
    for reach in (2, 10):
        points = {}
        for (low, _), _, times in score_bins(samples, reach):
            for method, time in times.items():
                points.setdefault(method, []).append((max(low, 1), time))
        if not points:
            continue
        fig, axes = figure(f'Inflation by change score, ball, L = {reach}, 0.1 m',
                           'change score (lower end of the bin)', 'us per frame, median')
        lines(axes, points)
        axes.set_xscale('log')
        axes.set_yscale('log')
        save(fig, folder / f'change_score_L{reach}.png')


def draw(samples, score_bins, folder):
    """Writes one PNG a plot into the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    draw_pipelines(samples, folder)
    draw_inflation(samples, folder)
    draw_scores(samples, score_bins, folder)
    draw_window(samples, folder)
    draw_growth(samples, folder, 'resolution', 'm')
    draw_growth(samples, folder, 'range', 'm')
    draw_growth(samples, folder, 'reach', 'voxels')
