#!/usr/bin/python3
"""Changes the core's key lines one at a time and says which changes the core's tests notice.

  test/mutants/run.py FOLDER [WORD...]

FOLDER receives a copy of the core and its tests, and the build. WORD: only mutants whose lines or file
hold one of them. Exits with 1 when a mutant survives that mutants.txt does not explain, one that it
calls unnoticeable is noticed, or one does not fit the code or compile.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
COPIED = ('cmake', 'include', 'package.xml', 'src/core', 'src/tools', 'test/alone', 'test/core',
          'test/fuzz', 'test/soak', 'test/test_main.cpp')
# The quickest first: most mutants end there.
TESTS = ('core_config_test', 'core_geometry_test', 'core_projector_test', 'core_kernels_test',
         'core_edge_test', 'core_snapshot_test', 'core_mapper_test', 'core_scan_test',
         'core_grid_test', 'core_inflater_test')
TIMEOUT_S = 300.0


class Mutant:
    def __init__(self, file, original):
        self.file, self.original, self.changed, self.reason = file, original, None, None


def read_mutants():
    mutants, file = [], None
    for line in (ROOT / 'test/mutants/mutants.txt').read_text().splitlines():
        mark, text = line[:1], line[2:].strip()
        if mark == '@':
            file = text
        elif mark == '-':
            mutants.append(Mutant(file, text))
        elif mark == '+':
            mutants[-1].changed = text
        elif mark == '?':
            mutants[-1].reason = text
    return mutants


def run(command, folder, **options):
    """Exit code; that of a command that hangs is not 0."""
    try:
        return subprocess.run(command, cwd=folder, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, timeout=TIMEOUT_S, **options).returncode
    except subprocess.TimeoutExpired:
        return -1


def prepare(folder):
    for name in COPIED:
        target = folder / 'source' / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, target, dirs_exist_ok=True)
        else:
            shutil.copy2(ROOT / name, target)
    build = folder / 'build'
    subprocess.run(['cmake', '-S', folder / 'source/test/alone', '-B', build,
                    '-DCMAKE_BUILD_TYPE=None', '-DCMAKE_CXX_FLAGS=-O1'], check=True)
    subprocess.run(['cmake', '--build', build, '-j', str(os.cpu_count()), '--target', *TESTS],
                   check=True)
    return build


def first_failure(build):
    environment = dict(os.environ, FIIMAP_TEST_PERCENT='10')
    for test in TESTS:
        command = [build / 'core' / test, '--gtest_fail_fast']
        if run(command, build, env=environment) != 0:
            return test
    return None


def judge(mutant, folder, build):
    """One of 'killed by ...', 'survived', 'does not fit', 'does not compile'."""
    path = folder / 'source/src/core' / mutant.file
    code = path.read_text()
    if code.count(mutant.original) != 1:
        return 'does not fit'
    path.write_text(code.replace(mutant.original, mutant.changed))
    try:
        if run(['cmake', '--build', build, '--target', 'fiimap_core'], build) != 0:
            return 'does not compile'
        failure = first_failure(build)
        return f'killed by {failure}' if failure else 'survived'
    finally:
        path.write_text(code)


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    words = sys.argv[2:] or ['']
    build = prepare(folder)
    if first_failure(build):
        sys.exit('the tests fail without a mutant')
    counts, wrong = {}, 0
    for mutant in read_mutants():
        text = mutant.file + mutant.original + mutant.changed
        if not any(word in text for word in words):
            continue
        start = time.monotonic()
        verdict = judge(mutant, folder, build)
        expected = 'survived' if mutant.reason else 'killed'
        wrong += not verdict.startswith(expected)
        kind = verdict.split(' by ')[0] + (', explained' if mutant.reason else '')
        counts[kind] = counts.get(kind, 0) + 1
        print(f'{verdict:28} {time.monotonic() - start:5.0f} s  {mutant.file}: {mutant.changed}'
              + (f'  ({mutant.reason})' if mutant.reason else ''), flush=True)
    print(', '.join(f'{count} {kind}' for kind, count in sorted(counts.items())))
    sys.exit(1 if wrong else 0)


if __name__ == '__main__':
    main()
