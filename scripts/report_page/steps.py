"""Runs the commands of fiimap_eval, each into a folder of its own, and remembers what is done."""
import hashlib
import json
import os
import pathlib
import shutil
import subprocess

KEY_FILE = 'key.json'
JSON_FILE = 'figures.json'
TEXT_FILE = 'output.txt'


class StepError(Exception):
    """A command failed; the text is for the user."""


def identity(path):
    """What tells one large file from another without reading it."""
    status = path.stat()
    return [str(path.resolve()), status.st_size, status.st_mtime_ns]


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


class Step:
    """One command of fiimap_eval.

    name: of the command and of its folder; arguments: after the recording; small_files: whose
    content matters (configuration, scene, split).
    """

    def __init__(self, name, arguments, small_files=()):
        self.name = name
        self.arguments = [str(a) for a in arguments]
        self.small_files = [pathlib.Path(f) for f in small_files]

    def key(self, program, bag):
        return {'program': identity(program), 'bag': identity(bag), 'arguments': self.arguments,
                'files': [digest(f) for f in self.small_files]}

    def folder(self, root):
        return root / self.name

    def is_done(self, program, bag, root):
        try:
            return json.loads((self.folder(root) / KEY_FILE).read_text()) == self.key(program, bag)
        except (OSError, ValueError):
            return False

    def run(self, program, bag, root):
        """Leaves a whole folder under the step's name, or none that was not there before."""
        partial = root / f'.{self.name}.partial'
        shutil.rmtree(partial, ignore_errors=True)
        partial.mkdir(parents=True)
        try:
            self._run_in(partial, program, bag)
            shutil.rmtree(self.folder(root), ignore_errors=True)
            partial.rename(self.folder(root))
        finally:
            shutil.rmtree(partial, ignore_errors=True)

    def _run_in(self, folder, program, bag):
        command = [str(program), self.name, str(bag.resolve()), *self.arguments, '--json',
                   JSON_FILE]
        result = subprocess.run(command, cwd=folder, text=True, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)
        if result.returncode != 0:
            errors = [line for line in result.stderr.splitlines() if line.startswith('error: ')]
            reason = errors[-1][len('error: '):] if errors else f'ended with {result.returncode}'
            raise StepError(f'{self.name}: {reason}')
        (folder / TEXT_FILE).write_text(result.stdout)
        (folder / KEY_FILE).write_text(json.dumps(self.key(program, bag)))

    def figures(self, root):
        return json.loads((self.folder(root) / JSON_FILE).read_text())

    def text(self, root):
        return (self.folder(root) / TEXT_FILE).read_text()


def write_whole(path, text):
    """The file appears under its name when it is complete."""
    partial = path.with_name(f'.{path.name}.partial')
    try:
        partial.write_text(text)
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)
