#!/usr/bin/env python3
"""The benchmark of convergence: error against CPU seconds, by scene, method and path class.

    convergence.py run -o RESULT.json --page RESULT.html      renders; prints the tables
    convergence.py page RESULT.json -o RESULT.html            plots and tables as one page, nothing else needed
    convergence.py table RESULT.json                          the tables of a result once more
    convergence.py compare OLD.json NEW.json                  ratios, new over old, at equal scene, method and budget

Scenes: those of the oracle folder, where there is one, and of scenes/, as far as there is a truth for them. CPU seconds
are those that the kernel counts for the whole run, emission, loading and writing included. Run lists:
    whole    the full picture; also on masks, where the scene has some
    layers   single path classes with a truth of their own, as layers (--paths) of the full picture
    alone    LS+DE and what it is held against, each rendered alone (--only) for the whole budget: the yardstick
Methods are the rows of methods.py. Needs numpy and OpenEXR >= 3.3; Pillow for the oracle's masks.
Exit codes: 0 done, 1 bad input or a run that failed, 2 wrong usage.
"""
import argparse
import hashlib
import json
import os
import sys
from pathlib import Path

import methods
import page
import plan
import results
import truths

FORMAT = 'lsde convergence 1'


def say(message):
    print(message, file=sys.stderr, flush=True)


def write_json(path, result):
    """Whole or not at all: an interrupted run leaves what was finished before."""
    part = path.with_name(path.name + '.part')
    part.write_text(json.dumps(result, indent=1, allow_nan=False) + '\n')
    os.replace(part, path)


def read_json(path):
    try:
        result = json.loads(Path(path).read_text())
    except (OSError, ValueError) as problem:
        sys.exit(f'{path}: {problem}')
    if not isinstance(result, dict) or result.get('format') != FORMAT:
        sys.exit(f'{path}: expected the format "{FORMAT}"')
    return result


def begin_result(arguments):
    """An empty result; with --resume the one begun before, if it was made by the same program with as many seeds."""
    if not os.access(arguments.lsde, os.X_OK):
        sys.exit(f'{arguments.lsde}: no program there; ./lsde.sh build makes it, --lsde names another')
    empty = dict(format=FORMAT, program=hashlib.sha256(arguments.lsde.read_bytes()).hexdigest(), seeds=arguments.seeds,
                 left_out=[], rows=[])
    if not arguments.output.exists() or arguments.force:
        return empty
    if not arguments.resume:
        sys.exit(f'{arguments.output}: exists; --resume continues it, --force overwrites it')
    begun = read_json(arguments.output)
    for key in ('program', 'seeds'):
        if begun[key] != empty[key]:
            sys.exit(f'{arguments.output}: cannot be continued, its {key} was {begun[key]}, now it is {empty[key]}')
    return begun | {'left_out': []}


def command_run(arguments):
    result = begin_result(arguments)
    scenes = truths.find_scenes(arguments.oracle, arguments.scenes, say)
    if not scenes:
        sys.exit('no scene to render: none matches --scenes and has a truth')
    for scene in scenes:
        if scene.remark:
            say(f'{scene.name}: {scene.remark}')
    runs, left_out = plan.plan(scenes, arguments)
    finished = {tuple(r[k] for k in (*results.KEY, 'digest')) for r in result['rows']}
    todo = [r for r in runs if any((r[0].name, c[0], r[3], r[4], r[0].digest) not in finished for c in r[2])]
    failed = []
    say(f'{len(todo)} runs with {arguments.seeds} seeds: {sum(r[4] for r in todo) * arguments.seeds:g} CPU seconds')
    for scene, words, classes, name, budget in todo:
        try:
            rows = plan.render_and_measure(name, scene, words, classes, budget, arguments)
        except (methods.RunError, ValueError) as problem:
            failed.append((scene.name, name, f'{classes[0][0]}, {budget:g} s: {problem}'))
            say(f'{scene.name}, {name}, failed: {failed[-1][2]}')
            continue
        say('\n'.join(f'{scene.name}, {r["class"]}, {name}: {results.cpu(r):.1f} CPU s of {budget:g}, '
                      f'{r["figure"]} {results.error(r):.2e} +- {r[r["figure"]]["error_sem"]:.0e}'
                      + (f', {r["not_finite"]} pixels not finite' if r['not_finite'] else '') for r in rows))
        fresh = {tuple(r[k] for k in results.KEY) for r in rows}
        result['rows'] = [r for r in result['rows'] if tuple(r[k] for k in results.KEY) not in fresh] + rows
        write_json(arguments.output, result)
    result['left_out'] = left_out + failed
    write_json(arguments.output, result)
    for scene_name, name, reason in result['left_out']:
        say(f'{scene_name}, {name}: left out, {reason}')
    print(results.text_report(result['rows']))
    if arguments.page:
        arguments.page.write_text(page.page(result))
    return 1 if failed else 0


def command_page(arguments):
    arguments.output.write_text(page.page(read_json(arguments.result)))


def command_plot(arguments):
    try:
        drawn = page.picture(read_json(arguments.result), arguments.scene, arguments.path_class, arguments.title)
    except KeyError as problem:
        sys.exit(f'{arguments.result}: {problem.args[0]}')
    arguments.output.write_text(drawn)


def command_table(arguments):
    print(results.text_report(read_json(arguments.result)['rows']))


def command_compare(arguments):
    print(results.compare_report(read_json(arguments.old), read_json(arguments.new)))


def one_of(known):
    def parse(text):
        words = text.split(',')
        unknown = [w for w in words if w not in known]
        if unknown:
            raise argparse.ArgumentTypeError(f'"{unknown[0]}": expected some of {", ".join(known)}')
        return words
    return parse


def positive(convert):
    def parse(text):
        value = convert(text)
        if not 0 < value < float('inf'):
            raise ValueError
        return value
    parse.__name__ = f'positive {convert.__name__}'  # shown by argparse
    return parse


def budgets(text):
    return [positive(float)(word) for word in text.split(',')]


def oracle_folder(text):
    if not text:
        return None
    folder = Path(text)
    if not (folder / 'glb').is_dir():
        raise argparse.ArgumentTypeError(f'{text}: expected a folder with glb/ and exr/')
    return folder


def arguments_of(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True, metavar='COMMAND')

    run = commands.add_parser('run', help='render and measure')
    near = truths.PROJECT.parent / 'shared/oracle'
    run.add_argument('--lsde', type=Path, default=truths.PROJECT / 'build/release/lsde', help='the program')
    run.add_argument('--oracle', type=oracle_folder, default=near if (near / 'glb').is_dir() else None,
                     help="folder of scenes with truths (default: ../shared/oracle, if it is there; '': none)")
    run.add_argument('--scenes', type=lambda text: text.split(','), default=['*'],
                     help="names or patterns: pool,lights or 'oracle/*' (default: all)")
    run.add_argument('--methods', type=one_of(methods.METHODS), default=list(methods.METHODS), help='default: all')
    run.add_argument('--budgets', type=budgets, default=[3.0, 10.0, 30.0, 100.0, 300.0],
                     help='CPU seconds (default: 3,10,30,100,300)')
    run.add_argument('--lists', type=one_of(plan.LISTS), default=list(plan.LISTS), help='default: whole,layers,alone')
    run.add_argument('--seeds', type=positive(int), default=1,
                     help='2 or more set variance and bias apart (default: 1)')
    run.add_argument('-o', '--output', type=Path, default=Path('convergence.json'), help='default: convergence.json')
    run.add_argument('--page', type=Path, help='also write the page')
    run.add_argument('--resume', action='store_true', help='render only what the output does not hold yet')
    run.add_argument('--force', action='store_true', help='overwrite the output')
    run.set_defaults(action=command_run)

    make_page = commands.add_parser('page', help='plots and tables as one HTML page')
    make_page.add_argument('result')
    make_page.add_argument('-o', '--output', type=Path, required=True)
    make_page.set_defaults(action=command_page)

    plot = commands.add_parser('plot', help='the error curves of one scene and path class as an SVG file')
    plot.add_argument('result')
    plot.add_argument('--scene', required=True)
    plot.add_argument('--class', dest='path_class', default='whole', help='default: whole')
    plot.add_argument('--title', required=True)
    plot.add_argument('-o', '--output', type=Path, required=True)
    plot.set_defaults(action=command_plot)

    table = commands.add_parser('table', help='the tables of a result')
    table.add_argument('result')
    table.set_defaults(action=command_table)

    compare = commands.add_parser('compare', help='ratios of two results')
    compare.add_argument('old')
    compare.add_argument('new')
    compare.set_defaults(action=command_compare)
    return parser.parse_args(words)


if __name__ == '__main__':
    chosen = arguments_of(sys.argv[1:])
    try:
        sys.exit(chosen.action(chosen))
    except KeyboardInterrupt:
        sys.exit(130)
