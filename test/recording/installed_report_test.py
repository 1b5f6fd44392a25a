#!/usr/bin/python3
"""`fiimap_eval report` where `cmake --install` put it: its scripts and libraries are all there."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else pathlib.Path('build')
QUICK = ['--resolutions', '0.4', '--folds', '2', '--reaches', '1', '--seconds', '0.1']


class InstalledReportTest(unittest.TestCase):
    def test_makes_a_page_from_an_installed_recording(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            prefix = root / 'prefix'
            subprocess.run(['cmake', '--install', BUILD, '--prefix', prefix], check=True,
                           stdout=subprocess.DEVNULL)
            programs, share = prefix / 'lib' / 'fiimap', prefix / 'share' / 'fiimap'
            libraries = [str(prefix / 'lib'), os.environ.get('LD_LIBRARY_PATH', '')]
            result = subprocess.run(
                [programs / 'fiimap_eval', 'report', share / 'data' / 'cow_and_lady_excerpt.bag',
                 '-o', 'pages', '--config', share / 'config' / 'cow_and_lady.yaml', *QUICK],
                cwd=root, env={**os.environ, 'LD_LIBRARY_PATH': ':'.join(libraries)}, text=True,
                stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.assertEqual(result.returncode, 0, result.stderr)
            page = (root / 'pages' / 'cow_and_lady_excerpt.html').read_text()
        version = re.search('<version>(.*)</version>', (SOURCE / 'package.xml').read_text())[1]
        self.assertIn(f'fiimap {version}', page)
        self.assertGreater(page.count('data:image/png'), 8)


if __name__ == '__main__':
    unittest.main()
