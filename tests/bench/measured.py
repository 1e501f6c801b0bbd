# SPDX-License-Identifier: Apache-2.0
"""One run of a program: what it printed, its processor time and its memory. Results are kept by name, so that a run that was stopped goes on."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile


def run(command):
    """Standard output, seconds of processor time (user and system, all threads), MiB of the largest resident set."""
    with tempfile.TemporaryFile() as out:
        child = subprocess.Popen([str(word) for word in command], stdout=out, stdin=subprocess.DEVNULL)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            sys.exit(f'failed with {child.returncode}: {" ".join(str(word) for word in command)}')
        out.seek(0)
        return out.read().decode(), usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


class Store:
    """Results by name in FOLDER/figures.json. A name holds the commit, so another commit measures again.

    stored: nothing is measured; what is not known is None.
    """

    def __init__(self, folder, commit, stored=False):
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.file = self.folder / 'figures.json'
        self.commit = commit
        self.stored = stored
        self.known = json.loads(self.file.read_text()) if self.file.exists() else {}

    def get(self, name, make):
        name = f'{self.commit} {name}'
        if name not in self.known and not self.stored:
            print(name, file=sys.stderr, flush=True)
            self.known[name] = make()
            self.file.write_text(json.dumps(self.known, indent=1))
        return self.known.get(name)
