# SPDX-License-Identifier: Apache-2.0
"""Builds the wheel with cmake, and the source distribution (PEP 517). No other package is needed to build.

The build folder is build/pip, or SLF_PIP_BUILD. SLF_CMAKE_ARGS: more arguments for cmake.
SLF_PIP_BUILT: a folder that was built with SLF_PYTHON, whose package is taken as it is.
"""
import base64
import hashlib
import io
import os
import pathlib
import re
import shlex
import subprocess
import sys
import sysconfig
import tarfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
# What compiling the package takes of the tree.
FOLDERS = ('attributes', 'base', 'bindings', 'bitstream', 'capture', 'codec', 'encoder', 'entropy', 'geometry', 'include',
           'lightfield', 'tools/cmake', 'web/dist')
FILES = ('CMakeLists.txt', 'LICENSE', 'README.md', 'CHANGELOG.md', 'pyproject.toml')
TAG = f'cp{sys.version_info.major}{sys.version_info.minor}'


def project():
    """The few values of pyproject.toml that the metadata has (no parser before Python 3.11)."""
    text = (ROOT / 'pyproject.toml').read_text(encoding='utf-8')
    return {key: re.search(rf'^{key} = "(.*)"$', text, re.M)[1]
            for key in ('name', 'version', 'description', 'requires-python', 'readme')}


def metadata():
    p = project()
    readme = (ROOT / p['readme']).read_text(encoding='utf-8')
    return (f'Metadata-Version: 2.1\nName: {p["name"]}\nVersion: {p["version"]}\n'
            f'Summary: {p["description"]}\nLicense: Apache-2.0\nLicense-File: LICENSE\nRequires-Python: {p["requires-python"]}\n'
            f'Requires-Dist: numpy\nDescription-Content-Type: text/markdown\n\n{readme}')


def platform():
    return sysconfig.get_platform().replace('-', '_').replace('.', '_')


def compiled():
    """The folder of the package, built."""
    if built := os.environ.get('SLF_PIP_BUILT'):
        return pathlib.Path(built) / 'python' / 'slf'
    build = pathlib.Path(os.environ.get('SLF_PIP_BUILD', ROOT / 'build' / 'pip'))
    subprocess.run(['cmake', '-S', str(ROOT), '-B', str(build), '-DCMAKE_BUILD_TYPE=Release',
                    '-DCMAKE_UNITY_BUILD=ON', '-DSLF_PYTHON=ON', '-DSLF_TESTS=OFF',
                    '-DSLF_BENCH=OFF', '-DSLF_TOOLS=OFF',
                    f'-DPYTHON_EXECUTABLE={sys.executable}',
                    *shlex.split(os.environ.get('SLF_CMAKE_ARGS', ''))], check=True)
    subprocess.run(['cmake', '--build', str(build), '--target', 'slf_python', '--parallel',
                    str(os.cpu_count() or 1)], check=True)
    return build / 'python' / 'slf'


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    p = project()
    info = pathlib.Path(metadata_directory) / f'{p["name"]}-{p["version"]}.dist-info'
    info.mkdir()
    (info / 'METADATA').write_text(metadata(), encoding='utf-8')
    return info.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    p = project()
    info = f'{p["name"]}-{p["version"]}.dist-info'
    files = {f'slf/{file.name}': file.read_bytes() for file in sorted(compiled().iterdir())
             if file.is_file()}
    files[f'{info}/METADATA'] = metadata().encode()
    files[f'{info}/LICENSE'] = (ROOT / 'LICENSE').read_bytes()
    files[f'{info}/WHEEL'] = ('Wheel-Version: 1.0\nGenerator: slf\nRoot-Is-Purelib: false\n'
                              f'Tag: {TAG}-{TAG}-{platform()}\n').encode()
    record = f'{info}/RECORD'
    lines = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b'=').decode()
        lines.append(f'{name},sha256={digest},{len(content)}')
    files[record] = ('\n'.join([*lines, f'{record},,']) + '\n').encode()
    wheel = f'{p["name"]}-{p["version"]}-{TAG}-{TAG}-{platform()}.whl'
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / wheel, 'w', zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), content)
    return wheel


def sources():
    """Files of a source distribution, by their names in the tree; git is not asked."""
    for name in FILES:
        yield name
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob('*')):
            hidden = any(part.startswith('.') or part == '__pycache__' for part in path.relative_to(ROOT).parts)
            if path.is_file() and not hidden:
                yield path.relative_to(ROOT).as_posix()


def build_sdist(sdist_directory, config_settings=None):
    p = project()
    top = f'{p["name"]}-{p["version"]}'

    def added(name, content):
        entry = tarfile.TarInfo(f'{top}/{name}')
        entry.size, entry.mode = len(content), 0o644
        archive.addfile(entry, io.BytesIO(content))

    with tarfile.open(pathlib.Path(sdist_directory) / f'{top}.tar.gz', 'w:gz', format=tarfile.PAX_FORMAT) as archive:
        added('PKG-INFO', metadata().encode())
        for name in sources():
            added(name, (ROOT / name).read_bytes())
    return f'{top}.tar.gz'
