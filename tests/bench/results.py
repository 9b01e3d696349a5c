"""Reading of results: series by method, CPU seconds to reach an error, the yardstick, ratios of two results; as text.

A row of results is one method on one path class of one scene at one budget:
    scene, class, method, budget, digest   what was measured; class: "whole", a mask, "layer EXPR" or "alone EXPR"
    cpu                                    CPU seconds of each seed's run
    figure                                 which of the figures counts: "relMSE", or "norm" for single path classes
    relMSE, norm, ...                      errors.figures
"""
import math
from collections import defaultdict

from truths import YARDSTICK

KEY = ('scene', 'class', 'method', 'budget')


def cpu(row):
    return sum(row['cpu']) / len(row['cpu'])


def error(row):
    return row[row['figure']]['error']


def relative_sem(row):
    return row[row['figure']]['error_sem'] / error(row)


def number(value):
    return f'{value:.2e}' if value is not None else '-'


def charts(rows):
    """(scene, class) -> method -> rows by CPU seconds."""
    grouped = defaultdict(lambda: defaultdict(list))
    for row in rows:
        grouped[row['scene'], row['class']][row['method']].append(row)
    for methods in grouped.values():
        for series in methods.values():
            series.sort(key=cpu)
    return grouped


def time_to_reach(rows, target):
    """CPU seconds at which the error of a method first falls to the target, along straight lines in log-log; as
    (sign, seconds), where the sign '<' or '>' says that it lies before or after all that was measured."""
    points = [(cpu(r), error(r)) for r in rows]
    if points[0][1] <= target:
        return ('' if points[0][1] == target else '<'), points[0][0]
    for (t0, e0), (t1, e1) in zip(points, points[1:]):
        if e1 <= target:
            if e1 <= 0:  # below the truth's noise: no logarithm
                return '<', t1
            return '', t0 * (t1 / t0) ** (math.log(target / e0) / math.log(e1 / e0))
    return '>', points[-1][0]


def table(header, lines):
    """Columns as wide as they need to be, the first to the left."""
    cells = [header, *lines]
    widths = [max(len(line[i]) for line in cells) for i in range(len(header))]
    return '\n'.join('  '.join(c.ljust(w) if i == 0 else c.rjust(w) for i, (c, w) in enumerate(zip(line, widths)))
                     .rstrip() for line in cells)


def error_table(methods):
    """A line for each run of each method, and when every other method reaches that run's error."""
    lines = []
    for method, rows in methods.items():
        for row in rows:
            f = row[row['figure']]
            reached = [time_to_reach(rivals, error(row)) if error(row) > 0 and name != method else ('-', None)
                       for name, rivals in methods.items()]
            lines.append([method, f'{cpu(row):.1f}', number(f['error']), number(f['error_sem']), number(f['variance']),
                          number(f['bias2']), number(f['bias2_sem']), f'{row["ratio"]:.4f}',
                          *(sign if at is None else f'{sign}{at:.1f}' for sign, at in reached)])
    header = ['method', 'CPU s', 'error', '+-', 'variance', 'bias^2', '+-', 'mean ratio',
              *(f'{name} there' for name in methods)]
    return header, lines


def yardstick(rows):
    """Error of LS+DE over that of LD+E, each rendered alone: a header and a line for each method, scene and budget."""
    above, belows = YARDSTICK
    by_key = {tuple(r[k] for k in KEY): r for r in rows}
    lines = []
    for row in rows:
        if row['class'] != f'alone {above}':
            continue
        cells = []
        for below in belows:
            other = by_key.get((row['scene'], f'alone {below}', row['method'], row['budget']))
            cells.append(f'{error(row) / error(other):.2f}' if other and error(other) > 0 else '-')
        lines.append([row['scene'], row['method'], f'{row["budget"]:g}', number(error(row)), *cells])
    return ['scene', 'method', 'budget', f'error {above}', *(f'/ error {below}' for below in belows)], lines


def text_report(rows):
    parts = []
    for (scene, path_class), methods in charts(rows).items():
        figure = next(iter(methods.values()))[0]['figure']
        parts.append(f'{scene}, {path_class}: {figure}; "X there": CPU seconds at which X has this error\n'
                     + table(*error_table(methods)))
    header, lines = yardstick(rows)
    if lines:
        parts.append('yardstick: each rendered alone, norm\n' + table(header, lines))
    return '\n\n'.join(parts)


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values)) if values else None


def ratios(old_rows, new_rows):
    """Of rows with one key in both: new over old, as dicts. speed: CPU seconds that old spent on its error, over those
    at which new reaches it; None where that is outside what was measured. And the keys that cannot be compared, why."""
    old = {tuple(r[k] for k in KEY): r for r in old_rows}
    new = {tuple(r[k] for k in KEY): r for r in new_rows}
    series = charts(new_rows)
    compared, left = [], []
    for key in sorted(old.keys() | new.keys()):
        a, b = old.get(key), new.get(key)
        if not a or not b:
            left.append((key, 'only in ' + ('the old' if a else 'the new')))
        elif (a['digest'], a['pixels']) != (b['digest'], b['pixels']):
            left.append((key, 'scene, truth or mask differ'))
        elif min(error(a), error(b)) <= 0:
            left.append((key, 'an error below the truth\'s noise'))
        else:
            sign, at = time_to_reach(series[key[0], key[1]][key[2]], error(a))
            ratio = error(b) / error(a)
            compared.append(dict(key=key, error=ratio, sem=ratio * math.hypot(relative_sem(a), relative_sem(b)),
                                 cpu=cpu(b) / cpu(a), speed=None if sign else cpu(a) / at))
    return compared, left


def compare_report(old, new):
    compared, left = ratios(old['rows'], new['rows'])
    lines = [[f'{scene}, {path_class}', method, f'{budget:g}', f'{r["error"]:.3f}', f'{r["sem"]:.3f}',
              f'{r["cpu"]:.3f}', f'{r["speed"]:.2f}' if r['speed'] else '-']
             for r in compared for scene, path_class, method, budget in [r['key']]]
    groups = defaultdict(list)
    for r in compared:
        scene, path_class, method, _ = r['key']
        groups[f'{scene}, {path_class}', method].append(r)
        groups[f'all scenes, {path_class}', method].append(r)
    if compared:
        groups['all', 'all'] = compared
    means = []
    for (where, method), members in groups.items():
        speeds = [r['speed'] for r in members if r['speed']]
        means.append([where, method, str(len(members)), f'{geometric_mean([r["error"] for r in members]):.3f}',
                      f'{geometric_mean([r["cpu"] for r in members]):.3f}',
                      f'{geometric_mean(speeds):.2f}' if speeds else '-'])
    parts = ['new over old; speed: CPU seconds for the old error, old over new\n' + table(
        ['scene, class', 'method', 'budget', 'error', '+-', 'CPU', 'speed'], lines)]
    parts.append('geometric means\n' + table(['scene, class', 'method', 'runs', 'error', 'CPU', 'speed'], means))
    budgets = defaultdict(list)
    for (scene, path_class, method, budget), why in left:
        budgets[f'{scene}, {path_class}, {method}', why].append(f'{budget:g}')
    if budgets:
        parts.append('not compared\n' + '\n'.join(f'{what}, {",".join(seconds)} s: {why}'
                                                  for (what, why), seconds in budgets.items()))
    return '\n\n'.join(parts)
