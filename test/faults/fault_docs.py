#!/usr/bin/python3
"""Compares docs/faults.md with test/faults/faults.yaml, which it is made from.

  fault_docs.py [--write]

Exits with 1 when they differ. With --write the document is written anew.
"""
import pathlib
import sys

import yaml

FOLDER = pathlib.Path(__file__).resolve().parent
DOCUMENT = FOLDER.parent.parent / 'docs' / 'faults.md'
SOURCE = FOLDER / 'faults.yaml'
PARTS = ('messages', 'parameters', 'files', 'loading', 'live')
LEVELS = {'ok': 'OK', 'warn': 'WARN', 'error': 'ERROR'}
TITLE = """# What goes wrong, and what happens then

<!-- Made from test/faults/faults.yaml by test/faults/fault_docs.py --write; a test compares them. -->

{count} faults. The tests make each of them happen, one by one, and check what is said here: the words
that the user sees, the level of `/diagnostics`, the map voxel by voxel, that these counters move and
no others, and that the next good scan becomes part of the map. Whatever comes in, every scan that was
received is integrated, dropped for one reason, or still waits: `received = integrated + dropped +
waiting` in `~statistics` and `/diagnostics`, checked after every test of the nodes, and by
`fiimap_eval` for every recording.

The level is that of the worse of the tasks `inputs` and `map` while nothing else comes in. Among good
scans a dropped one is a WARN.
"""
REMEDIES = """
## Dropped scans

A dropped scan is counted in `~statistics` and `/diagnostics` under a reason. The console (at most once
in five seconds for each reason) and `/diagnostics` say `reason: what was found; remedy`.

| Reason | Remedy |
|---|---|
"""


def words(row):
    said = '; '.join(f'"{text}"' for text in row['says'])
    return said or 'only the counter'


def message_table(faults):
    yield '| Cause | Level | Message | Map | Counters |'
    yield '|---|---|---|---|---|'
    for row in faults:
        after = '; '.join(row[key] for key in ('note', 'after') if key in row)
        effect = f'{row["map"]} ({after})' if after else row['map']
        yield (f'| {row["cause"]} | {LEVELS[row["level"]]} | {words(row)} | {effect} '
               f'| {", ".join(row["counters"])} |')


def other_table(faults):
    yield '| Cause | Message | What happens |'
    yield '|---|---|---|'
    for row in faults:
        yield f'| {row["cause"]} | {words(row)} | {row["effect"]} |'


def document(catalogue):
    count = sum(len(section['faults']) for part in PARTS for section in catalogue[part])
    text = TITLE.format(count=count) + REMEDIES
    text += ''.join(f'| {reason} | {remedy} |\n'
                    for reason, remedy in catalogue['remedies'].items())
    for part in PARTS:
        table = message_table if part == 'messages' else other_table
        for section in catalogue[part]:
            lines = '\n'.join(table(section['faults']))
            note = f'{section["note"]}\n\n' if 'note' in section else ''
            text += f'\n## {section["section"]}\n\n{note}{lines}\n'
    return text


def main():
    catalogue = yaml.safe_load(SOURCE.read_text())
    ids = [row['id'] for part in PARTS for section in catalogue[part] for row in section['faults']]
    if len(ids) != len(set(ids)):
        sys.exit(f'{SOURCE}: an id stands there twice')
    text = document(catalogue)
    if sys.argv[1:] == ['--write']:
        DOCUMENT.write_text(text)
    elif sys.argv[1:]:
        sys.exit(__doc__)
    elif not DOCUMENT.is_file() or DOCUMENT.read_text() != text:
        sys.exit(f'{DOCUMENT} is not what {SOURCE} gives: run fault_docs.py --write')
    print(f'{len(ids)} faults')


if __name__ == '__main__':
    main()
