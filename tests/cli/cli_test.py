#!/usr/bin/env python3
"""The command line, run as its users run it: exit codes, one line for each refusal, outputs left alone.

usage: cli_test.py PROGRAM SCENES DATA
"""
import json
import os
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM, SCENES, DATA = (Path(a).resolve() for a in sys.argv[1:4])
SPHERE = SCENES / 'glass-sphere-small.glb'
FAST = ['--size', '24x24', '--spp', '1']
MAP_PHOTONS = ['--photons', '20000']


class Cli(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix='lsde-cli-'))
        self.environment = os.environ | {'XDG_CACHE_HOME': str(self.folder / 'cache')}

    def tearDown(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def run_lsde(self, *arguments, code=0, **options):
        """Runs the program in the test's folder; its exit code is checked."""
        result = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, env=self.environment, text=True, capture_output=True,
                                timeout=300, **options)
        self.assertEqual(result.returncode, code, f'{arguments}: {result.stderr}')
        return result

    def refused(self, *arguments, says, code=1):
        """The program refuses: one line, that names what it should."""
        result = self.run_lsde(*arguments, code=code)
        errors = [line for line in result.stderr.splitlines() if not line.startswith('warning: ')]
        self.assertEqual(len(errors), 1, f'{arguments}: {result.stderr}')
        for part in [says] if isinstance(says, str) else says:
            self.assertIn(part, errors[0])
        return errors[0]

    def sky(self, name='sky.hdr', *, bright=(200, 150, 100, 132), width=16):
        """An environment: even light and one brighter pixel, as a Radiance picture."""
        pixels = [(90, 110, 160, 128)] * (width * width // 2)
        pixels[width // 8 + width * (width // 8)] = bright
        path = self.folder / name
        path.write_bytes(b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n' % (width // 2, width) + bytes(sum(pixels, ())))
        return path

    def emit(self, name='m.lsmap', scene=SPHERE, *more):
        self.run_lsde('emit', scene, '-o', name, *MAP_PHOTONS, '--quiet', *more)
        return self.folder / name

    def glb(self, change, source=SPHERE, name='changed.glb'):
        """A copy of a scene whose JSON went through `change`."""
        data = source.read_bytes()
        length = struct.unpack('<I', data[12:16])[0]
        document = json.loads(data[20:20 + length])
        change(document)
        text = json.dumps(document).encode()
        text += b' ' * (-len(text) % 4)
        rest = data[20 + length:]
        path = self.folder / name
        path.write_bytes(struct.pack('<4sII', b'glTF', 2, 20 + len(text) + len(rest)) + struct.pack('<I4s', len(text), b'JSON') + text + rest)
        return path


class Usage(Cli):
    def test_help_names_every_command_and_every_option_has_a_text(self):
        text = self.run_lsde('--help').stdout
        for command in 'emit render reference compare merge info'.split():
            self.assertIn(command, text)
            self.assertIn('--', self.run_lsde(command, '--help').stdout)

    def test_wrong_usage_ends_with_2(self):
        for arguments in ([], ['paint'], ['render'], ['render', SPHERE], ['render', SPHERE, '-o', 'a.exr', '--spp', '0'],
                          ['render', SPHERE, '-o', 'a.exr', '--spp', 'many'], ['render', SPHERE, '-o', 'a.exr', '--size', '10'],
                          ['render', SPHERE, '-o', 'a.exr', '--colour', 'red'], ['emit', SPHERE, '-o', 'a.lsmap', '--shard', '5/4'],
                          ['emit', SPHERE, '-o', 'a.lsmap', '--shard', '0/4'], ['emit', SPHERE, '-o', 'a.lsmap', '--store', 'some'],
                          ['render', SPHERE, '-o', 'a.exr', '--paths', 'LDE=a b'], ['render', SPHERE, '-o', 'a.exr', '--integrator', 'radiosity'],
                          ['render', SPHERE, '-o', 'a.exr', '--crop', '5,5,5,9']):
            self.run_lsde(*arguments, code=2)
        self.assertEqual(list(self.folder.glob('a*')), [])

    def test_numbers_that_are_none_are_refused(self):
        for option in ('--exposure', '--time', '--cpu-time', '--error', '--spp', '--photons', '--at', '--sun-elevation',
                       '--environment-rotate', '--environment-strength'):
            other = ['--sky'] if option.startswith('--sun') else ['--environment', SPHERE] if option.startswith('--env') else []
            for value in ('nan', 'inf', '-inf'):
                # "-inf" could be taken for an option of its own.
                line = self.run_lsde('render', SPHERE, '-o', 'a.exr', *other, f'{option}={value}', code=2).stderr.splitlines()[0]
                self.assertIn(f'{option}: {value}: expected a number', line)
        self.assertIn('--variant', self.run_lsde('render', SPHERE, '-o', 'a.exr', '--variant', '', code=2).stderr)

    def test_a_path_expression_that_does_not_parse_names_its_column(self):
        self.refused('render', SPHERE, '-o', 'a.exr', '--paths', 'LS+D(E=x', says=['LS+D(E', 'expected'])

    def test_results_go_to_stdout_and_nothing_else_does(self):
        figures = json.loads(self.run_lsde('render', SPHERE, '-o', 'a.exr', *FAST, *MAP_PHOTONS, '--no-cache', '--json', '-').stdout)
        self.assertEqual(figures['samplesPerPixel'], 1)
        self.assertEqual(figures['photonsEmitted'], 20000)
        self.assertGreater(figures['photonsStored']['caustic'], 10000)


class Outputs(Cli):
    def test_an_output_that_exists_is_kept_without_force(self):
        for name, arguments in {'a.lsmap': ['emit', SPHERE, '-o', 'a.lsmap', *MAP_PHOTONS], 'a.exr': ['render', SPHERE, '-o', 'a.exr', *FAST],
                                'a.png': ['reference', SPHERE, '-o', 'a.exr', *FAST]}.items():
            for other in self.folder.glob('a.*'):
                other.unlink()
            (self.folder / name).write_text('mine')
            self.refused(*arguments, says=[name, 'exists', '--force'])
            self.assertEqual((self.folder / name).read_text(), 'mine')

    def test_force_concerns_outputs_only(self):
        self.refused('render', SPHERE, '--map', 'absent.lsmap', '-o', 'a.exr', '--force', says='absent.lsmap')

    def test_a_folder_that_does_not_exist_is_named_before_the_work_starts(self):
        self.refused('emit', SPHERE, '-o', 'nowhere/a.lsmap', '--photons', '1000000000', says='nowhere')

    def test_a_full_disk_leaves_the_old_file_and_no_other(self):
        old = self.emit()
        before = old.read_bytes()

        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000))
        result = subprocess.run([PROGRAM, 'emit', SPHERE, '-o', 'm.lsmap', '--photons', '40000', '--force', '--quiet'], cwd=self.folder,
                                text=True, capture_output=True, preexec_fn=limit)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn('m.lsmap', result.stderr)
        self.assertEqual(old.read_bytes(), before)
        self.assertEqual([p.name for p in self.folder.iterdir()], ['m.lsmap'])

    def test_killed_while_writing_leaves_the_old_file(self):
        old = self.emit()
        for delay in (0.02, 0.1, 0.2, 0.3):
            process = subprocess.Popen([PROGRAM, 'emit', SPHERE, '-o', 'm.lsmap', '--photons', '300000', '--force', '--quiet'], cwd=self.folder)
            time.sleep(delay)
            process.send_signal(signal.SIGKILL)
            process.wait()
            self.run_lsde('info', old, '--verify')

    def test_an_interrupted_emission_is_saved_and_resumed_to_the_byte(self):
        photons = ['--photons', '3000000', '--threads', '1']
        self.run_lsde('emit', SPHERE, '-o', 'whole.lsmap', *photons, '--quiet')
        # How long it takes before the first paths are done depends on the machine.
        for delay in (0.3, 0.6, 1.2, 2.4, 4.8):
            process = subprocess.Popen([PROGRAM, 'emit', SPHERE, '-o', 'part.lsmap', *photons], cwd=self.folder, stderr=subprocess.PIPE, text=True)
            time.sleep(delay)
            process.send_signal(signal.SIGINT)
            process.communicate()
            if (self.folder / 'part.lsmap').exists():
                break
        if process.returncode == 0:
            self.skipTest('the emission was done before the signal came')
        self.assertEqual(process.returncode, 130)
        self.run_lsde('emit', SPHERE, '-o', 'part.lsmap', *photons, '--resume', '--quiet')
        self.assertEqual((self.folder / 'part.lsmap').read_bytes(), (self.folder / 'whole.lsmap').read_bytes())


class Scenes(Cli):
    def test_a_scene_that_is_missing_or_foreign(self):
        (self.folder / 'empty.glb').write_bytes(b'')
        (self.folder / 'text.gltf').write_text('this is no scene')
        (self.folder / 'cut.glb').write_bytes(SPHERE.read_bytes()[:5000])
        for name in ('absent.glb', 'empty.glb', 'text.gltf', 'cut.glb'):
            for command in (['emit', name, '-o', 'a.lsmap'], ['render', name, '-o', 'a.exr'], ['info', name]):
                self.refused(*command, says=name)

    def test_a_dangling_reference_names_both_ends(self):
        def change(d):
            d['nodes'][1]['mesh'] = 7
        self.refused('info', self.glb(change), says=['node 1', '7'])

    def test_a_node_that_is_its_own_ancestor(self):
        def change(d):
            d['nodes'][1]['children'] = [2]
            d['nodes'][2]['children'] = [1]
        self.refused('info', self.glb(change), says='node')

    def test_a_refractive_index_below_one(self):
        def change(d):
            next(m for m in d['materials'] if 'KHR_materials_ior' in m['extensions'])['extensions']['KHR_materials_ior']['ior'] = 0.2
        self.refused('render', self.glb(change), '-o', 'a.exr', says=['ior', '0.2', 'expected'])

    def test_variant_and_time_make_another_scene_only_where_they_change_it(self):
        def change(document):
            document['extensions'] = document.get('extensions', {}) | {'KHR_materials_variants': {'variants': [{'name': 'day'}, {'name': 'dusk'}]}}
            floor = document['meshes'][0]['primitives'][0]
            other = (floor['material'] + 1) % len(document['materials'])
            floor['extensions'] = {'KHR_materials_variants': {'mappings': [{'material': other, 'variants': [1]}]}}
        scene = self.glb(change)

        def described(*arguments):
            return json.loads(self.run_lsde('info', scene, *arguments, '--json', '-').stdout)
        plain = described()
        self.assertEqual(plain['variants'], ['day', 'dusk'])
        self.assertEqual(described('--variant', 'day', '--at', '2.5')['hash'], plain['hash'])
        self.assertNotEqual(described('--variant', 'dusk')['hash'], plain['hash'])
        self.refused('render', scene, '-o', 'a.exr', '--variant', 'night', says=['night', 'day', 'dusk'])
        self.refused('emit', SPHERE, '-o', 'a.lsmap', '--variant', 'day', says='has none')
        self.run_lsde('info', scene, '--at', 'noon', code=2)

    def test_a_scene_without_light_is_refused_by_render_and_reported_by_info(self):
        def change(d):
            for material in d['materials']:
                material.pop('emissiveFactor', None)
        dark = self.glb(change)
        self.refused('render', dark, '-o', 'a.exr', *FAST, says='light')
        self.assertIn('no light', self.run_lsde('info', dark).stdout)

    def test_an_environment_lights_a_scene_that_has_no_light_and_its_map_knows_it(self):
        dark = self.glb(lambda d: [m.pop('emissiveFactor', None) or m.get('extensions', {}).pop('KHR_materials_emissive_strength', None)
                                   for m in d['materials']])
        sky = self.sky()
        self.refused('emit', dark, '-o', 'm.lsmap', says=['no light', '--sky', '--environment'])
        self.run_lsde('emit', dark, '-o', 'm.lsmap', *MAP_PHOTONS, '--environment', sky)
        figures = json.loads(self.run_lsde('info', 'm.lsmap', '--json', '-').stdout)
        self.assertEqual(figures['lights'], ['environment'])
        self.assertTrue(figures['ledgerExact'])
        scene = json.loads(self.run_lsde('info', dark, '--environment', sky, '--json', '-').stdout)
        self.assertEqual([light['kind'] for light in scene['lights']], ['environment'])
        self.run_lsde('render', dark, '--environment', sky, '--map', 'm.lsmap', '-o', 'a.exr', *FAST, '--lights', 'environment')
        for other in [[], ['--environment', self.sky('other.hdr', bright=(200, 150, 99, 132))], ['--environment', sky, '--environment-rotate', 1],
                      ['--environment', sky, '--environment-strength', 2]]:
            self.refused('render', dark, *other, '--map', 'm.lsmap', '-o', 'b.exr', *FAST, says='no light' if not other else 'another scene')

    def test_an_environment_that_cannot_be_used_is_named(self):
        self.refused('info', SPHERE, '--environment', 'none.exr', says='none.exr')
        self.refused('info', SPHERE, '--environment', SPHERE, says=['.glb', 'expected an OpenEXR'])
        (self.folder / 'cut.hdr').write_bytes(self.sky().read_bytes()[:-1])
        self.refused('render', SPHERE, '-o', 'a.exr', '--environment', 'cut.hdr', says=['cut.hdr', 'row 7 is cut short'])
        self.run_lsde('info', SPHERE, '--environment-rotate', 90, code=2)

    def test_sun_and_sky_are_two_lights_and_the_png_is_exposed_for_them(self):
        figures = json.loads(self.run_lsde('info', SPHERE, '--sky', '--sun-elevation', 30, '--json', '-').stdout)
        self.assertEqual([(light['name'], light['kind']) for light in figures['lights'][-2:]], [('sky', 'environment'), ('sun', 'sun')])
        self.run_lsde('reference', SPHERE, '--sky', '-o', 'a.exr', *FAST, '--quiet')
        self.run_lsde('reference', SPHERE, '--sky', '-o', 'dark.exr', *FAST, '--quiet', '--exposure', -40)
        self.assertEqual((self.folder / 'a.exr').read_bytes(), (self.folder / 'dark.exr').read_bytes())
        self.assertGreater((self.folder / 'a.png').stat().st_size, 2 * (self.folder / 'dark.png').stat().st_size)
        for wrong in [['--turbidity', 4], ['--sky', '--sun-elevation', 91], ['--sky', '--environment', self.sky()]]:
            self.run_lsde('info', SPHERE, *wrong, code=2)

    def test_a_scene_without_a_camera_is_framed(self):
        def change(d):
            del d['cameras']
            for node in d['nodes']:
                node.pop('camera', None)
        self.run_lsde('render', self.glb(change), '-o', 'a.exr', *FAST, *MAP_PHOTONS, '--no-cache')

    def test_no_caustics_says_why_and_writes_a_valid_map(self):
        result = self.run_lsde('emit', SCENES / 'lights.glb', '-o', 'a.lsmap', *MAP_PHOTONS, '--json', '-')
        self.assertIn('no caustics here: ', result.stderr)
        self.assertEqual(json.loads(result.stdout)['explanation']['reason'], 'nothingSpecular')
        told = json.loads(self.run_lsde('info', SPHERE, '--json', '-').stdout)['explanation']
        self.assertEqual((told['reason'], told['lights'], told['casters'], told['receivers']), ('thereAre', ['light'], ['sphere'], ['floor']))
        self.run_lsde('info', 'a.lsmap', '--verify')

    def test_an_unknown_camera_and_an_unknown_light_list_those_there_are(self):
        self.refused('render', SPHERE, '-o', 'a.exr', '--camera', 'front', says=['front', 'camera'])
        self.refused('render', SPHERE, '-o', 'a.exr', '--lights', 'sun', says=['sun', 'light'])


class Maps(Cli):
    def render(self, scene, name, **expected):
        return (self.refused if expected else self.run_lsde)('render', scene, '--map', name, '-o', 'a.exr', *FAST, '--force', **expected)

    def test_a_map_that_is_missing_empty_foreign_or_cut(self):
        whole = self.emit().read_bytes()
        (self.folder / 'empty.lsmap').write_bytes(b'')
        (self.folder / 'foreign.lsmap').write_bytes(SPHERE.read_bytes())
        (self.folder / 'cut.lsmap').write_bytes(whole[:len(whole) // 2])
        (self.folder / 'longer.lsmap').write_bytes(whole + bytes(64))
        for name in ('absent.lsmap', 'empty.lsmap', 'foreign.lsmap', 'cut.lsmap', 'longer.lsmap'):
            self.render(SPHERE, name, says=name)

    def test_any_flipped_bit_is_refused(self):
        path = self.emit()
        whole = path.read_bytes()
        step = len(whole) // 40
        for at in [*range(0, 64, 9), *range(64, len(whole), step), len(whole) - 1]:
            changed = bytearray(whole)
            changed[at] ^= 1 << (at % 8)
            (self.folder / 'flipped.lsmap').write_bytes(changed)
            self.render(SPHERE, 'flipped.lsmap', says='flipped.lsmap')

    def test_a_map_of_another_scene_is_refused_whatever_the_files_times(self):
        def move(d):
            next(n for n in d['nodes'] if n['name'] == 'sphere')['translation'][0] = 1.5
        self.emit()
        moved = self.glb(move)
        os.utime(moved, (0, 0))
        self.render(moved, 'm.lsmap', says=['m.lsmap', 'scene'])
        result = self.run_lsde('render', moved, '--map', 'm.lsmap', '--other-scene', '-o', 'a.exr', *FAST, '--force')
        self.assertIn('another scene', result.stderr)

    def test_a_map_serves_any_camera(self):
        def turn(d):
            next(n for n in d['nodes'] if 'camera' in n)['translation'][1] += 1
        self.emit()
        self.run_lsde('render', self.glb(turn), '--map', 'm.lsmap', '-o', 'a.exr', *FAST)

    def test_all_cameras_get_a_picture_each_by_one_map(self):
        """A frame among others is byte for byte the one rendered alone."""
        def add(d):
            first = next(n for n in d['nodes'] if 'camera' in n)
            for name, x in (('left side', -1), ('left/side', 1)):
                d['cameras'].append(d['cameras'][0] | {'name': name})
                d['nodes'].append({'camera': len(d['cameras']) - 1, 'translation': [x, *first['translation'][1:]], 'rotation': first['rotation']})
                d['scenes'][0]['nodes'].append(len(d['nodes']) - 1)
        scene = self.glb(add)
        self.emit('m.lsmap', scene)
        given = ['render', scene, '--map', 'm.lsmap', *FAST]
        figures = json.loads(self.run_lsde(*given, '--camera', 'all', '-o', 'f.exr', '--json', '-').stdout)
        names = ['f.camera.exr', 'f.left_side.exr', 'f.left_side-2.exr']
        self.assertEqual([p['file'] for p in figures['pictures']], names)
        self.assertEqual([p['camera'] for p in figures['pictures']], ['camera', 'left side', 'left/side'])
        for camera, name in zip(('camera', 'left side', 'left/side'), names):
            self.run_lsde(*given, '--camera', camera, '-o', 'alone.exr', '--force')
            self.assertEqual((self.folder / name).read_bytes(), (self.folder / 'alone.exr').read_bytes())
            self.assertTrue((self.folder / name).with_suffix('.png').exists())
        self.assertFalse((self.folder / 'f.exr').exists())
        self.refused(*given, '--camera', 'all', '-o', 'f.exr', says='f.camera.exr')
        self.refused('render', scene, '--camera', 'all', '-o', 'g.exr', '--progressive', '2', says='--camera all', code=2)

    def test_the_counts_that_a_time_limit_reached_make_the_same_picture(self):
        def samples_by_time(size, seconds):
            given = ['render', SPHERE, '--size', size, '--no-cache', '--force']
            result = self.run_lsde(*given, '--cpu-time', seconds, '-o', 't.exr', '--json', '-')
            figures = json.loads(result.stdout)
            self.run_lsde(*given, '-o', 'c.exr', '--photons', figures['photonsEmitted'], '--spp', figures['samplesPerPixel'])
            self.assertEqual((self.folder / 't.exr').read_bytes(), (self.folder / 'c.exr').read_bytes())
            return figures['samplesPerPixel']
        samples_by_time('200x200', '2')
        # Where not even one sample a pixel can be had in time, others are filled in.
        self.assertLess(samples_by_time('1024x1024', '0.5'), 1)
        self.run_lsde('render', SPHERE, '--spp', '0.015', '-o', 'h.exr', code=2)
        self.refused('render', SPHERE, '--spp', '4.5', '--progressive', '2', '-o', 'p.exr', says='--spp 4.5', code=2)

    def test_an_error_limit_ends_the_run_and_is_told(self):
        result = self.run_lsde('render', SPHERE, '--size', '24x24', '--error', '0.01', '--no-cache', '-o', 'e.exr', '--json', '-')
        figures = json.loads(result.stdout)
        self.assertLessEqual(figures['estimatedRelMse']['total'], 0.01)
        self.run_lsde('reference', SPHERE, '--size', '24x24', '--error', '0.1', '-o', 'r.exr')
        self.refused('reference', SPHERE, '--error', '0.1', '--integrator', 'light', '-o', 'l.exr', says='--error', code=2)
        self.refused('render', SPHERE, '--error', '0.1', '--progressive', '2', '-o', 'p.exr', says='--progressive', code=2)
        self.run_lsde('render', SPHERE, '--error', '0', '-o', 'z.exr', code=2)

    def test_merging_refuses_overlaps_and_other_seeds(self):
        a = self.emit('a.lsmap', SPHERE, '--shard', '1/2')
        b = self.emit('b.lsmap', SPHERE, '--shard', '2/2')
        other = self.emit('c.lsmap', SPHERE, '--shard', '2/2', '--seed', '9')
        self.refused('merge', a, a, '-o', 'm.lsmap', says='overlap')
        self.refused('merge', a, other, '-o', 'm.lsmap', says='seed')
        self.assertFalse((self.folder / 'm.lsmap').exists())
        self.run_lsde('merge', b, a, '-o', 'm.lsmap')
        whole = self.emit('whole.lsmap')
        self.assertEqual((self.folder / 'm.lsmap').read_bytes(), whole.read_bytes())

    def test_render_keeps_its_map_in_the_cache_and_finds_it_there(self):
        first = self.run_lsde('render', SPHERE, '-o', 'a.exr', *FAST, *MAP_PHOTONS)
        kept = list((self.folder / 'cache').rglob('*.lsmap'))
        self.assertEqual(len(kept), 1)
        self.assertIn(str(kept[0]), first.stderr)
        second = self.run_lsde('render', SPHERE, '-o', 'b.exr', *FAST, *MAP_PHOTONS)
        self.assertIn('found in the cache', second.stderr)
        self.assertEqual((self.folder / 'a.exr').read_bytes(), (self.folder / 'b.exr').read_bytes())

    def test_a_cache_that_cannot_be_written_is_a_warning(self):
        (self.folder / 'cache').write_text('a file where a folder should be')
        result = self.run_lsde('render', SPHERE, '-o', 'a.exr', *FAST, *MAP_PHOTONS)
        self.assertIn('not kept in the cache', result.stderr)


class SameBytes(Cli):
    def test_the_number_of_threads_changes_no_byte(self):
        for threads in '13':
            self.emit(f'{threads}.lsmap', SPHERE, '--threads', threads)
            for method in ('photon', 'path', 'light'):
                self.run_lsde('render', SPHERE, '-o', f'{method}{threads}.exr', *FAST, *MAP_PHOTONS, '--no-cache', '--integrator', method,
                              '--threads', threads)
        for name in ('{}.lsmap', 'photon{}.exr', 'path{}.exr', 'light{}.exr', 'photon{}.png'):
            self.assertEqual((self.folder / name.format(1)).read_bytes(), (self.folder / name.format(3)).read_bytes(), name)

    def test_a_path_layer_changes_neither_the_picture_nor_the_random_numbers(self):
        self.run_lsde('render', SPHERE, '-o', 'a.exr', *FAST, *MAP_PHOTONS, '--no-cache')
        self.run_lsde('render', SPHERE, '-o', 'b.exr', *FAST, *MAP_PHOTONS, '--no-cache', '--paths', 'LS+DE=c')
        result = self.run_lsde('compare', 'a.exr', 'b.exr', '--json', '-')
        self.assertEqual(json.loads(result.stdout)['metrics']['mse'], 0)


class Pictures(Cli):
    def test_damaged_pictures_are_refused(self):
        good = DATA / 'reference' / 'glass-sphere.exr'
        (self.folder / 'cut.exr').write_bytes(good.read_bytes()[:3000])
        (self.folder / 'text.exr').write_text('no picture')
        for name in ('cut.exr', 'text.exr', 'absent.exr', *sorted((DATA / 'odd' / 'openexr').glob('*.exr'))):
            self.refused('compare', name, good, says=str(name))

    def test_pictures_of_other_sizes_are_refused_with_both_sizes(self):
        self.run_lsde('render', SPHERE, '-o', 'a.exr', *FAST, *MAP_PHOTONS, '--no-cache')
        self.refused('compare', 'a.exr', DATA / 'reference' / 'glass-sphere.exr', says=['24x24', '64x64'])

    def test_fail_above_decides_the_exit_code(self):
        good, other = DATA / 'reference' / 'ring.exr', DATA / 'reference' / 'ring.a.exr'
        self.run_lsde('compare', other, good, '--fail-above', 'relmse=1')
        self.run_lsde('compare', other, good, '--fail-above', 'relmse=1e-12', code=1)
        self.run_lsde('compare', other, good, '--fail-above', 'beauty=1', code=2)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=1)
