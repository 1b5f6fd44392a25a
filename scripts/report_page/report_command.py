"""The command line of the report: which steps, for which recordings, how many at a time."""
import argparse
import concurrent.futures
import os
import pathlib
import shutil
import sys
import threading

from steps import Step, StepError, write_whole

VERIFY_EVERY = 50           # scans
COMPARE_RESOLUTION = 0.2    # m: the paper's Figures 7 and 8
FLIGHTS = 'flights'         # name of the page of simulated flights
DRAWING = threading.Lock()  # matplotlib reads formulas in one thread at a time


def parse(description):
    parser = argparse.ArgumentParser(
        prog='fiimap_eval report', description=description,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add('bags', nargs='*', type=pathlib.Path, metavar='BAG')
    add('-o', '--output', required=True, type=pathlib.Path, metavar='DIR')
    add('--flights', action='append', default=[], metavar='NAME=FILE',
        help='what fiimap_flights --json wrote, for the page DIR/flights.html; may be repeated')
    add('--config', type=pathlib.Path, help='parameters (YAML, as for the nodelet)')
    add('--set', action='append', default=[], metavar='NAME=VALUE',
        help='a parameter, after those of the file; may be repeated')
    add('--resolutions', nargs='+', type=float, default=[0.2, 0.1], metavar='M',
        help='voxel sizes of accuracy, sweep and truth (0.2 0.1)')
    add('--folds', type=int, default=10, help='of the cross-validation (10)')
    add('--split', type=pathlib.Path, help='which scans to hold out, instead of folds')
    add('--scene', type=pathlib.Path,
        help='exact scene of a synthetic recording; default: NAME_scene.json beside the bag')
    add('--reach', type=int, default=1, metavar='L',
        help='inflation of the comparison by update, voxels of 0.2 m (1)')
    add('--reaches', nargs='+', type=int, default=list(range(1, 11)), metavar='L',
        help='inflations of the sweep, voxels (1 to 10)')
    add('--seconds', type=float, default=5.0, help='CPU time of each series of the sweep (5)')
    add('--jobs', type=int, default=1,
        help='recordings at a time (1); more than one core disturbs the times')
    return parser.parse_args()


def scene_of(bag, arguments):
    """The file of the exact scene, or None."""
    if arguments.scene:
        return arguments.scene
    for name in (bag.stem, bag.stem.replace('_excerpt', '')):
        scene = bag.with_name(f'{name}_scene.json')
        if scene.exists():
            return scene
    return None


def steps_for(bag, arguments):
    common = []
    files = []
    if arguments.config:
        common += ['--config', arguments.config.resolve()]
        files.append(arguments.config)
    for setting in arguments.set:
        common += ['--set', setting]
    resolutions = ['--resolutions', *arguments.resolutions]
    split = ['--folds', arguments.folds]
    split_files = list(files)
    if arguments.split:
        split = ['--split', arguments.split.resolve()]
        split_files.append(arguments.split)
    radius = arguments.reach * COMPARE_RESOLUTION
    steps = [
        Step('health', common, files),
        Step('run', [*common, '--verify', VERIFY_EVERY, '--save', 'map'], files),
        Step('accuracy', [*common, *resolutions, *split, '--octomap'], split_files),
        Step('sweep', [*common, *resolutions, '--reaches', *arguments.reaches, '--seconds',
                       arguments.seconds], files),
        Step('compare', [*common, '--set', f'resolution={COMPARE_RESOLUTION:g}', '--set',
                         f'inflation_radius={radius:g}', '--csv'], files),
    ]
    scene = scene_of(bag, arguments)
    if scene:
        steps.append(Step('truth', [*common, *resolutions, '--scene', scene.resolve(), '--voxels',
                                    'voxels.csv'], [*files, scene]))
    return steps


def report_on(bag, name, program, arguments):
    """Runs what is missing and writes the page. Raises StepError or OSError."""
    folder = arguments.output / name
    new_folder = not folder.exists()
    steps = steps_for(bag, arguments)
    done = 0
    try:
        for step in steps:
            if step.is_done(program, bag, folder):
                print(f'{name}: {step.name} is up to date', file=sys.stderr)
            else:
                print(f'{name}: {step.name}', file=sys.stderr)
                step.run(program, bag, folder)
            done += 1
    except (StepError, OSError):
        if new_folder and done == 0:
            shutil.rmtree(folder, ignore_errors=True)
        raise
    with DRAWING:
        import page  # here, because matplotlib takes a second, which bad input need not wait for
        write_whole(arguments.output / f'{name}.html',
                    page.render(name, bag, folder, steps, arguments.jobs))


def report_on_flights(arguments):
    """Writes the page of simulated flights. Raises StepError or OSError."""
    with DRAWING:
        import flights  # here, as above
        import page
        rows = flights.read(arguments.flights)
        write_whole(arguments.output / f'{FLIGHTS}.html', page.render_flights(rows))


def names_of(bags):
    """A name for each page; recordings of the same name are numbered, and none is that of flights."""
    names = []
    for bag in bags:
        name, number = bag.stem, 2
        while name in [*names, FLIGHTS]:
            name, number = f'{bag.stem}_{number}', number + 1
        names.append(name)
    return names


def check(arguments):
    files = [*arguments.bags, arguments.config, arguments.split, arguments.scene]
    for file in files:
        if file and not file.is_file():
            raise StepError(f'{file} is not a file')
    if not arguments.bags and not arguments.flights:
        raise StepError('there must be a recording or --flights')
    if arguments.jobs < 1:
        raise StepError('--jobs must be at least 1')


def make_pages(program, arguments):
    """Returns how many failed; their reasons are printed."""
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        tasks = {bag: pool.submit(report_on, bag, name, program, arguments)
                 for bag, name in zip(arguments.bags, names_of(arguments.bags))}
        if arguments.flights:
            tasks['flights'] = pool.submit(report_on_flights, arguments)
        failures = 0
        for subject, task in tasks.items():
            try:
                task.result()
            except (StepError, OSError) as error:
                print(f'error: {subject}: {error}', file=sys.stderr)
                failures += 1
    return failures


def main(description):
    arguments = parse(description)
    program = pathlib.Path(os.environ.get('FIIMAP_EVAL', 'fiimap_eval'))
    try:
        check(arguments)
        new_output = not arguments.output.exists()
        arguments.output.mkdir(parents=True, exist_ok=True)
    except (StepError, OSError) as error:
        print(f'error: {error}', file=sys.stderr)
        return 1
    failures = make_pages(program, arguments)
    names = names_of(arguments.bags) + ([FLIGHTS] if arguments.flights else [])
    for path in sorted(arguments.output.glob('*.html')):
        if path.stem in names:
            print(path)
    if new_output and not any(arguments.output.iterdir()):
        arguments.output.rmdir()
    return 1 if failures else 0
