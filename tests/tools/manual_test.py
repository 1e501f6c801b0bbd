# SPDX-License-Identifier: Apache-2.0
"""Man pages are whole: every section, headings in words, examples whose options there are.

    manual_test.py PROGRAM MANUAL_PY
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM, MANUAL = sys.argv[1:3]
sys.path.insert(0, str(pathlib.Path(MANUAL).parent))
import manual_texts  # noqa: E402


class ManualTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, MANUAL, PROGRAM, folder], check=True)
            cls.pages = {page.stem: page.read_text(encoding='utf-8') for page in pathlib.Path(folder).glob('*.1')}

    def test_every_page_has_the_sections_that_readers_look_for(self):
        self.assertGreater(len(self.pages), 14)
        for name, page in self.pages.items():
            headings = re.findall(r'^\.SH (.*)$', page, re.M)
            for section in ('NAME', 'SYNOPSIS', 'DESCRIPTION', 'OPTIONS', 'EXIT STATUS', 'EXAMPLES', 'SEE ALSO'):
                self.assertIn(section, headings, name)
            self.assertEqual(len(headings), len(set(headings)), name)
            for heading in headings:
                self.assertRegex(heading.replace('\\-', '-'), r"^[A-Z][A-Z' -]*$", name)
            self.assertNotIn('POSITIONALS', headings)
            for section in page.split('\n.SH ')[1:]:
                self.assertIn('\n', section.strip(), f'{name}: an empty section')

    def test_exit_statuses_are_those_of_the_help(self):
        text = subprocess.run([PROGRAM, '--help'], check=True, capture_output=True, text=True).stdout
        wanted = re.findall(r'(\d+) [a-z]', text[text.index('Exit codes:'):])
        for name, page in self.pages.items():
            section = page[page.index('.SH EXIT STATUS'):page.index('.SH EXAMPLES')]
            self.assertEqual(re.findall(r'^\.B (\d+)$', section, re.M), wanted, name)

    def test_examples_are_of_their_page_and_have_options_that_there_are(self):
        for verb, examples in manual_texts.EXAMPLES.items():
            self.assertTrue(any(verb in ('slf', command.split()[1]) for command, _ in examples), verb)
            for command, what in examples:
                self.assertIn(command.replace('-', '\\-'), self.pages['slf' if verb == 'slf' else f'slf-{verb}'])
                self.assertFalse(what.endswith('.'))
                words = command.split()
                text = subprocess.run([PROGRAM, words[1], '--help'], check=True, capture_output=True, text=True).stdout
                for option in [word for word in words if re.match('--?[a-z]', word)]:
                    self.assertRegex(text, rf'(?m)^ +(\S+,)?{option}[ ,]', command)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
