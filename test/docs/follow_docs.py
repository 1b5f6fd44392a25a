#!/usr/bin/python3
"""Types the commands of README.md and docs/ as a newcomer would and says which of them fail.

  test/docs/follow_docs.py --list             checks that commands.yaml says of each what to do
  test/docs/follow_docs.py --devel FOLDER [FILE...]   runs them; FILE: only those of README.md, ...

FOLDER is what the build made to be sourced. Each command runs in a folder with the recordings that commands.yaml names.
Exits with 1 when a command fails, or when commands.yaml and the documents disagree.
"""
import argparse
import os
import pathlib
import re
import shlex
import signal
import socket
import subprocess
import sys
import tempfile
import time
import xmlrpc.client

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DOCUMENTS = ['README.md', 'CONTRIBUTING.md', *sorted(
    str(path.relative_to(ROOT)) for path in (ROOT / 'docs').glob('*.md'))]
BLOCK = re.compile(r'^```(\w*)\n(.*?)^```', re.DOTALL | re.MULTILINE)
# What a command begins with; other blocks are layouts, output and code.
PROGRAM = re.compile(r'^(\$ )?(scripts/|devel/|test/|roslaunch |rosrun |rosservice |rostopic |fiimap_|'
                     r'cd |git |mv |cp |config=|apt |sudo |catkin|dpkg|source )')
PATIENCE = 600.0    # s
STAYS_ALIVE = 3.0   # s that a node must live after it is there


def commands_of(document):
    """The commands of a document, without comments and line breaks."""
    found = []
    for language, block in BLOCK.findall((ROOT / document).read_text()):
        for line in block.replace('\\\n', ' ').splitlines():
            if language in ('', 'bash') and PROGRAM.match(line):
                text = re.sub(r'^\$ |\s+# .*$', '', line)
                found.append(' '.join(text.split()))
    return found


def read_plan():
    """What to do with each command: a list of dictionaries, as commands.yaml explains."""
    return yaml.safe_load((pathlib.Path(__file__).parent / 'commands.yaml').read_text())


def disagreements(plan):
    """Sentences about commands without an entry, and entries without a command."""
    written = {command for document in DOCUMENTS for command in commands_of(document)}
    planned = [entry['command'] for entry in plan['commands']]
    yield from (f'commands.yaml says nothing of: {c}' for c in sorted(written - set(planned)))
    yield from (f'no document has: {c}' for c in planned if c not in written)
    yield from (f'twice in commands.yaml: {c}' for c in sorted(
        {c for c in planned if planned.count(c) > 1}))


class Follower:
    """Runs commands on a screen of its own, each with a ROS master of its own."""

    def __init__(self, devel, folder):
        self.folder = folder
        with socket.socket() as free:
            free.bind(('localhost', 0))
            self.port = free.getsockname()[1]
        self.environment = {
            **os.environ, 'ROS_MASTER_URI': f'http://localhost:{self.port}',
            'ROS_HOSTNAME': 'localhost', 'ROS_HOME': str(folder / 'ros'), 'LIBGL_ALWAYS_SOFTWARE': '1'}
        self.setup = f'source {shlex.quote(str(devel))}/setup.bash && ' \
                     f'export PATH={shlex.quote(str(devel))}/lib/fiimap:$PATH && '
        self.screen = subprocess.Popen(['Xvfb', '-displayfd', '1', '-screen', '0', '800x600x24'],
                                       stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.environment['DISPLAY'] = ':' + self.screen.stdout.readline().decode().strip()

    def close(self):
        self.screen.terminate()
        self.screen.wait()

    def start(self, command, log):
        with open(log, 'wb') as output:
            # A session of its own, so that an interrupt reaches all that a command started.
            return subprocess.Popen(['bash', '-c', self.setup + 'exec ' + command], stdout=output,
                                    stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                    cwd=self.folder, env=self.environment, start_new_session=True)

    def node_is_there(self, name):
        try:
            master = xmlrpc.client.ServerProxy(self.environment['ROS_MASTER_URI'])
            return master.lookupNode('/follow_docs', name)[0] == 1
        except OSError:
            return False

    def run(self, command, node):
        """Runs a command to its end, or, with a node, until that has lived a while.

        Returns what went wrong, or None."""
        # Parameters of the command before, /use_sim_time for instance, go with its master.
        master = self.start(f'rosmaster --core -p {self.port}', self.folder / 'master.log')
        try:
            return self.run_with_master(command, node)
        finally:
            master.terminate()
            master.wait()

    def run_with_master(self, command, node):
        log = self.folder / 'command.log'
        process = self.start(command, log)
        end = time.monotonic() + PATIENCE
        try:
            if node:
                while process.poll() is None and not self.node_is_there(node):
                    if time.monotonic() > end:
                        return f'node {node} does not appear\n{log.read_text()}'
                    time.sleep(0.1)
                time.sleep(STAYS_ALIVE)
                if process.poll() is not None:
                    return f'ended before it was stopped\n{log.read_text()}'
                os.kill(process.pid, signal.SIGINT)
            code = process.wait(PATIENCE)
            output = log.read_text(errors='replace')
            if code != 0 or 'process has died' in output:
                return f'exit code {code}\n{output}'
        except subprocess.TimeoutExpired:
            return f'does not end\n{log.read_text()}'
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
        return None


def follow(plan, devel, documents):
    entries = {entry['command']: entry for entry in plan['commands']}
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name, source in plan['files'].items():
            (folder / name).symlink_to(ROOT / source)
        follower = Follower(devel.resolve(), folder)
        try:
            for document in documents:
                for command in commands_of(document):
                    entry = entries[command]
                    if 'skip' in entry:
                        print(f'-- {document}: {command}\n   not run: {entry["skip"]}')
                        continue
                    start = time.monotonic()
                    wrong = follower.run(entry.get('as', command), entry.get('node'))
                    failures += wrong is not None
                    print(f'{"FAILED" if wrong else "ok"} {document}: {command} '
                          f'({time.monotonic() - start:.0f} s)' + (f'\n{wrong}' if wrong else ''))
                    sys.stdout.flush()
        finally:
            follower.close()
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--list', action='store_true', help='check commands.yaml only')
    parser.add_argument('--devel', type=pathlib.Path, help='the folder with setup.bash')
    parser.add_argument('documents', nargs='*', metavar='FILE', default=DOCUMENTS)
    args = parser.parse_args()
    if args.list == bool(args.devel):
        parser.error('one of --list and --devel')
    for document in args.documents:
        if document not in DOCUMENTS:
            parser.error(f'{document} is none of {", ".join(DOCUMENTS)}')

    plan = read_plan()
    wrong = list(disagreements(plan))
    for sentence in wrong:
        print(sentence)
    if args.list or wrong:
        sys.exit(bool(wrong))
    failures = follow(plan, args.devel, args.documents)
    print(f'{failures} commands failed')
    sys.exit(bool(failures))


if __name__ == '__main__':
    main()
