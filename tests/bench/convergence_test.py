#!/usr/bin/env python3
"""The benchmark's own arithmetic against known answers. Needs numpy.

usage: python3 -m unittest discover -s tests/bench -p 'convergence_test.py'
"""
import re
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from types import SimpleNamespace

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
import errors
import methods
import mitsuba_to_luxcore
import page
import results

SIZE = 96
NOISE, BIAS, TRUTH_NOISE, SEEDS = .03, .02, .05, 4  # the truth's noise is the largest: not taken out, it shows


def exact():
    y, x, c = np.mgrid[:SIZE, :SIZE, :3] / SIZE
    return .2 + x + .5 * y * (c + 1)


def noisy_truth(random):
    halves = tuple(exact() + TRUTH_NOISE * random.standard_normal(exact().shape) for _ in range(2))
    return errors.Truth((halves[0] + halves[1]) / 2, halves)


def pictures(random, noise=NOISE, bias=BIAS, seeds=SEEDS):
    return [exact() + bias + noise * random.standard_normal(exact().shape) for _ in range(seeds)]


def made(path_class='whole', method='render', budget=10., cpu=10., error=1e-3, digest='same'):
    figure = dict(error=error, error_sem=error / 10, truth_noise=0, variance=None, bias2=None, bias2_sem=None)
    return {'scene': 'oracle/pool', 'class': path_class, 'method': method, 'budget': budget, 'digest': digest,
            'cpu': [cpu], 'figure': 'relMSE', 'relMSE': figure, 'norm': figure, 'ratio': 1., 'not_finite': 0,
            'pixels': 1, 'corrected': True}


class Errors(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(7)
        self.truth = noisy_truth(self.random)
        self.weight = 1 / (exact() ** 2 + errors.DARK)

    def assertWithin(self, found, expected, sem):
        self.assertLess(abs(found - expected), 4 * sem, f'found {found}, expected {expected} +- {sem}')

    def test_known_noise_and_bias_are_recovered_apart(self):
        for noise, bias in ((NOISE, 0), (0, BIAS), (NOISE, BIAS)):
            found = errors.figures(pictures(self.random, noise, bias), self.truth)
            for name, mean_weight in (('relMSE', self.weight.mean()), ('norm', 1 / (exact() ** 2).mean())):
                with self.subTest(noise=noise, bias=bias, figure=name):
                    f, tolerance = found[name], .02  # of the weights, which the truth's noise changes a little
                    self.assertWithin(f['error'], (noise ** 2 + bias ** 2) * mean_weight,
                                      f['error_sem'] + tolerance * noise ** 2 * mean_weight)
                    self.assertWithin(f['bias2'], bias ** 2 * mean_weight, f['bias2_sem'])
                    expected = noise ** 2 * mean_weight
                    self.assertAlmostEqual(f['variance'], expected, delta=.03 * expected + 1e-12)

    def test_error_is_the_sum_of_variance_and_bias(self):
        found = errors.figures(pictures(self.random), self.truth)
        for name in ('relMSE', 'norm'):
            self.assertAlmostEqual(found[name]['error'], found[name]['variance'] + found[name]['bias2'], places=12)

    def test_the_standard_error_is_that_of_repeated_measurements(self):
        repeated = [errors.figures(pictures(self.random), noisy_truth(self.random)) for _ in range(60)]
        for name in ('error', 'bias2'):
            for figure, at_most in (('norm', 1.35), ('relMSE', 10)):  # relMSE: too large, for its weights are uneven
                spread = np.std([r[figure][name] for r in repeated], ddof=1)
                ratio = np.mean([r[figure][f'{name}_sem'] for r in repeated]) / spread
                self.assertTrue(.7 < ratio < at_most, f'{figure} {name}: {ratio}')

    def test_without_halves_the_noise_of_the_truth_is_in_the_error(self):
        found = errors.figures(pictures(self.random), errors.Truth(self.truth.mean))
        self.assertFalse(found['corrected'])
        expected = (NOISE ** 2 + BIAS ** 2 + TRUTH_NOISE ** 2 / 2) / (exact() ** 2).mean()
        self.assertAlmostEqual(found['norm']['error'] / expected, 1, delta=.03)

    def test_a_mask_keeps_the_rest_out(self):
        mask = np.zeros((SIZE, SIZE), bool)
        mask[10:50, 20:70] = True
        spoilt = pictures(self.random, noise=0)
        for p in spoilt:
            p[~mask] += 100
        found = errors.figures(spoilt, self.truth, mask)
        self.assertEqual(found['pixels'], 2000)
        self.assertWithin(found['norm']['error'], BIAS ** 2 / (exact()[mask] ** 2).mean(), found['norm']['error_sem'])

    def test_one_seed_tells_no_variance(self):
        found = errors.figures(pictures(self.random, seeds=1), self.truth)
        self.assertIsNone(found['relMSE']['variance'])
        self.assertIsNone(found['relMSE']['bias2'])

    def test_pixels_that_are_not_finite_are_counted(self):
        spoilt = pictures(self.random, seeds=1)
        spoilt[0][3, 4] = np.nan
        found = errors.figures(spoilt, self.truth)
        self.assertEqual(found['not_finite'], 1)
        self.assertTrue(np.isfinite(found['relMSE']['error']))

    def test_a_larger_picture_is_averaged(self):
        small = np.arange(2 * 3 * 3, dtype=float).reshape(2, 3, 3)
        np.testing.assert_array_equal(errors.box_average(small.repeat(4, 0).repeat(4, 1), 2), small)


class TimeToReach(unittest.TestCase):
    def setUp(self):
        self.rows = [made(cpu=t, error=1 / t) for t in (3., 30., 300.)]

    def test_between_measurements_it_is_read_off_in_log_log(self):
        sign, seconds = results.time_to_reach(self.rows, 1 / 100)
        self.assertEqual(sign, '')
        self.assertAlmostEqual(seconds, 100)

    def test_outside_it_says_so(self):
        self.assertEqual(results.time_to_reach(self.rows, 1), ('<', 3.))
        self.assertEqual(results.time_to_reach(self.rows, 1e-6), ('>', 300.))


class Compare(unittest.TestCase):
    def test_ratios_are_new_over_old(self):
        old = [made(budget=b, cpu=b, error=1 / b) for b in (10., 40.)]
        new = [made(budget=b, cpu=1.1 * b, error=.25 / b) for b in (10., 40.)]
        compared, left = results.ratios(old, new)
        self.assertEqual(left, [])
        for r in compared:
            self.assertAlmostEqual(r['error'], .25)
            self.assertAlmostEqual(r['cpu'], 1.1)
            self.assertAlmostEqual(r['sem'], .25 * .1 * 2 ** .5)
        self.assertEqual([r['speed'] for r in compared], [None, 40 / 11])  # the first lies before all that was measured

    def test_geometric_means_weigh_a_gain_as_a_loss(self):
        self.assertAlmostEqual(results.geometric_mean([.5, 2]), 1)
        old = [made(method=m) for m in ('render', 'path')]
        new = [made(method='render', error=5e-4), made(method='path', error=2e-3)]
        report = results.compare_report(dict(rows=old), dict(rows=new))
        self.assertRegex(report, r'(?m)^all +all +2 +1\.000 +1\.000')

    def test_what_is_in_one_only_or_differs_is_listed(self):
        old = [made(), made(budget=3.), made(method='path', digest='other')]
        _, left = results.ratios(old, [made(), made(method='path')])
        self.assertEqual({(key[2], key[3]): why for key, why in left},
                         {('render', 3.): 'only in the old', ('path', 10.): 'scene, truth or mask differ'})


class Report(unittest.TestCase):
    def rows(self):
        rows = [made(path_class=c, method=m, budget=b, cpu=b, error=e / b)
                for c in ('whole', 'alone LS+DE', 'alone L[DS]?E')
                for m, e in (('render', 1), ('path & co', 5)) for b in (3., 10.)]
        rows[0]['relMSE'] = rows[0]['relMSE'] | dict(variance=.3, bias2=-1e-5, bias2_sem=1e-4)
        return rows

    def test_a_single_plot_is_well_formed_and_shows_each_method_once(self):
        result = dict(rows=self.rows(), seeds=1, program='0' * 64, left_out=[])
        scene, path_class = next(iter(results.charts(result['rows'])))
        shown = results.charts(result['rows'])[scene, path_class]
        svg = ElementTree.fromstring(page.picture(result, scene, path_class, 'glass & light'))
        names = [t.text for t in svg.iter('{http://www.w3.org/2000/svg}tspan')]
        self.assertEqual(names, list(shown))
        self.assertEqual(len(list(svg.iter('{http://www.w3.org/2000/svg}polyline'))), len(shown))
        with self.assertRaisesRegex(KeyError, 'no such scene.*expected one of'):
            page.picture(result, 'no such scene', path_class, '')

    def test_the_page_is_well_formed_and_needs_nothing_else(self):
        html = page.page(dict(rows=self.rows(), seeds=1, program='0' * 64, left_out=[['a', 'b', '<c>']]))
        plots = re.findall(r'<svg.*?</svg>', html, re.S)
        self.assertEqual(len(plots), 1 + 3)
        for plot in plots:
            ElementTree.fromstring(plot)
        self.assertNotIn('http', html)
        self.assertIn('&lt;c&gt;', html)

    def test_a_figure_below_its_noise_is_shown_as_a_limit(self):
        self.assertEqual(page.at_most(-1e-5, 1e-4), (2e-4, True))
        self.assertEqual(page.at_most(1e-3, 1e-4), (1e-3, False))

    def test_the_yardstick_divides_equal_budgets(self):
        rows = self.rows()
        rows[-1]['relMSE'] = rows[-1]['relMSE'] | dict(error=.25)
        _, lines = results.yardstick(rows)
        self.assertEqual([line[4] for line in lines], ['1.00', '1.00', '1.00', '2.00'])


class Methods(unittest.TestCase):
    SCENE = SimpleNamespace(glb=Path('scene.glb'), mitsuba=None)

    def run_python(self, code):
        method = methods.Method(f"{{python}} -c '{code}' {{picture}}")
        with tempfile.TemporaryDirectory() as folder:
            return methods.run(method, self.SCENE, 'lsde', 5, 1, Path(folder))

    def test_cpu_seconds_are_those_of_the_child(self):
        run = self.run_python('import sys, time\nwhile time.process_time() < .3: pass\nopen(sys.argv[1], "w")')
        self.assertGreaterEqual(run.cpu, .29)

    def test_a_failure_is_one_line(self):
        with self.assertRaisesRegex(methods.RunError, 'exit code 3: no light'):
            self.run_python('import sys\nprint("warning: x\\nno light", file=sys.stderr)\nsys.exit(3)')
        with self.assertRaisesRegex(methods.RunError, 'no picture'):
            self.run_python('pass')


class MitsubaToLuxcore(unittest.TestCase):
    SENSOR = '''<sensor type="perspective"><string name="fov_axis" value="y"/><float name="fov" value="40"/>
        <transform name="to_world"><matrix value="-1 0 0 1 0 0 -1 5 0 -1 0 2 0 0 0 1"/></transform>
        <film type="hdrfilm"><integer name="width" value="$w"/><integer name="height" value="100"/><rfilter type="box"/>
        </film></sensor>'''
    GLASS = '<bsdf type="dielectric"><float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/></bsdf>'
    MEDIUM = '''<medium name="interior" type="homogeneous"><rgb name="sigma_t" value="1 2 3"/>
        <float name="scale" value="2"/><float name="albedo" value="0"/></medium>'''

    def translate(self, scene):
        return mitsuba_to_luxcore.translate(f'<scene><default name="w" value="200"/>{self.SENSOR}{scene}</scene>')

    def shape(self, inside):
        found = self.translate(f'<shape type="ply" id="it"><string name="filename" value="it.ply"/>{inside}</shape>')
        return {name.replace('.shape2', ''): value for name, value in found.properties.items()}, found

    def test_the_camera_looks_down_with_a_row_less(self):
        found = self.translate('')
        camera = {name.removeprefix('scene.camera.'): value for name, value in found.properties.items()}
        self.assertEqual((found.width, found.height), (200, 100))
        self.assertEqual(camera['lookat.orig'], [1, 5, 2])
        self.assertEqual(camera['lookat.target'], [1, 4, 2])
        self.assertEqual(camera['up'], [0, 0, -1])
        self.assertEqual(camera['fieldofview'], 40)
        np.testing.assert_allclose(camera['screenwindow'], [-2, 2, -1.02, .98])

    def test_glass_absorbs_in_its_medium(self):
        properties, found = self.shape(self.GLASS + self.MEDIUM)
        self.assertEqual(properties['scene.materials.type'], 'glass')
        self.assertEqual(properties['scene.materials.interiorior'], 1.5)
        self.assertEqual(properties['scene.materials.volume.interior'], 'shape2_inside')
        self.assertEqual(properties['scene.volumes_inside.absorption'], [2, 4, 6])
        self.assertEqual(properties['scene.volumes_inside.ior'], 1.5)
        self.assertTrue(found.caustics)

    def test_lights_keep_their_units(self):
        lamp = '<emitter type="area"><rgb name="radiance" value="7"/></emitter>'
        properties, found = self.shape(f'<bsdf type="diffuse"><rgb name="reflectance" value="0 0 .5"/></bsdf>{lamp}')
        self.assertEqual(properties['scene.materials.kd'], [0, 0, .5])
        self.assertEqual(properties['scene.materials.emission'], [7, 7, 7])
        self.assertFalse(found.caustics)
        point = self.translate('''<emitter type="point"><point name="position" x="1" y="2" z="3"/>
            <rgb name="intensity" value="3 2 1"/></emitter>''').properties
        self.assertEqual(point['scene.lights.light2.position'], [1, 2, 3])
        power = np.multiply(point['scene.lights.light2.color'], point['scene.lights.light2.gain'])
        np.testing.assert_allclose(power, 4 * np.pi * np.array([3, 2, 1]))

    def test_what_cannot_be_expressed_is_refused_by_name(self):
        rough = '<bsdf type="roughconductor"><float name="alpha" value=".1"/></bsdf>'
        for scene, message in ((f'<shape type="ply" id="it"><string name="filename" value="x"/>{rough}</shape>',
                                'bsdf "roughconductor"'),
                               ('<shape type="ply" id="it"><string name="filename" value="x"/></shape>', 'no bsdf'),
                               ('<shape type="sphere" id="it"/>', 'shape "sphere" it'),
                               ('<emitter type="envmap"/>', 'emitter "envmap"'),
                               ('<emitter type="point"><boolean name="x" value="true"/></emitter>', 'boolean "x"')):
            with self.subTest(message), self.assertRaisesRegex(mitsuba_to_luxcore.Inexpressible, message):
                self.translate(scene)
        with self.assertRaisesRegex(mitsuba_to_luxcore.Inexpressible, 'it: face_normals is not known'):
            self.shape(self.GLASS + '<string name="face_normals" value="1"/>')
        with self.assertRaisesRegex(mitsuba_to_luxcore.Inexpressible, '"directional": is a tenth too dark'):
            mitsuba_to_luxcore.translate('<scene><emitter type="directional"/></scene>', bidirectional=True)
        with self.assertRaisesRegex(mitsuba_to_luxcore.Inexpressible, 'scatters'):
            self.shape(self.GLASS + self.MEDIUM.replace('"albedo" value="0"', '"albedo" value=".5"'))

    def test_the_view_is_measured_at_the_middle_of_what_does_not_shine(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh = Path(folder) / 'it.ply'
            vertices = np.array([[0, -1, 1, .5], [2, 1, 3, .5]], '<f4')
            mesh.write_bytes(b'ply\nformat binary_little_endian 1.0\nelement vertex 2\n'
                             + b''.join(b'property float %c\n' % c for c in b'xyzu')
                             + b'element face 0\nproperty list uchar uint vertex_indices\nend_header\n'
                             + vertices.tobytes())
            found = self.translate('')
            found.meshes = [mesh]
            self.assertAlmostEqual(found.view_height(), 5 * 2 * np.tan(np.radians(20)))


if __name__ == '__main__':
    unittest.main()
