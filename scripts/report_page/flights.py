"""What fiimap_flights --json wrote, as figures and as the paper's Figure 5: how far flights kept from
obstacles, one way of flying beside another."""
import json
import statistics

from matplotlib import pyplot

import figures  # chooses matplotlib's backend and colours
from steps import StepError

VEHICLE_RADIUS_M = 0.2
FARTHEST_M = 2.0        # what is farther is of no interest
PANEL_SIZE = (4.0, 3.4)  # inches
PANELS_PER_ROW = 3
MARK_PITCH = 5          # percent of the axis between the marks of two lines
NEAR_SHARE = 0.05       # of the time
SHARES = ('mapping', 'planning', 'simulation')


def distribution(flights):
    """Clearances, m, and the share of all flights' time that was spent nearer than each."""
    width = flights[0]['clearance_bin_m']
    bins = [0] * max(len(flight['clearance_histogram']) for flight in flights)
    for flight in flights:
        for i, count in enumerate(flight['clearance_histogram']):
            bins[i] += count
    total, below, shares = sum(bins), 0, [0.0]
    for count in bins:
        below += count
        shares.append(below / total)
    return [i * width for i in range(len(shares))], shares


def quantile(clearances, shares, share):
    """The clearance below which that share of the time was spent, m, to the width of a bin."""
    return next(c for c, s in zip(clearances, shares) if s >= share)


def summary(name, settings, flights):
    """A row of the table, and what its line in the plot needs."""
    least = [flight['least_clearance_m'] for flight in flights]
    clearances, shares = distribution(flights)

    def median(key):
        return statistics.median(flight[key] for flight in flights)

    return {
        'name': name, 'settings': settings, 'flights': len(flights),
        'reached': sum(flight['reached'] for flight in flights),
        'stranded': [(flight.get('seed'), flight.get('reason'))
                     for flight in flights if not flight['reached']],
        'collided': sum(flight['collisions'] > 0 for flight in flights),
        'least_clearance_m': min(least), 'median_of_least_m': statistics.median(least),
        'nearest_5_percent_m': quantile(clearances, shares, NEAR_SHARE),
        'nearest_half_m': quantile(clearances, shares, 0.5),
        'seconds': median('seconds'), 'path_length_m': median('path_length_m'),
        **{part: 100 * median(f'{part}_cpu_share') for part in SHARES},
        'clearances_m': clearances, 'shares': shares, 'least_clearances_m': least}


def read(arguments):
    """Rows of all files. arguments: NAME=FILE; the flights of a file are taken together by what was
    varied. Raises StepError."""
    rows = []
    for argument in arguments:
        name, equals, path = argument.partition('=')
        if not equals:
            raise StepError(f"'{argument}' must be NAME=FILE")
        groups = {}
        try:
            with open(path, encoding='utf-8') as stream:
                for flight in json.load(stream):
                    varied = (setting.partition('.')[2] for setting in flight['settings'])
                    groups.setdefault(', '.join(varied), []).append(flight)
            if not groups:
                raise StepError(f'{path} holds no flight')
            rows += [summary(name, settings, flights) for settings, flights in groups.items()]
        except OSError as error:
            raise StepError(f'{path}: {error.strerror}') from error
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise StepError(f'{path} is not what fiimap_flights --json writes: {error}') from error
    return rows


def draw_panel(axes, name, rows):
    for i, row in enumerate(rows, start=1):
        line, = axes.plot(row['clearances_m'], [100 * share for share in row['shares']],
                          label=row['settings'] or None)
        axes.plot(row['least_clearances_m'], [-MARK_PITCH * i] * row['flights'], '|',
                  color=line.get_color(), clip_on=False)
    axes.axvline(VEHICLE_RADIUS_M, color='grey', linestyle=':', label="vehicle's radius")
    axes.set(title=name, xlabel='clearance, m', xlim=(0, FARTHEST_M),
             ylim=(-MARK_PITCH * (len(rows) + 1), 100))
    axes.legend(fontsize='small')


def figure(rows):
    """A panel for each name, a line for each of its settings."""
    names = list(dict.fromkeys(row['name'] for row in rows))
    columns = min(len(names), PANELS_PER_ROW)
    lines = -(-len(names) // columns)
    drawn, axes = pyplot.subplots(lines, columns, sharey=True, squeeze=False, figsize=(
        PANEL_SIZE[0] * columns, PANEL_SIZE[1] * lines), constrained_layout=True)
    for axis, name in zip(axes.flat, names):
        draw_panel(axis, name, [row for row in rows if row['name'] == name])
    for axis in axes.flat[len(names):]:
        axis.set_visible(False)
    for axis in axes[:, 0]:
        axis.set_ylabel('time nearer than that, %')
    return drawn


def pictures(rows):
    return [('Clearance', figures.data_uri(figure(rows)))]
