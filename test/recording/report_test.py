#!/usr/bin/python3
"""The page of `fiimap_eval report`, read as a browser would."""
import base64
import html.parser
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

SOURCE = pathlib.Path(__file__).resolve().parents[2]
FLIGHT = SOURCE / 'data' / 'synth_flight_excerpt.bag'
QUICK = ['--resolutions', '0.4', '--folds', '2', '--reaches', '1', '2', '--seconds', '0.3']
PNG_MAGIC = b'\x89PNG\r\n\x1a\n'
EVAL = sys.argv.pop(1) if len(sys.argv) > 1 else ''


def run_report(*arguments):
    return subprocess.run([EVAL, 'report', *map(str, arguments)], text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)


class PageReader(html.parser.HTMLParser):
    """Numbers by their key, images, links to anything outside, embedded figures."""

    def __init__(self, text):
        super().__init__()
        self.numbers, self.images, self.links, self.headings = [], [], [], []
        self.figures, self.open_tags, self.attributes = '', [], {}
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        if tag == 'img':
            self.images.append(attributes['src'])
        self.links += [attributes[a] for a in ('href', 'src') if a in attributes and tag != 'img']
        if tag not in ('img', 'meta', 'link', 'br'):
            self.open_tags.append(tag)
        self.attributes = attributes

    def handle_endtag(self, tag):
        if self.open_tags.pop() != tag:
            raise ValueError(f'</{tag}> closes something else')

    def handle_data(self, data):
        tag = self.open_tags[-1] if self.open_tags else ''
        if tag == 'td' and 'data-key' in self.attributes:
            self.numbers.append((self.attributes['data-key'], self.attributes['data-format'], data))
        elif tag == 'h2':
            self.headings.append(data)
        elif tag == 'script':
            self.figures += data


def look_up(data, key):
    for part in key.split('.'):
        data = data[int(part)] if isinstance(data, list) else data[part]
    return data


def pixels_of(png):
    """Decodes far enough to know that the picture is whole: its size and its bytes."""
    assert png.startswith(PNG_MAGIC)
    position, size, packed = len(PNG_MAGIC), None, b''
    while position < len(png):
        length, kind = struct.unpack('>I4s', png[position:position + 8])
        body = png[position + 8:position + 8 + length]
        if zlib.crc32(kind + body) != struct.unpack('>I', png[position + 8 + length:][:4])[0]:
            raise ValueError('damaged')
        if kind == b'IHDR':
            size = struct.unpack('>II', body[:8])
        if kind == b'IDAT':
            packed += body
        position += 12 + length
    return size, zlib.decompress(packed)


class ReportTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.output = pathlib.Path(cls.folder.name) / 'out'
        cls.result = run_report(FLIGHT, '-o', cls.output, '--set', 'resolution=0.2', *QUICK)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def page(self):
        self.assertEqual(self.result.returncode, 0, self.result.stderr)
        return PageReader((self.output / 'synth_flight_excerpt.html').read_text())

    def test_has_every_chapter_and_is_well_formed(self):
        page = self.page()
        self.assertEqual(page.open_tags, [])
        for word in ('Input', 'Map', 'Accuracy', 'Figure 6', 'Figures 7', 'exact scene',
                     'Configuration'):
            self.assertTrue(any(word in heading for heading in page.headings), word)

    def test_needs_nothing_from_outside(self):
        page = self.page()
        self.assertEqual(page.links, [])
        for image in page.images:
            self.assertTrue(image.startswith('data:image/png;base64,'), image[:40])

    def test_images_are_whole_and_show_something(self):
        images = self.page().images
        self.assertGreaterEqual(len(images), 12)
        for image in images:
            (width, height), pixels = pixels_of(base64.b64decode(image.split(',')[1]))
            self.assertGreater(width, 300)
            self.assertGreater(height, 100)
            self.assertGreater(len(set(pixels)), 16, 'one colour only')

    def test_numbers_equal_those_of_the_commands(self):
        page = self.page()
        files = {f.parent.name: json.loads(f.read_text())
                 for f in self.output.glob('synth_flight_excerpt/*/figures.json')}
        self.assertEqual(set(files), {'health', 'run', 'accuracy', 'sweep', 'compare', 'truth'})
        self.assertEqual(json.loads(page.figures), files)
        self.assertGreater(len(page.numbers), 150)
        for key, digits, text in page.numbers:
            value = look_up(files, key)
            shown = 'never' if value is None else (
                value if isinstance(value, str) else format(value, digits))
            self.assertEqual(text, shown, key)

    def test_numbers_are_of_this_recording(self):
        figures = json.loads(self.page().figures)
        self.assertEqual(figures['run']['integrated'], 110)
        self.assertEqual(figures['run']['mismatches'], 0)
        self.assertGreater(figures['run']['verified'], 1)
        self.assertEqual(figures['accuracy']['results'][0]['held_out_scans'], 110)
        self.assertGreater(figures['truth']['results'][0]['free_recall'], 0.9)
        self.assertEqual(figures['compare']['parameters']['resolution'], '0.2')

    def test_resumes_where_nothing_changed(self):
        figures = self.output / 'synth_flight_excerpt' / 'truth' / 'figures.json'
        before = figures.stat().st_mtime_ns
        again = run_report(FLIGHT, '-o', self.output, '--set', 'resolution=0.2', *QUICK)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(again.stderr.count('up to date'), 6, again.stderr)
        self.assertEqual(before, figures.stat().st_mtime_ns)


if __name__ == '__main__':
    unittest.main()
