#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Desktop programs know .slf files by their first bytes: file_type_test.py ROOT

Asks `file` with tools/desktop/slf.magic and `gio` with tools/desktop/slf.xml about the golden streams and about files that are
none. Exit code: 0 all as spec/media-type.md has it, 1 not, 77 neither program is there.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

TYPE = 'model/vnd.slf'


def said(*command, **environment):
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **environment}, check=True)
    return done.stdout


def by_magic(root, files):
    """Type of each file, by libmagic."""
    magic = root / 'tools/desktop/slf.magic'
    return said('file', '-b', '-m', magic, '--mime-type', *files).split('\n')[:len(files)]


def by_mime_database(root, files, work):
    """The same, by shared-mime-info."""
    packages = work / 'mime/packages'
    packages.mkdir(parents=True)
    shutil.copy(root / 'tools/desktop/slf.xml', packages)
    said('update-mime-database', work / 'mime')
    return [said('gio', 'info', '-a', 'standard::content-type', file, XDG_DATA_HOME=str(work)).split('content-type: ')[-1].strip()
            for file in files]


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    sound = sorted((root / 'conformance/streams').glob('*/stream.slf'))
    signature = root / 'conformance/refused/signature/stream.slf'
    wrong, asked = [], 0
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        nameless, other = work / 'nameless', work / 'other'
        shutil.copy(sound[0], nameless)
        shutil.copy(signature, other)
        if shutil.which('file'):
            asked += 1
            wrong += [f'file: {f} is {t}' for f, t in zip(sound, by_magic(root, sound)) if t != TYPE]
            wrong += [f'file: {t} for another signature' for t in by_magic(root, [other]) if t == TYPE]
            both = f"{root / 'tools/desktop/slf.magic'}:/usr/share/misc/magic"  # as after an entry in /etc/magic
            beside = said('file', '-b', '--mime-type', nameless, root / 'docs/pictures/can.png', MAGIC=both).split()
            system = pathlib.Path('/usr/share/misc/magic.mgc').exists()  # elsewhere `both` is not its list
            wrong += [f'file: {beside} beside the entries of the system'] if system and beside != [TYPE, 'image/png'] else []
            line = said('file', '-b', '-m', root / 'tools/desktop/slf.magic', nameless)
            version = '.'.join(map(str, nameless.read_bytes()[9:11]))
            if f'version {version}' not in line:
                wrong.append(f'file: no version {version} in {line}')
        if shutil.which('gio') and shutil.which('update-mime-database'):
            asked += 1
            types = by_mime_database(root, [nameless, sound[0], other], work)
            if types[:2] != [TYPE, TYPE] or types[2] == TYPE:
                wrong.append(f'gio: {types}')
    print('\n'.join(wrong) or f'{asked} programs know {len(sound)} streams')
    sys.exit(1 if wrong else 0 if asked else 77)


if __name__ == '__main__':
    main()
