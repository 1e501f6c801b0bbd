#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Parameters of tests print as names, not as bytes: who reads that one has failed knows which.

    named_parameters_test.py BUILD_TESTS        the folder of CTestTestfile.cmake
"""
import pathlib
import re
import sys


def main():
    folder = pathlib.Path(sys.argv[1])
    programs = re.findall(r'include\("[^"]*/([^"/]+)_include\.cmake"\)', (folder / 'CTestTestfile.cmake').read_text())
    lists = [folder / f'{program}_tests.cmake' for program in programs]
    lists = [path for path in lists if path.exists()]           # what is not built has none
    wrong = [re.sub(r'\W.*', '', path.name) for path in lists if 'byte object <' in path.read_text()]
    print(*[f'{name}: a parameter has no PrintTo' for name in wrong], f'{len(lists)} programs, {len(wrong)} wrong', sep='\n')
    sys.exit(1 if wrong or not lists else 0)


if __name__ == '__main__':
    main()
