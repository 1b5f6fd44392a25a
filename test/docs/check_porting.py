#!/usr/bin/python3
"""Checks that docs/porting.md shows the program of examples/without_ros as it is, and what it
prints; that its CMakeLists.txt works outside of fiimap's build; that the document's list of files
in src/ros that know a node or a clock is complete; and that the sample recording has the voxels
that it says.

  check_porting.py PROGRAM CMAKE FIIMAP_EVAL
"""
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / 'examples' / 'without_ros'
DOCUMENT = (ROOT / 'docs' / 'porting.md').read_text()
NODE_OR_CLOCK = re.compile(r'NodeHandle|ros/ros\.h|Time::now|_clock::now|WallTime')


def block(language):
    """The first block of a language."""
    return re.search(rf'^```{language}\n(.*?)^```', DOCUMENT, re.DOTALL | re.MULTILINE).group(1)


def wrong(program, cmake, fiimap_eval):
    """Sentences."""
    for language, file in (('cpp', 'main.cpp'), ('cmake', 'CMakeLists.txt')):
        if block(language) != (EXAMPLE / file).read_text():
            yield f'docs/porting.md shows another {file} than examples/without_ros has'
    output = subprocess.run([program], check=True, stdout=subprocess.PIPE, text=True).stdout
    if block('text') != output:
        yield f'docs/porting.md shows another output than\n{output}'
    with tempfile.TemporaryDirectory() as folder:
        configured = subprocess.run([cmake, '-S', EXAMPLE, '-B', folder], stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, text=True)
    if configured.returncode != 0:
        yield f'examples/without_ros cannot be configured alone:\n{configured.stdout}'
    for file in sorted((ROOT / 'src' / 'ros').glob('*.cpp')):
        knows = NODE_OR_CLOCK.search(file.read_text()) is not None
        if knows != (f'`{file.name}`' in DOCUMENT):
            yield (f'docs/porting.md should {"" if knows else "not "}name `{file.name}` as one '
                   'that knows a node or a clock')
    told = re.search(r'(\d+) occupied voxels and (\d+) inflated ones', DOCUMENT).groups()
    run = subprocess.run([fiimap_eval, 'run', ROOT / 'data' / 'synth_flight_excerpt.bag'],
                         check=True, stdout=subprocess.PIPE, text=True).stdout
    if 'occupied {}, inflated {} voxels'.format(*told) not in run:
        yield f'docs/porting.md tells of other voxels than\n{run}'


def main():
    sentences = list(wrong(*sys.argv[1:4]))
    print('\n'.join(sentences) or 'docs/porting.md and its example agree')
    sys.exit(bool(sentences))


if __name__ == '__main__':
    main()
