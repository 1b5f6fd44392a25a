"""A running program of a test."""
import os
import signal
import subprocess

# Nothing may take this long, also on a slow machine with other work; no test measures time.
PATIENCE = 90.0  # s


class Process:
    """A running program whose output is kept."""

    def __init__(self, command, log, environment=None):
        self.name = ' '.join(str(word) for word in command)
        self._log = log
        with open(log, 'wb') as output:
            self._popen = subprocess.Popen([str(word) for word in command], stdout=output,
                                           stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                           env={**os.environ, **(environment or {})})

    def is_running(self):
        return self._popen.poll() is None

    def output(self):
        return self._log.read_text(errors='replace')

    def wait(self):
        """Exit code; of a process that does not end: an assertion."""
        try:
            return self._popen.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.kill()
            raise AssertionError(f'{self.name} does not end')

    def send(self, signal_number):
        self._popen.send_signal(signal_number)

    def memory_mb(self):
        """Resident memory."""
        with open(f'/proc/{self._popen.pid}/statm') as file:
            return int(file.read().split()[1]) * os.sysconf('SC_PAGE_SIZE') * 1e-6

    def interrupt(self):
        """What Ctrl-C does. Returns the exit code."""
        if self.is_running():
            self._popen.send_signal(signal.SIGINT)
        return self.wait()

    def kill(self):
        self._popen.kill()
        self._popen.wait()
