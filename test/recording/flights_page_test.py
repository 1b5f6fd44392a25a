#!/usr/bin/python3
"""The page of simulated flights that `fiimap_eval report --flights` writes."""
import json
import pathlib
import tempfile
import unittest

from report_test import PageReader, look_up, run_report


def flight(settings, histogram, **values):
    """As fiimap_flights writes it; histogram: of clearances in steps of 0.1 m."""
    return {'settings': settings, 'clearance_bin_m': 0.1, 'clearance_histogram': histogram,
            'reached': True, 'collisions': 0, 'least_clearance_m': 0.3, 'seconds': 10.0,
            'path_length_m': 20.0, 'mapping_cpu_share': 0.05, 'planning_cpu_share': 0.02,
            'simulation_cpu_share': 0.3, **values}


# Of the first kind 20 clearances: one below 0.1 m, nine below 0.3 m, the others below 0.4 m.
NOISE = [flight(['planner.layer=raw'], [1, 0, 4, 5]),
         flight(['planner.layer=raw'], [0, 0, 4, 6], reached=False, collisions=2,
                least_clearance_m=0.1, seconds=20.0, mapping_cpu_share=0.07),
         flight(['planner.layer=inflated'], [0, 0, 0, 0, 10])]
EXACT = [flight([], [0, 5, 5])]


class FlightsPageTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.output = self.folder / 'out'

    def write(self, name, flights):
        path = self.folder / name
        path.write_text(flights if isinstance(flights, str) else json.dumps(flights))
        return path

    def report(self, *files):
        flights = [part for file in files for part in ('--flights', file)]
        return run_report(*flights, '-o', self.output)

    def test_shows_every_kind_of_flight(self):
        result = self.report(f'noise={self.write("noise.json", NOISE)}',
                             f'exact={self.write("exact.json", EXACT)}')
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.split(), [str(self.output / 'flights.html')])
        page = PageReader((self.output / 'flights.html').read_text())
        self.assertEqual((page.open_tags, page.links), ([], []))
        self.assertTrue(any('Figure 5' in heading for heading in page.headings))
        self.assertTrue(page.images[0].startswith('data:image/png;base64,'))
        figures = json.loads(page.figures)
        self.assertEqual([(row['name'], row['settings']) for row in figures['flights']],
                         [('noise', 'layer=raw'), ('noise', 'layer=inflated'), ('exact', '')])
        for key, digits, text in page.numbers:
            self.assertEqual(text, format(look_up(figures, key), digits), key)
        shown = {key for key, _, _ in page.numbers}
        for key in ('least_clearance_m', 'nearest_half_m', 'collided', 'mapping', 'planning'):
            self.assertIn(f'flights.2.{key}', shown)

    def test_figures_are_those_of_all_flights_of_a_kind(self):
        self.report(f'noise={self.write("noise.json", NOISE)}')
        page = PageReader((self.output / 'flights.html').read_text())
        raw, inflated = json.loads(page.figures)['flights']
        counts = [raw[key] for key in ('flights', 'reached', 'collided')]
        self.assertEqual(counts, [2, 1, 1])
        self.assertEqual((raw['least_clearance_m'], raw['median_of_least_m']), (0.1, 0.2))
        self.assertAlmostEqual(raw['nearest_5_percent_m'], 0.1)
        self.assertAlmostEqual(raw['nearest_half_m'], 0.4)
        self.assertAlmostEqual(raw['seconds'], 15.0)
        self.assertAlmostEqual(raw['mapping'], 6.0)
        self.assertAlmostEqual(inflated['nearest_5_percent_m'], 0.5)

    def test_bad_input_ends_with_one_sentence(self):
        incomplete = [{'settings': []}]
        for argument, words in [
                ('noise', 'must be NAME=FILE'), ('noise=no_such_file', 'No such file'),
                (f'a={self.write("text", "no JSON")}', 'is not what fiimap_flights --json writes'),
                (f'a={self.write("half", incomplete)}', 'is not what fiimap_flights --json writes'),
                (f'a={self.write("none", [])}', 'holds no flight')]:
            with self.subTest(argument):
                result = self.report(argument)
                self.assertNotEqual(result.returncode, 0)
                self.assertEqual(result.stderr.count('\n'), 1, result.stderr)
                self.assertIn('error: ', result.stderr)
                self.assertIn(words, result.stderr)
                self.assertFalse(self.output.exists())

    def test_asks_for_something_to_report(self):
        result = run_report('-o', self.output)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn('error: there must be a recording or --flights', result.stderr)


if __name__ == '__main__':
    unittest.main()
