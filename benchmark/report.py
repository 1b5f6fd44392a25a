#!/usr/bin/python3
"""Prints tables of what fiimap_compare measured, and draws plots.

  benchmark/report.py SAMPLES.json [--plots DIRECTORY] [--json FILE] [--into MARKDOWN]

Ratios are between medians of series that took turns in one process, and, where it says so, the
least of the ratios frame by frame.
"""
import argparse
import datetime
import json
import math
import pathlib
import platform
import statistics

MILLISECONDS = 1e-3  # per microsecond
BEGIN, END = '<!-- figures -->', '<!-- end of figures -->'
SCORE_BINS = [0, 1, 10, 25, 50, 100, 200, 400, 800, 1600, 3200, math.inf]


class Series:
    """Values of one method in one situation, frame by frame."""

    def __init__(self, entry):
        self.experiment = entry['experiment']
        self.recording = entry['recording']
        self.method = entry['method']
        self.setting = entry['setting']
        self.values = entry['values']

    @property
    def median(self):
        return statistics.median(self.values)

    @property
    def p95(self):
        return sorted(self.values)[max(0, math.ceil(0.95 * len(self.values)) - 1)]

    @property
    def max(self):
        return max(self.values)


class Samples:
    """All series of one run."""

    def __init__(self, entries):
        self.series = [Series(e) for e in entries]

    def of(self, experiment):
        return [s for s in self.series if s.experiment == experiment]

    def groups(self, experiment, *keys):
        """Series of an experiment by recording and these settings, in the order measured."""
        groups = {}
        for s in self.of(experiment):
            group = (s.recording, *(s.setting[k] for k in keys))
            groups.setdefault(group, {})[s.method] = s
        return groups


def table(title, header, rows):
    """Markdown, so that it can go into docs/performance.md as it is; nothing without rows."""
    if not rows:
        return ''
    rows = [[str(cell) for cell in row] for row in rows]
    widths = [max(len(line[i]) for line in [header] + rows) for i in range(len(header))]
    lines = ['| ' + ' | '.join(cell.ljust(w) for cell, w in zip(line, widths)) + ' |'
             for line in [header, ['-' * w for w in widths]] + rows]
    return f'### {title}\n\n' + '\n'.join(lines) + '\n\n'


def machine():
    """What was measured on."""
    cpu = platform.processor() or platform.machine()
    for line in pathlib.Path('/proc/cpuinfo').read_text().splitlines():
        if line.startswith('model name'):
            cpu = line.split(':', 1)[1].strip()
            break
    return f'Measured {datetime.date.today()} on one core of: {cpu}.\n\n'


def in_ms(series):
    return [f'{value * MILLISECONDS:.3f}' for value in (series.median, series.p95, series.max)]


def in_us(value):
    return f'{value:.1f}'


def frame_ratios(slow, fast):
    """Pairs of one frame; a time below the clock's resolution counts as the shortest measured."""
    floor = min(v for v in fast.values if v > 0)
    return [a / max(b, floor) for a, b in zip(slow.values, fast.values)]


def report_pipeline(samples, summary):
    rows = []
    for (recording, resolution), methods in samples.groups('pipeline', 'resolution').items():
        ours = methods['fiimap']
        for name, s in methods.items():
            ratio = s.median / ours.median
            rows.append([recording, resolution, name, *in_ms(s), f'{s.p95 / s.median:.2f}',
                         f'{ratio:.1f}x', f'{min(frame_ratios(s, ours)):.1f}x'])
            summary[f'pipeline {recording} {resolution} {name}'] = {
                'median_us': s.median, 'p95_us': s.p95, 'max_us': s.max, 'ratio': ratio}
    return table('Whole pipeline, from the depth image to the inflated map, ms per frame',
          ['recording', 'm', 'method', 'median', 'p95', 'max', 'p95 / median',
           'median / fiimap', 'least per frame'], rows)


def report_inflation(samples, summary):
    rows = []
    for (recording, reach, shape), methods in samples.groups('inflation', 'reach', 'shape').items():
        ours, batch = methods['incremental'], methods['byte_batch']
        ratio, least = batch.median / ours.median, min(frame_ratios(batch, ours))
        bfs = in_us(methods['bfs'].median) if 'bfs' in methods else ''
        rows.append([recording, reach, shape, in_us(ours.median), in_us(ours.p95), in_us(ours.max),
                     bfs, in_us(batch.median), in_us(batch.p95), f'{ratio:.0f}x', f'{least:.1f}x'])
        summary[f'inflation {recording} {reach} {shape}'] = {
            'median_us': ours.median, 'p95_us': ours.p95, 'max_us': ours.max,
            'batch_median_us': batch.median, 'ratio': ratio, 'least_ratio': least}
    return table('Inflation alone at 0.1 m, us per frame',
          ['recording', 'L', 'shape', 'incremental median', 'p95', 'max', 'bfs median',
           'byte batch median', 'p95', 'batch / incremental', 'least per frame'], rows)


def score_bins(samples, reach):
    """Times by change score over all recordings: [(bin, frames, {method: median us})]."""
    scores = {s.recording: s.values for s in samples.of('change_score')}
    bins = []
    for low, high in zip(SCORE_BINS, SCORE_BINS[1:]):
        times = {}
        for s in samples.of('inflation'):
            if s.setting['reach'] != reach or s.setting['shape'] != 'ball':
                continue
            chosen = [t for t, score in zip(s.values, scores[s.recording]) if low <= score < high]
            times.setdefault(s.method, []).extend(chosen)
        frames = len(next(iter(times.values()), []))
        if frames:
            bins.append(((low, high), frames, {m: statistics.median(t) for m, t in times.items()}))
    return bins


def bin_name(low, high):
    if not math.isfinite(high):
        return f'>= {low}'
    return str(low) if high == low + 1 else f'{low} - {high - 1}'


def report_scores(samples, _summary):
    text = ''
    for reach in (2, 4, 10):
        rows = []
        for (low, high), frames, times in score_bins(samples, reach):
            name = bin_name(low, high)
            bfs = in_us(times['bfs']) if 'bfs' in times else ''
            rows.append([name, frames, in_us(times['incremental']), bfs,
                         in_us(times['byte_batch'])])
        text += table(f'Inflation by change score at 0.1 m, ball, L = {reach}, median us',
                      ['change score', 'frames', 'incremental', 'bfs', 'byte batch'], rows)
    return text


def report_growth(samples, summary):
    text = ''
    for key, unit in (('resolution', 'm'), ('window', 'm'), ('range', 'm'), ('reach', 'voxels')):
        rows = []
        for s in samples.of(f'growth_{key}'):
            setting = s.setting[key]
            name = ' x '.join(f'{v:g}' for v in setting) if isinstance(setting, list) else setting
            rows.append([s.recording, name, *in_ms(s)])
            summary[f'growth_{key} {s.recording} {name}'] = {'median_us': s.median}
        text += table(f'Whole pipeline by {key}, ms per frame',
                      ['recording', f'{key} ({unit})', 'median', 'p95', 'max'], rows)
    return text


def report_worst(samples, summary):
    rows = []
    scores = samples.groups('worst_change_score', 'resolution', 'event')
    for s in samples.of('worst'):
        resolution, event = s.setting['resolution'], s.setting['event']
        score = scores[s.recording, resolution, event]['fiimap'].median
        rows.append([s.recording, resolution, event, f'{score:.0f}',
                     f'{s.median * MILLISECONDS:.3f}', f'{s.max * MILLISECONDS:.3f}'])
        summary[f'worst {s.recording} {resolution} {event}'] = {
            'median_us': s.median, 'max_us': s.max}
    return table('Frames in which something happens, 100 x 100 x 6 m, ms',
          ['recording', 'm', 'event', 'change score', 'median', 'max'], rows)


def report_reading(samples, summary):
    rows = []
    for (recording, resolution), methods in samples.groups('snapshot', 'resolution').items():
        snapshot = methods['fiimap']
        query = samples.groups('query', 'resolution')[recording, resolution]['fiimap']
        held, worst = samples.groups('memory_bytes', 'resolution')[recording, resolution][
            'fiimap'].values
        rows.append([recording, resolution, in_us(snapshot.median), in_us(snapshot.p95),
                     f'{1000 * query.median:.1f}', f'{held / 1e6:.1f}', f'{worst / 1e6:.1f}'])
        summary[f'reading {recording} {resolution}'] = {
            'snapshot_us': snapshot.median, 'query_us': query.median, 'memory_bytes': held}
    return table('Reading',
          ['recording', 'm', 'snapshot median us', 'p95', 'query ns', 'memory MB',
           'memory MB when all was seen'], rows)


def overview(samples, summary):
    """The ratios that matter most, from what the other reports found."""
    rows = []
    for recording in dict.fromkeys(s.recording for s in samples.series):
        for other in ('ego', 'ego_invalid_far', 'octomap'):
            figures = summary.get(f'pipeline {recording} 0.1 {other}')
            if figures:
                rows.append([recording, f'pipeline against {other}, 0.1 m, L = 2',
                             f'{figures["ratio"]:.1f}x'])
        figures = summary.get(f'inflation {recording} 2 ball')
        if figures:
            rows.append([recording, 'inflation against byte batch, 0.1 m, L = 2, ball',
                         f'{figures["ratio"]:.0f}x'])
        least = [v['least_ratio'] for k, v in summary.items()
                 if k.startswith(f'inflation {recording} ')]
        if least:
            rows.append([recording, 'the same, least of all frames, L and shapes',
                         f'{min(least):.1f}x'])
    return table('Ratios', ['recording', 'what', 'times faster'], rows)


def insert(text, file):
    before, rest = file.read_text().split(BEGIN)
    after = rest.split(END)[1]
    file.write_text(f'{before}{BEGIN}\n{text}{END}{after}')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('samples', type=pathlib.Path)
    parser.add_argument('--plots', type=pathlib.Path)
    parser.add_argument('--json', type=pathlib.Path, help='where to write the figures')
    parser.add_argument('--into', type=pathlib.Path,
                        help='Markdown file that gets the tables between its marks')
    arguments = parser.parse_args()
    samples = Samples(json.loads(arguments.samples.read_text()))
    summary = {}
    text = ''
    for report in (report_pipeline, report_inflation, report_scores, report_growth, report_worst,
                   report_reading):
        text += report(samples, summary)
    text = machine() + overview(samples, summary) + text
    print(text)
    if arguments.into:
        insert(text, arguments.into)
    if arguments.json:
        arguments.json.write_text(json.dumps(summary, indent=2) + '\n')
    if arguments.plots:
        import plots  # needs matplotlib
        plots.draw(samples, score_bins, arguments.plots)


if __name__ == '__main__':
    main()
