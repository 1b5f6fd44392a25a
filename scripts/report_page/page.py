"""Puts figures, plots and pictures on one HTML page that needs nothing else."""
import datetime
import json
import pathlib
import platform

import jinja2
from markupsafe import Markup, escape

import figures
import flights
import map_pictures

# Table 1 of the paper, its laboratory corridor: share in percent, mean and deviation over scans.
PAPER_ACCURACY = [
    {'method': 'FIImap (paper)', 'resolution': 0.1, 'hit': 0.9176, 'std': 0.0601},
    {'method': 'FIImap (paper)', 'resolution': 0.2, 'hit': 0.9703, 'std': 0.0276},
    {'method': 'ego-planner (paper)', 'resolution': 0.1, 'hit': 0.9255, 'std': 0.0501},
    {'method': 'ego-planner (paper)', 'resolution': 0.2, 'hit': 0.9605, 'std': 0.0376},
]


def look_up(data, key):
    """The value at a path such as accuracy.results.0.hit_rate_mean."""
    for part in key.split('.'):
        data = data[int(part)] if isinstance(data, list) else data[part]
    return data


def machine():
    """What the figures were measured on."""
    cpu = platform.processor() or platform.machine()
    for line in pathlib.Path('/proc/cpuinfo').read_text().splitlines():
        if line.startswith('model name'):
            cpu = line.split(':', 1)[1].strip()
            break
    return {'processor': cpu, 'system': platform.platform(), 'name': platform.node(),
            'date': datetime.datetime.now().isoformat(timespec='seconds')}


def version():
    """Of the package, from its package.xml beside the program's folder or installed."""
    here = pathlib.Path(__file__).resolve()
    for folder in here.parents:
        for file in (folder / 'package.xml', folder / 'share' / 'fiimap' / 'package.xml'):
            if file.is_file() and '<name>fiimap</name>' in file.read_text():
                return file.read_text().split('<version>')[1].split('</version>')[0]
    return 'unknown'


def number_cells(data):
    """A table cell that says where in the figures its number is, for whoever checks it."""
    def cell(key, digits='.4g'):
        value = look_up(data, key)
        if value is None:
            text = 'never'
        else:
            text = value if isinstance(value, str) else format(value, digits)
        return Markup(f'<td data-key="{escape(key)}" data-format="{digits}">{escape(text)}</td>')
    return cell


def fill(template, data, **values):
    """The page; data: what its cells show, and what is embedded."""
    folder = str(pathlib.Path(__file__).resolve().parent)  # older versions take no Path
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(folder), autoescape=True,
        trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    embedded = Markup(json.dumps(data).replace('<', '\\u003c'))
    return environment.get_template(template).render(
        data=data, cell=number_cells(data), machine=machine(), version=version(),
        embedded=embedded, **values)


def render(name, bag, folder, steps, jobs):
    data = {step.name: step.figures(folder) for step in steps}
    parameters = data['run']['parameters']
    resolution = float(parameters['resolution'])
    csv_text = next(s for s in steps if s.name == 'compare').text(folder)
    images = {
        'run': figures.stage_figure(data['run']),
        'map': map_pictures.pictures(folder / 'run', resolution),
        'accuracy': figures.accuracy_figure(data['accuracy'], PAPER_ACCURACY),
        'sweep': figures.sweep_figures(data['sweep']),
        'compare': figures.compare_figures(data['compare'], csv_text),
    }
    if 'truth' in data:
        truth_resolution = data['truth']['results'][0]['resolution']
        images['truth'] = map_pictures.error_picture(folder / 'truth' / 'voxels.csv',
                                                     truth_resolution)
    return fill(
        'page.html', data, name=name, bag=bag.name, images=images, paper=PAPER_ACCURACY,
        parameters=parameters, jobs=jobs,
        stages=[s for s in figures.STAGES if s in data['run']['stages_ms']],
        label_of=figures.label_of, commands=[[s.name, *s.arguments] for s in steps])


def render_flights(rows):
    """rows: as flights.read() makes them."""
    return fill('flights.html', {'flights': rows}, images=flights.pictures(rows))
