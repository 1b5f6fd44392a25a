#!/usr/bin/python3
"""Checks an installed fiimap by what its users do.

  check_installed.py run SOURCE PREFIX      files, programs, launch files, a flight of the nodelets
  check_installed.py read SOURCE PREFIX     the planner of the README on the map of a recording

SOURCE is the folder of the package. The environment must be that of the installation; to read, that
of a workspace with the package fiimap_readme_planner. Exits with 1 and says what is wrong.
"""
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import xmlrpc.client

PROGRAMS = (
    'cow_trajectory --help', 'doctor --help', 'fiimap_cow_room --help', 'fiimap_eval parameters',
    'fiimap_eval report --help', 'fiimap_flights --help', 'flight_report --help', 'view --help')
OF_OTHER_PACKAGES = {'ego_planner.launch'}  # its planner is not ours
FLIGHT_PATIENCE_S = 300
MAP_PATIENCE_S = 120


def fail(text):
    sys.exit(f'check_installed: {text}')


def output_of(*command):
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if result.returncode != 0:
        fail(f'{" ".join(command)} failed with {result.returncode}:\n{result.stdout}')
    return result.stdout


def free_port():
    with socket.socket() as s:
        s.bind(('', 0))
        return str(s.getsockname()[1])


def check_files(source, prefix):
    share = pathlib.Path(output_of('rospack', 'find', 'fiimap').strip())
    if share != prefix / 'share' / 'fiimap':
        fail(f'fiimap is found in {share}, not under {prefix}')
    wanted = {prefix / 'include' / file.relative_to(source / 'include')
              for file in source.glob('include/**/*.h')}
    for folder in ('config', 'data', 'launch', 'msg', 'rviz', 'srv'):
        wanted.update(share / file.relative_to(source) for file in source.glob(f'{folder}/*'))
    wanted.add(share / 'nodelet_plugins.xml')
    missing = sorted(str(file) for file in wanted if not file.is_file())
    if missing:
        fail('not installed: ' + ', '.join(missing))
    if str(share / 'nodelet_plugins.xml') not in output_of(
            'rospack', 'plugins', '--attrib=plugin', 'nodelet'):
        fail('nodelet does not know our plugins')
    return share


def check_programs(share):
    for program in PROGRAMS:
        if len(output_of('rosrun', 'fiimap', *program.split()).split()) < 5:
            fail(f'{program} says nothing')
    output_of('rosmsg', 'show', 'fiimap/Statistics')
    for launch_file in sorted(share.glob('launch/*.launch')):
        if launch_file.name not in OF_OTHER_PACKAGES:
            nodes = output_of('roslaunch', 'fiimap', launch_file.name, '--nodes')
            if not nodes.startswith('/'):
                fail(f'{launch_file.name} starts no nodes: {nodes}')


def check_flight(folder):
    """Mapping, planner and simulator, loaded as nodelets, fly over a short way."""
    report = folder / 'flight.json'
    subprocess.run(
        ['roslaunch', '-p', free_port(), 'fiimap', 'demo.launch', 'rviz:=false',
         'simulated_time:=true', 'goal:=12 0 1.5', f'report:={report}'],
        stdout=subprocess.DEVNULL, stderr=subprocess.STDOUT, timeout=FLIGHT_PATIENCE_S)
    result = json.loads(report.read_text()) if report.is_file() else None
    if not result or not result['reached'] or result['scans'] < 10:
        fail(f'the flight did not reach its goal: {result}')
    return f'flight: {result["scans"]} scans, {result["path_length_m"]:.1f} m'


def obstacles_seen(master):
    """What the planner has said so far: (obstacles, missed)."""
    try:
        values = [master.getParam('/check', f'/planner/{name}') for name in ('obstacles', 'missed')]
    except OSError:
        return 0, 0  # no master yet
    return tuple(value if code == 1 else 0 for code, _, value in values)


def check_map(source, folder):
    """The planner of the README sees the sample recording's obstacles, all of them."""
    port = free_port()
    log = folder / 'sample.log'
    with open(log, 'w') as file:
        launch = subprocess.Popen(
            ['roslaunch', '-p', port, str(source / 'test/packaging/sample.launch')],
            stdout=file, stderr=subprocess.STDOUT)
    master = xmlrpc.client.ServerProxy(f'http://localhost:{port}')
    end = time.monotonic() + MAP_PATIENCE_S
    obstacles = missed = 0
    try:
        while obstacles < 1000 and time.monotonic() < end and launch.poll() is None:
            time.sleep(1)
            obstacles, missed = obstacles_seen(master)
    finally:
        launch.send_signal(signal.SIGINT)
        launch.wait()
    if obstacles < 1000 or missed:
        fail(f'the planner sees {obstacles} obstacles and misses {missed}:\n{log.read_text()}')
    return f'map: {obstacles} obstacles'


def main():
    source, prefix = (pathlib.Path(argument).resolve() for argument in sys.argv[2:4])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        os.environ.update(ROS_HOME=str(folder / 'ros'), ROS_HOSTNAME='localhost')
        share = check_files(source, prefix)
        if sys.argv[1] == 'run':
            check_programs(share)
            print('check_installed:', check_flight(folder), flush=True)
        else:
            print('check_installed:', check_map(source, folder), flush=True)


if __name__ == '__main__':
    main()
