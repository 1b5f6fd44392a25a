"""Plots of what fiimap_eval measured, as PNG images in data URIs."""
import base64
import csv
import io

import matplotlib
matplotlib.use('Agg')
from matplotlib import pyplot  # noqa: E402  the backend must be chosen first

import palette  # noqa: E402

palette.use()

DPI = 100
SIZE = (6.4, 4.2)  # inches
WIDE = (7.6, 4.2)
PAPER_MARK = 150   # change score above which the paper's method is slower than batch inflation
PAPER_MEAN_US = 3000  # of an update, as the paper reports it for one or two voxels (i7-9700K)
STAGES = ('project', 'slide', 'raycast', 'fuse', 'inflate', 'snapshot')  # in their order
MIN_UPDATES = 20   # the first updates of a recording say little about the others
LABELS = {
    'incremental': 'fiimap, incremental', 'bfs6': "the paper's search (6)", 'bfs18': 'search (18)',
    'bfs26': 'search (26)', 'batch': 'all anew (bits)', 'byte_batch': 'ego-planner-style batch',
    'fiimap': 'fiimap', 'ego': 'ego-planner style', 'octomap': 'OctoMap',
}


def label_of(method):
    return LABELS.get(method, method)


def data_uri(figure):
    buffer = io.BytesIO()
    figure.savefig(buffer, format='png', dpi=DPI, bbox_inches='tight')
    pyplot.close(figure)
    return 'data:image/png;base64,' + base64.b64encode(buffer.getvalue()).decode()


def new_figure(title, x_label, y_label, size=SIZE):
    figure, axes = pyplot.subplots(figsize=size, constrained_layout=True)
    axes.set_title(title)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.grid(True, which='both', alpha=0.25)
    return figure, axes


def legend_below(axes):
    """Where it covers no points; large dots, because those of the plot are small."""
    axes.legend(fontsize='small', loc='upper center', bbox_to_anchor=(0.5, -0.13), ncol=3,
                markerscale=2, frameon=False)


def sweep_figures(sweep):
    """Figure 6: a plot for each shape and resolution, without series whose time was up at once."""
    groups = {}
    all_updates = max(row['updates'] for row in sweep['results'])
    for row in sweep['results']:
        if row['updates'] < min(all_updates, MIN_UPDATES):
            continue
        series = groups.setdefault((row['shape'], row['resolution']), {})
        series.setdefault(row['method'], []).append((row['reach'], row['median_us']))
    images = []
    for (shape, resolution), series in groups.items():
        title = f'Inflation by {shape}, {resolution:g} m'
        figure, axes = new_figure(title, 'L, voxels', 'us per update, median')
        for method, points in series.items():
            axes.plot(*zip(*sorted(points)), marker='o', label=label_of(method))
        axes.set_yscale('log')
        legend_below(axes)
        images.append((title, data_uri(figure)))
    return images


def read_updates(text):
    """Columns of the comparison's CSV."""
    rows = list(csv.reader(io.StringIO(text)))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def compare_figures(compare, csv_text):
    """Figures 7 and 8: against the number of the update, and against its change score."""
    updates = read_updates(csv_text)
    scores = updates['change_score']
    images = []
    for what, name in (('inflation', 'Inflation'), ('map', 'Whole map')):
        methods = [m['method'] for m in compare['methods'] if m['what'] == what]
        for x, x_label, title in ((updates['update'], 'update', f'{name} by update'),
                                  (scores, 'change score', f'{name} by change score')):
            figure, axes = new_figure(title, x_label, 'us per update')
            for method in methods:
                axes.scatter(x, updates[f'{method}_us'], s=6, alpha=0.6, label=label_of(method))
            axes.axhline(PAPER_MEAN_US, color='grey', linestyle=':', linewidth=1,
                         label="the paper's mean, 3 ms")
            axes.set_yscale('log')
            if x is scores:
                axes.set_xscale('symlog')
                axes.set_xlim(left=-0.5)
                axes.axvline(PAPER_MARK, color='grey', linestyle='--', linewidth=1,
                             label="the paper's mark, 150")
            legend_below(axes)
            images.append((title, data_uri(figure)))
    return images


def accuracy_figure(accuracy, paper):
    """Table 1: this recording's maps, then those of the paper at the same resolutions."""
    title = 'Share of held-out end points in occupied voxels'
    rows = [r for r in accuracy['results'] if r['variant'] == 'final_map']
    resolutions = {r['resolution'] for r in rows}
    theirs = [p for p in paper if p['resolution'] in resolutions]
    names = [f"{r['method']}\n{r['resolution']:g} m" for r in rows]
    paper_names = [f"{p['method'].replace(' (', chr(10) + '(')}\n{p['resolution']:g} m"
                   for p in theirs]
    figure, axes = new_figure(title, '', 'share', WIDE)
    axes.bar(names, [r['hit_rate_mean'] for r in rows], yerr=[r['hit_rate_std'] for r in rows],
             capsize=4, label='hit')
    if theirs:
        axes.bar(paper_names, [p['hit'] for p in theirs], yerr=[p['std'] for p in theirs],
                 capsize=4, color='0.7', label="hit, the paper's corridor")
    axes.plot(names, [r['blocked_rate_mean'] for r in rows], 'o', color=palette.VERMILION,
              label='blocked')
    axes.tick_params(axis='x', labelsize='x-small')
    axes.set_ylim(0, 1.05)
    axes.legend(fontsize='small', loc='upper center', bbox_to_anchor=(0.5, -0.17), ncol=3,
                frameon=False)
    return [(title, data_uri(figure))]


def stage_figure(run):
    title = 'Time of each stage per scan'
    stages = run['stages_ms']
    order = [s for s in STAGES if s in stages]
    figure, axes = new_figure(title, '', 'ms')
    places = range(len(order))
    axes.bar([p - 0.2 for p in places], [stages[s]['median'] for s in order], 0.4, label='median')
    axes.bar([p + 0.2 for p in places], [stages[s]['p95'] for s in order], 0.4, label='p95')
    axes.set_xticks(list(places))
    axes.set_xticklabels(order)
    axes.legend(fontsize='small')
    return [(title, data_uri(figure))]
