#!/usr/bin/python3
"""Counts with callgrind the instructions per frame of whole pipelines.

  benchmark/count_instructions.py FIIMAP_COMPARE --frames N --bag NAME=FILE [--bag ...]

Unlike times, these do not depend on what else the machine does. They say nothing of caches, and a
frame is one of the first N, when the map is still small.
"""
import argparse
import os
import re
import subprocess
import tempfile

# The slow baselines only where they end within a minute.
RUNS = [(0.2, ('fiimap', 'ego')), (0.1, ('fiimap', 'ego', 'octomap')), (0.05, ('fiimap', 'ego'))]
INTEGRATE = '*::integrate(fiimap::bench::Frame const&)'


def count(compare, bag, frames, method, resolution):
    """Instructions within the method's integrate(), all frames together."""
    with tempfile.TemporaryDirectory() as folder:
        result = subprocess.run(
            ['valgrind', '--tool=callgrind', f'--toggle-collect={INTEGRATE}',
             f'--callgrind-out-file={os.path.join(folder, "out")}', compare, '--frames',
             str(frames), '--bag', bag, '--run', method, '--resolution', str(resolution)],
            capture_output=True, text=True, check=False)
    collected = re.search(r'Collected\s*:\s*(\d+)', result.stderr)
    if result.returncode != 0 or not collected or int(collected.group(1)) == 0:
        raise SystemExit(f'{method} at {resolution} m: nothing was counted\n{result.stderr}')
    return int(collected.group(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('compare')
    parser.add_argument('--frames', type=int, default=10)
    parser.add_argument('--bag', action='append', required=True, help='NAME=FILE')
    arguments = parser.parse_args()
    print(f'\n### Instructions per frame, the first {arguments.frames} frames, millions\n')
    print('| recording | m | method | instructions | / fiimap |')
    print('| --- | --- | --- | --- | --- |')
    for bag in arguments.bag:
        for resolution, methods in RUNS:
            ours = None
            for method in methods:
                total = count(arguments.compare, bag, arguments.frames, method, resolution)
                ours = ours or total
                print(f'| {bag.split("=")[0]} | {resolution} | {method} | '
                      f'{total / arguments.frames / 1e6:.2f} | {total / ours:.1f}x |', flush=True)


if __name__ == '__main__':
    main()
