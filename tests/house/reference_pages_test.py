# SPDX-License-Identifier: Apache-2.0
"""The reference of Python and JavaScript has every public name, and says something of it.

    reference_pages_test.py ROOT
"""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(ROOT / 'tools/site'))
import reference_pages  # noqa: E402


class ReferencePagesTest(unittest.TestCase):
    def test_every_name_of_the_package_has_words(self):
        page = reference_pages.python_page(ROOT)
        listed = re.search(r'__all__ = \[(.*?)\]', (ROOT / 'bindings/python/slf/__init__.py').read_text(encoding='utf-8'), re.S)[1]
        names = [name for name in re.findall(r"'(\w+)'", listed) if not name.startswith('__')]
        self.assertGreater(len(names), 20)
        for name in names:
            section = page.partition(f'\n## {name}\n')[2].partition('\n## ')[0]
            self.assertGreater(len(section.split()), 3, name)
        self.assertIn('### LightField.radiance', page)
        self.assertIn('* `metres_per_unit: float`: 0: not known', page)
        self.assertNotIn('self', re.findall(r'^`\w+\((.*?)[,)]', page, re.M))

    def test_every_export_is_there_with_all_its_members(self):
        page = reference_pages.javascript_page(ROOT)
        for module, file in [(module, file) for module, files in reference_pages.DECLARATIONS.items() for file in files]:
            text = (ROOT / file).read_text(encoding='utf-8')
            for name in re.findall(r'^export (?:class|interface|type|function|const) (\w+)', text, re.M):
                self.assertIn(f'\n### {name}\n', page, module)
        for member in ('static create(options?: SlfParts): Promise<SlfDecoder>', 'readonly bitOffset: number', 'maxWork?: number',
                       'toggleRoom(kind: \'vr\' | \'ar\'): Promise<void>', 'xrend: CustomEvent<{ mode: \'immersive-vr\' | \'immersive-ar\' }>'):
            self.assertIn(f'* `{member}`', page)
        self.assertNotIn('/**', page)
        self.assertNotIn('private', page)
        self.assertIn('\n## slf-decoder/worker\n', page)
        self.assertEqual(1, page.count('\n### SlfInfo\n'))


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
