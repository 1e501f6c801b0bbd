#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The preset `developer` of CMake builds what tools/test.sh builds: each file alone, with precompiled headers, in place of a dozen at once.

    developer_preset_test.py ROOT
"""
import json
import pathlib
import re
import sys


def main():
    root = pathlib.Path(sys.argv[1])
    presets = json.loads((root / 'CMakePresets.json').read_text(encoding='utf-8'))['configurePresets']
    preset = next(one['cacheVariables'] for one in presets if one['name'] == 'developer')
    script = (root / 'tools/test.sh').read_text(encoding='utf-8')
    configures = re.search(r'^cmake -S .*\\\n.*', script, re.M).group(0)
    wanted = {**dict(re.findall(r'-D(\w+)=(\w+)', configures)), 'SLF_WERROR': 'ON', 'SLF_PRECOMPILED': 'ON'}
    del wanted['CMAKE_UNITY_BUILD']
    if preset != wanted:
        sys.exit(f'the preset developer has {preset}, tools/test.sh -DSLF_WERROR=ON has {wanted}')


if __name__ == '__main__':
    main()
