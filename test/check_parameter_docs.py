#!/usr/bin/python3
"""Compares config/ and the README's tables of parameters with the code.

  check_parameter_docs.py PROGRAM [FILE]

`PROGRAM parameters` prints one line per parameter, tab-separated: name, default, unit, allowed,
meaning, and "tunable" where that is so. FILE in config/ describes all of them; without it, default.yaml and the README do, and other
files hold differences. Exits with 1 and one line per difference.
"""
import pathlib
import re
import subprocess
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent
OF_OTHER_NODES = {
    'demo_planner.yaml', 'demo_simulator.yaml', 'ego_planner.yaml', 'planner.yaml', 'simulator.yaml'}
TUNING_HEADING = '### Tuning while flying\n'


class Parameter:
    def __init__(self, line):
        (self.name, self.default, self.unit, self.allowed, self.meaning,
         *marks) = line.split('\t')
        self.tunable = 'tunable' in marks

    def must_mention(self):
        """What a description of the parameter has to contain: range with unit, or choices."""
        if '[' in self.allowed:
            return [self.allowed[self.allowed.index('['):]]
        if ' or ' in self.allowed:
            return re.split(r', | or ', self.allowed)
        return [self.unit]


def canonical(value):
    """Text of a value that does not depend on how it was written: 0.10, '0.1'; [0, 1], '0 1'."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (list, tuple)):
        return ' '.join(canonical(v) for v in value)
    words = str(value).split()
    try:
        return ' '.join(repr(float(word)) for word in words)
    except ValueError:
        return ' '.join(words)


def code_parameters(executable):
    lines = subprocess.run([executable, 'parameters'], check=True, capture_output=True,
                           text=True).stdout.splitlines()
    parameters = [Parameter(line) for line in lines if line]
    return {p.name: p for p in parameters}


def yaml_entries(path):
    """(name, value, comment) of every key; keys that follow each other share a comment."""
    values = yaml.safe_load(path.read_text())
    comment, after_key = '', False
    for line in path.read_text().splitlines():
        if line.startswith('#'):
            text = line.lstrip('# ')
            comment = text if after_key else comment + ' ' + text
            after_key = False
        elif not line.strip():
            comment, after_key = '', False
        else:
            after_key = True
            name = line.split(':')[0]
            yield name, values[name], comment


def readme_entries(path):
    """(name, default, row) of every row of the tables of parameters; a row may hold several."""
    in_table = False
    for line in path.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip('|').split('|')]
        if cells[:2] == ['Parameter', 'Default']:
            in_table = True
        elif not line.startswith('|'):
            in_table = False
        elif in_table and '`' in cells[0]:
            names = re.findall(r'`([^`]*)`', cells[0])
            defaults = re.findall(r'`([^`]*)`', cells[1])
            if len(names) != len(defaults):
                yield names[0], f'{len(defaults)} defaults for {len(names)} names', line
                continue
            for name, default in zip(names, defaults):
                yield name, yaml.safe_load(default), line


def compare_tunable(path, parameters):
    """Differences of the README's list of what may change while the node runs."""
    text = path.read_text()
    section = text[text.index(TUNING_HEADING) + len(TUNING_HEADING):]
    lines = [line for line in section[:section.index('\n#')].splitlines() if line[:1] == '|']
    listed = re.findall(r'`([^`]*)`', '\n'.join(lines))
    for name in {name for name in listed if listed.count(name) > 1}:
        yield f'{path.name}: {name} stands twice among what may change'
    for name, parameter in parameters.items():
        if parameter.tunable != (name in listed):
            yield (f'{path.name}: {name} may change while the node runs and is not listed there'
                   if parameter.tunable else f'{path.name}: {name} may not change')
    for name in set(listed) - set(parameters):
        yield f'{path.name}: {name}, which may change, is not a parameter'


def compare_all(where, entries, parameters):
    """Differences of a place that documents every parameter."""
    seen = set()
    for name, default, text in entries:
        if name not in parameters:
            yield f'{where}: {name} is not a parameter'
            continue
        if name in seen:
            yield f'{where}: {name} stands there twice'
        seen.add(name)
        expected = parameters[name]
        if canonical(default) != canonical(expected.default):
            yield f'{where}: {name} is {canonical(default)}, the default is {expected.default}'
        for words in expected.must_mention():
            if words not in text:
                yield f'{where}: {name} does not mention "{words}"'
    for name in parameters:
        if name not in seen:
            yield f'{where}: {name} is missing'


def compare_differences(path, parameters):
    """Differences of a file that holds only what differs from the defaults.

    What is below a sensor's name differs from what the file says for all, or from the default."""
    values = yaml.safe_load(path.read_text())
    sensors = values.get('sensors', [])
    for name, value in values.items():
        for key, own in value.items() if name in sensors else [(name, value)]:
            where = key if key is name else f'{name}/{key}'
            of_all = values.get(key) if key is not name else None
            if key not in parameters:
                yield f'{path.name}: {where} is not a parameter'
            elif canonical(own) == canonical(
                    parameters[key].default if of_all is None else of_all):
                yield f'{path.name}: {where} is {own}, which is what it is without'


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    parameters = code_parameters(sys.argv[1])
    if not parameters:
        sys.exit(f'{sys.argv[1]} parameters: prints no parameters')
    default_file = ROOT / 'config' / (sys.argv[2] if len(sys.argv) == 3 else 'default.yaml')
    problems = list(compare_all(default_file.name, yaml_entries(default_file), parameters))
    if default_file.name not in OF_OTHER_NODES:
        problems += compare_all('README.md', readme_entries(ROOT / 'README.md'), parameters)
        problems += compare_tunable(ROOT / 'README.md', parameters)
        for path in sorted((ROOT / 'config').glob('*.yaml')):
            if path != default_file and path.name not in OF_OTHER_NODES:
                problems += compare_differences(path, parameters)
    print('\n'.join(problems) or f'{len(parameters)} parameters are documented')
    sys.exit(1 if problems else 0)


if __name__ == '__main__':
    main()
